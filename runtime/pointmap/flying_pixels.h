/* SPDX-License-Identifier: Apache-2.0 */
/* Flying pixels: measured depth without a surface. Between two surfaces a sensor, or a match, may return a depth in
 * between. In another view such a point lies in front of the measured surface. */
#ifndef T3R_FLYING_PIXELS_H
#define T3R_FLYING_PIXELS_H

#include <stdbool.h>
#include <stdint.h>

#include "pointmap_work.h"
#include "state/views.h"

/* Marks the doubtful pixels of view v (t3r_is_doubtful) and returns their number:
 * - measured pixels between two measured neighbours in a row or a column, one nearer and one deeper, neither on the
 * same surface;
 * - pixels whose point another view sees through: all that it measured within a pixel of where the point falls is
 * deeper by more than 1/16. So a pixel of misregistration at an edge is tolerated. Where filled depths are guesses
 *   (`guessed`), those of the other view count too, but only against filled ones.
 * Depths don't change. The marks don't depend on the order of the views. */
uint32_t t3r_mark_flying(const t3r_view *views, uint32_t count, uint32_t v, int32_t exponent, bool guessed,
                         const t3r_pointmap_work *work);

#endif
