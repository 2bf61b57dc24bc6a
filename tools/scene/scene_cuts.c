/* SPDX-License-Identifier: Apache-2.0 */
#include "scene/scene_cuts.h"

#include <math.h>

#define HALF_A_LEVEL (0.5 / 255) /* less is the rounding of a colour */

static bool has_bounds(scene_bounds bounds)
{
    return bounds.least != 0 || bounds.most != 0;
}

/* Whether a number is outside the bounds by more than that. */
static bool is_outside(scene_bounds bounds, double value, double by)
{
    return has_bounds(bounds) && (value < bounds.least - by || value > bounds.most + by);
}

static bool may_be_outside(scene_bounds bounds, scene_bounds values)
{
    return is_outside(bounds, values.least, 0) || is_outside(bounds, values.most, 0);
}

static bool cuts_colour(scene_bounds bounds, const scene_row *row)
{
    bool cuts = false;
    for (int channel = 0; channel < 3; channel++) {
        cuts = cuts || is_outside(bounds, scene_row_colour(row, channel), HALF_A_LEVEL);
    }
    return cuts;
}

static bool cuts_width(scene_bounds bounds, const scene_row *row)
{
    const double *scale = row->log_scale;
    const double largest = exp(fmax(scale[0], fmax(scale[1], scale[2])));
    const scene_bounds widths = {exp(bounds.least), exp(bounds.most)};
    bool cuts = false;
    for (int axis = 0; axis < 3; axis++) {
        cuts = cuts || (is_outside(bounds, scale[axis], 0) && is_outside(widths, exp(scale[axis]), largest / 16));
    }
    return cuts;
}

scene_cuts scene_cuts_of(const scene_format *format, const scene_source *source, const scene_extent *extent)
{
    scene_cuts cuts = {0, 0};
    if (!may_be_outside(format->colour, extent->colour) && !may_be_outside(format->log_scale, extent->log_scale)) {
        return cuts;
    }
    for (uint32_t i = 0; i < source->rows->count; i++) {
        scene_row row;
        scene_source_row(source, i, &row);
        cuts.colours += cuts_colour(format->colour, &row);
        cuts.widths += cuts_width(format->log_scale, &row);
    }
    return cuts;
}
