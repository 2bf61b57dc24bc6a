/* SPDX-License-Identifier: Apache-2.0 */
#include "one_cluster.h"

#include "core/memory.h"

uint32_t t3r_one_cluster(const t3r_view *views, uint32_t count, t3r_cluster *all)
{
    uint32_t points = 0;
    for (uint32_t v = 0; v < count; v++) {
        const size_t pixels = (size_t)views[v].width * views[v].height;
        for (size_t i = 0; i < pixels; i++) {
            points += t3r_has_depth(views[v].validity[i]);
        }
        memset(views[v].label, 0, pixels);
    }
    *all = (t3r_cluster){.points = points};
    return points;
}
