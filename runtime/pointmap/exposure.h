/* SPDX-License-Identifier: Apache-2.0 */
/* Exposure levelled between views: a gain for each view and channel, from surfaces that two views measured. */
#ifndef T3R_EXPOSURE_H
#define T3R_EXPOSURE_H

#include <stdint.h>

#include "core/gain.h"
#include "pointmap_work.h"
#include "state/views.h"

/* Computes gains of r, g, b, Q14, 1/4..4, that bring each view to the mean exposure of all. Each view is compared with
 * the earlier ones, already levelled: its gain is the median of log2(its level / the other's) over pairs of pixels. A
 * pair is a pixel, one in two of every second row, that falls on a measured pixel at most 1/64 off in depth, with all
 * six levels in 16..239. A view with fewer than 256 pairs keeps gain 1 and levels no other. Returns the number of
 * levelled views, including the first one. */
uint32_t t3r_exposure_gains(const t3r_view *views, uint32_t count, int32_t exponent, uint16_t gain_q14[][3],
                            const t3r_pointmap_work *work);

#endif
