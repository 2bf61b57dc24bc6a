/* SPDX-License-Identifier: Apache-2.0 */
#include "geometry/seen.h"

#include <math.h>
#include <stdbool.h>
#include <stddef.h>

#include "geometry/pinhole.h"

#define WITHIN (1.0 / 20)

/* Whether the view measured depth z at (x, y) or beside it. */
static bool measured(const seen_view *view, uint32_t width, uint32_t height, long x, long y, double z)
{
    for (long v = y - 1; v <= y + 1; v++) {
        for (long u = x - 1; u <= x + 1; u++) {
            const bool inside = u >= 0 && v >= 0 && u < (long)width && v < (long)height;
            const double depth = inside ? view->depth[(size_t)v * width + (size_t)u] * view->unit : 0;
            if (depth > 0 && fabs(depth - z) <= z * WITHIN) {
                return true;
            }
        }
    }
    return false;
}

static bool saw(const seen_view *view, uint32_t width, uint32_t height, const double point[3])
{
    const pinhole p = pinhole_of(view->camera);
    double pixel[2], z;
    if (!pinhole_project(&p, point, pixel, &z)) {
        return false;
    }
    const bool inside = pixel[0] > -0.5 && pixel[1] > -0.5 && pixel[0] < width - 0.5 && pixel[1] < height - 0.5;
    return inside && measured(view, width, height, lround(pixel[0]), lround(pixel[1]), z);
}

void seen_mask(uint8_t *seen, uint32_t width, uint32_t height, const seen_view *target, const seen_view *context,
               uint32_t context_count)
{
    const pinhole p = pinhole_of(target->camera);
    for (uint32_t v = 0; v < height; v++) {
        for (uint32_t u = 0; u < width; u++) {
            const size_t i = (size_t)v * width + u;
            double point[3];
            seen[i] = 0;
            pinhole_point(&p, u, v, target->depth[i] * target->unit, point);
            for (uint32_t c = 0; c < context_count && target->depth[i] != 0 && seen[i] == 0; c++) {
                seen[i] = saw(&context[c], width, height, point) ? 255 : 0;
            }
        }
    }
}
