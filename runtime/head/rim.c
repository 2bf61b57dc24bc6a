/* SPDX-License-Identifier: Apache-2.0 */
#include "rim.h"

#include "core/fixed.h"
#include "head.h"
#include "pointmap/exposure.h"
#include "pointmap/pointmap.h"
#include "pointmap/reproject.h"

#define BORDER_TIMES_Q8 320  /* least distance, in depths of the border: 5/4 */
#define FARTHER_SHIFT 2      /* at least a quarter farther than the largest depth of all views */
#define MOST_TIMES 256       /* most distance, in depths of the border */
#define DEPTH_SAMPLES 16u    /* along each side of a view, of its depth */
#define OPACITY_Q15 32440    /* 0.99 */
#define INSET_PART 8u        /* the part of a view in which a side looks for a depth */
#define SAMPLES 8u           /* of a segment, along the border */
#define SAMPLE_ROWS 4u       /* of pixels from the border inwards */
#define LENGTH_SIXTEENTHS 11 /* standard deviation along the border, in sixteenths of a segment */

enum { LEFT, RIGHT, TOP, BOTTOM, SIDES };

/* A ring of Gaussians about a picture. Distances are sixteenths of the picture from a side to the opposite one. */
typedef struct ring {
    uint8_t beyond, width; /* from the border to the centre; standard deviation across it */
    uint8_t fewer;         /* segments along a side are T3R_RIM_MOST_SEGMENTS >> fewer */
    uint8_t times;         /* farther than the inner ring, so that this one shows before the outer one */
} ring;

/* The inner ring continues the border. The outer one reaches half a picture beyond it, and behind the whole picture, so
 * that it shows in gaps between surfaces. Its Gaussians are few, as they are drawn at every pixel. */
static const ring rings[] = {{1, 1, 0, 1}, {5, 6, 1, 4}};
enum { RINGS = sizeof rings / sizeof rings[0] };

/* A segment of a side of a view, and its ring. */
typedef struct segment {
    const t3r_pointmap *map;
    const ring *ring;
    uint32_t side, index, count;
    int64_t least_q20;     /* the rim is at least so far from the view */
    uint32_t inset;        /* of the surface from the border */
    int32_t beside_q20[3]; /* where the surface at the border would continue */
} segment;

static bool is_upright(const segment *s)
{
    return s->side == LEFT || s->side == RIGHT;
}

/* Returns the pixels along the side. */
static uint32_t along(const segment *s)
{
    return is_upright(s) ? s->map->view->height : s->map->view->width;
}

/* Returns the pixels from the side to the opposite one. */
static uint32_t across(const segment *s)
{
    return is_upright(s) ? s->map->view->width : s->map->view->height;
}

/* Finds the pixel at place `sample` of `samples` along the segment, `inset` pixels from the border. */
static void pixel_at(const segment *s, uint32_t sample, uint32_t samples, uint32_t inset, uint32_t uv[2])
{
    const uint32_t parts = 2 * samples * s->count;
    const uint32_t at = (2 * (s->index * samples + sample) + 1) * along(s) / parts;
    const uint32_t in = s->side == LEFT || s->side == TOP ? inset : across(s) - 1 - inset;
    uv[0] = is_upright(s) ? in : at;
    uv[1] = is_upright(s) ? at : in;
}

/* Finds the outermost pixel with a depth at the segment's middle. Returns its distance from the border, 0: none. */
static uint32_t find_surface(const segment *s, uint32_t uv[2])
{
    const t3r_view *view = s->map->view;
    for (uint32_t inset = 1; inset < across(s) / INSET_PART; inset++) {
        pixel_at(s, 0, 1, inset, uv);
        if (t3r_has_depth(view->validity[(size_t)uv[1] * view->width + uv[0]])) {
            return inset;
        }
    }
    return 0;
}

/* Computes the sides of a pixel at depth z, scene units in Q24, in scene axes. */
static void pixel_sides(const t3r_pointmap *map, int64_t z_q20, int64_t side_q24[2][3])
{
    const int32_t *r_q30 = map->view->pose.rotation_q30, inverse_f_q32[2] = {map->inverse_fx_q32, map->inverse_fy_q32};
    for (int axis = 0; axis < 2; axis++) {
        const int64_t length_q24 = T3R_MIN(t3r_round_shift64(z_q20 * inverse_f_q32[axis], 28), INT64_C(1) << 30);
        for (int i = 0; i < 3; i++) {
            side_q24[axis][i] = t3r_round_shift64(r_q30[3 * i + axis] * length_q24, 30);
        }
    }
}

/* Places a Gaussian beyond the border, parallel to the picture. Returns false without a surface at the border. */
static bool place(segment *s, t3r_gaussian *g)
{
    uint32_t uv[2];
    const uint32_t inset = s->inset = find_surface(s, uv);
    const t3r_view *view = s->map->view;
    int32_t point_q20[3];
    if (inset == 0 || !t3r_point(s->map, uv[0], uv[1], point_q20)) {
        return false;
    }
    const int64_t z_q20 = T3R_MAX(t3r_depth_q20(s->map->scale, view->depth[(size_t)uv[1] * view->width + uv[0]]), 1);
    const int64_t times_q8 =
        s->ring->times * t3r_clamp64(s->least_q20 * 256 / z_q20, BORDER_TIMES_Q8, MOST_TIMES * 256);
    int64_t side_q24[2][3], entry_q28[9];
    pixel_sides(s->map, z_q20, side_q24);
    const int64_t width_q4 = (int64_t)across(s) * s->ring->width;
    const int64_t length_q4 = (int64_t)LENGTH_SIXTEENTHS * along(s) / s->count;
    const int64_t beyond_q4 = (int64_t)across(s) * s->ring->beyond + 16 * (int64_t)inset;
    const int64_t move_q4 = s->side == LEFT || s->side == TOP ? -beyond_q4 : beyond_q4;
    const int64_t *outwards_q24 = side_q24[is_upright(s) ? 0 : 1];
    const int64_t extent_q4[2] = {is_upright(s) ? width_q4 : length_q4, is_upright(s) ? length_q4 : width_q4};
    for (int i = 0; i < 3; i++) {
        const int64_t from_q20 = view->pose.position_q20[i];
        const int64_t beside_q20 = point_q20[i] + t3r_round_shift64(move_q4 * outwards_q24[i], 4 + 24 - 20);
        s->beside_q20[i] = (int32_t)t3r_clamp64(beside_q20, -T3R_POSITION_MOST_Q20, T3R_POSITION_MOST_Q20);
        const int64_t x_q20 = from_q20 + t3r_round_shift64(times_q8 * (beside_q20 - from_q20), 8);
        g->position_q20[i] = (int32_t)t3r_clamp64(x_q20, -T3R_POSITION_MOST_Q20, T3R_POSITION_MOST_Q20);
        for (int axis = 0; axis < 2; axis++) { /* sides are below 2^8 x 2^30, extents 2^20 */
            entry_q28[3 * i + axis] = t3r_round_shift64(times_q8 * side_q24[axis][i], 8) * extent_q4[axis];
        }
        entry_q28[3 * i + 2] = 0;
    }
    t3r_pack_factor(entry_q28, 28, g);
    return true;
}

/* Whether another view's picture contains the place where the surface at the border would continue. */
static bool is_shown(const t3r_runtime *rt, const t3r_view *views, uint32_t own, const segment *s)
{
    bool shown = false;
    for (uint32_t v = 0; v < rt->views && !shown; v++) {
        t3r_projected_pixel projected;
        shown = v != own && t3r_project_to_pixel(&views[v], s->beside_q20, &projected);
    }
    return shown;
}

/* Sets the mean of the levelled colours of pixels with a depth, from the surface inwards. Without a depth a pixel may
 * be masked or beyond the lens. Returns false if none has one. */
static bool colour(const segment *s, const uint16_t gain_q14[3], t3r_gaussian *g)
{
    const t3r_view *view = s->map->view;
    uint32_t sum[3] = {0}, count = 0; /* at most 32 x 2^15 */
    for (uint32_t i = 0; i < SAMPLES * SAMPLE_ROWS; i++) {
        uint32_t uv[2];
        pixel_at(s, i % SAMPLES, SAMPLES, s->inset - 1 + i / SAMPLES, uv);
        const size_t pixel = (size_t)uv[1] * view->width + uv[0];
        if (!t3r_has_depth(view->validity[pixel])) {
            continue;
        }
        for (int c = 0; c < 3; c++) {
            sum[c] += t3r_level_q7(128u * view->colour[c][pixel], gain_q14[c]);
        }
        count++;
    }
    for (int c = 0; c < 3 && count > 0; c++) {
        g->colour_q7[c] = (uint16_t)((sum[c] + count / 2) / count);
    }
    return count > 0;
}

/* Returns the largest depth of the views, at some pixels of each. */
static int64_t largest_depth(const t3r_runtime *rt, const t3r_view *views)
{
    int64_t most_q20 = 0;
    for (uint32_t v = 0; v < rt->views; v++) {
        const t3r_view *view = &views[v];
        const t3r_pointmap map = t3r_pointmap_of(view, rt->frame.exponent);
        for (uint32_t i = 0; i < DEPTH_SAMPLES * DEPTH_SAMPLES; i++) {
            const uint32_t x = (2 * (i % DEPTH_SAMPLES) + 1) * view->width / (2 * DEPTH_SAMPLES);
            const uint32_t y = (2 * (i / DEPTH_SAMPLES) + 1) * view->height / (2 * DEPTH_SAMPLES);
            const size_t pixel = (size_t)y * view->width + x;
            if (t3r_has_depth(view->validity[pixel])) {
                most_q20 = T3R_MAX(most_q20, (int64_t)t3r_depth_q20(map.scale, view->depth[pixel]));
            }
        }
    }
    return most_q20;
}

/* Writes the Gaussians of a view's ring, and returns their number; out NULL only counts them. */
static uint32_t make_ring(const t3r_runtime *rt, const t3r_view *views, uint32_t v, const ring *of, uint32_t fewer,
                          int64_t least_q20, t3r_gaussian *out)
{
    const t3r_pointmap map = t3r_pointmap_of(&views[v], rt->frame.exponent);
    const uint32_t count = T3R_RIM_MOST_SEGMENTS >> of->fewer >> fewer;
    uint32_t made = 0;
    for (uint32_t i = 0; i < SIDES * count; i++) {
        segment s = {&map, of, i / count, i % count, count, least_q20, 0, {0}};
        t3r_gaussian g = {.view = T3R_NO_VIEW, .opacity_q15 = OPACITY_Q15};
        const bool is_made = place(&s, &g) && colour(&s, rt->gain_q14[v], &g) && !is_shown(rt, views, v, &s);
        if (is_made && out != NULL) {
            out[made] = g;
        }
        made += is_made;
    }
    return made;
}

uint32_t t3r_make_rim(const t3r_runtime *rt, const t3r_view *views, t3r_gaussian *out)
{
    const t3r_config *config = &rt->config;
    const uint32_t budget = t3r_gaussians_of(rt), whole = T3R_RIM_BUDGET(rt->views);
    if (!T3R_FEATURE_BACKDROP || !config->rim || !config->guess || t3r_is_stream(config) || budget < whole / 2) {
        return 0;
    }
    const uint32_t fewer = budget < whole ? 1 : 0;
    const int64_t largest_q20 = largest_depth(rt, views), least_q20 = largest_q20 + (largest_q20 >> FARTHER_SHIFT);
    uint32_t made = 0;
    for (uint32_t r = 0; r < RINGS; r++) {
        for (uint32_t v = 0; v < rt->views; v++) {
            made += make_ring(rt, views, v, &rings[r], fewer, least_q20, out != NULL ? out + made : NULL);
        }
    }
    return made;
}
