/* SPDX-License-Identifier: Apache-2.0 */
#include "stereo_fuse.h"

#include "core/fixed.h"
#include "stereo.h"

#define LEAST ((int32_t)T3R_STEREO_LEAST)

void t3r_stereo_fuse(const t3r_view *view, const t3r_view *found)
{
    const size_t pixels = T3R_PIXELS_(view->width, view->height);
    const uint32_t cut = T3R_MAX(found->depth_unit_q40, view->depth_unit_q40) >> 45 != 0 ? 2 : 0;
    const int64_t from = (int64_t)(found->depth_unit_q40 >> cut),
                  to = T3R_MAX((int64_t)(view->depth_unit_q40 >> cut), 1);
    for (size_t i = 0; i < pixels; i++) {
        const int32_t old = view->match_confidence[i], added = found->match_confidence[i];
        const int64_t steps = t3r_round_div64((int64_t)found->depth[i] * from, to); /* below 2^16 x 2^45 */
        if (added == (int32_t)T3R_STEREO_NONE || steps < 1 || steps > UINT16_MAX ||
            (added == (int32_t)T3R_STEREO_FILLED && old >= added)) {
            continue;
        }
        int64_t depth = steps;
        int32_t confidence = added;
        if (old >= LEAST && t3r_is_one_surface(view->depth[i], steps, 16)) {
            depth = t3r_round_div64(view->depth[i] * (int64_t)old + steps * added, old + added);
            confidence = T3R_MIN(old + added, (int32_t)UINT8_MAX);
        } else if (old >= LEAST) {
            depth = old >= added ? view->depth[i] : steps;
            confidence = T3R_MAX(t3r_abs32(old - added), LEAST);
        }
        view->depth[i] = (uint16_t)depth;
        view->match_confidence[i] = (uint8_t)confidence;
    }
}
