/* SPDX-License-Identifier: Apache-2.0 */
#include "reconstruction/context/view_surface.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cli/cli.h"
#include "reconstruction/developed_frame.h"

#define LONGEST_SIDE 512u /* of the picture that is looked at */
#define WITHIN 0.1        /* of a depth, in which two measurements agree */
#define BLURRED 0.7       /* of the usual sharpness; less is blurred */
#define COARSE 4u         /* pixels between those that coarse detail compares */

/* Returns the greatest size up to LONGEST_SIDE of the frame's aspect. */
static void looked_at_size(const t3r_frame *frame, uint32_t *width, uint32_t *height)
{
    const uint32_t longest = frame->width > frame->height ? frame->width : frame->height;
    const uint32_t side = longest < LONGEST_SIDE ? longest : LONGEST_SIDE;
    *width = (frame->width * side + longest / 2) / longest;
    *height = (frame->height * side + longest / 2) / longest;
    *width = *width < T3R_MIN_SIDE ? T3R_MIN_SIDE : *width;
    *height = *height < T3R_MIN_SIDE ? T3R_MIN_SIDE : *height;
}

/* Returns the bend of brightness at `at` over `apart` pixels on either side. */
static uint32_t bend(const uint8_t *green, size_t at, size_t apart)
{
    return (uint32_t)abs(2 * green[at] - green[at - apart] - green[at + apart]);
}

/* Returns fine detail by coarse detail, along the axis that has less: motion blurs one of them. */
static double sharpness_of(const uint8_t *rgb, uint32_t width, uint32_t height)
{
    const uint8_t *green = rgb + 1;
    uint64_t fine[2] = {0}, coarse[2] = {0};
    for (uint32_t y = COARSE; y + COARSE < height; y++) {
        for (uint32_t x = COARSE; x + COARSE < width; x++) {
            const size_t at = 3 * ((size_t)y * width + x), steps[2] = {3, 3 * (size_t)width};
            for (int axis = 0; axis < 2; axis++) {
                fine[axis] += bend(green, at, steps[axis]);
                coarse[axis] += bend(green, at, COARSE * steps[axis]);
            }
        }
    }
    const double across = coarse[0] > 0 ? (double)fine[0] / (double)coarse[0] : 0;
    const double down = coarse[1] > 0 ? (double)fine[1] / (double)coarse[1] : 0;
    return fmin(across, down);
}

/* Takes for each cell the valid depth that is nearest to its middle. */
static void find_depths(view_surface *out, const uint16_t *depth, double unit)
{
    for (uint32_t cell = 0; cell < SURFACE_CELLS; cell++) {
        const uint32_t column = cell % SURFACE_ACROSS, row = cell / SURFACE_ACROSS;
        const uint32_t left = column * out->width / SURFACE_ACROSS, right = (column + 1) * out->width / SURFACE_ACROSS;
        const uint32_t top = row * out->height / SURFACE_DOWN, bottom = (row + 1) * out->height / SURFACE_DOWN;
        uint32_t least = UINT32_MAX;
        for (uint32_t y = top; y < bottom; y++) {
            for (uint32_t x = left; x < right; x++) {
                const int32_t across = (int32_t)(2 * x - left - right), down = (int32_t)(2 * y - top - bottom);
                const uint32_t off = (uint32_t)(across * across + down * down);
                const uint16_t steps = depth[(size_t)y * out->width + x];
                if (steps != 0 && off < least) {
                    least = off;
                    out->depth[cell] = steps * unit;
                }
            }
        }
    }
}

int view_surface_make(view_surface *out, const t3r_capture_frame *frame, const char *path, uint32_t index,
                      bool by_sensor)
{
    *out = (view_surface){.measured = by_sensor && frame->frame.depth != NULL};
    looked_at_size(&frame->frame, &out->width, &out->height);
    const size_t pixels = (size_t)out->width * out->height;
    uint8_t *rgb = malloc(3 * pixels);
    uint16_t *depth = calloc(pixels, sizeof *depth);
    t3r_camera camera;
    const int code = rgb == NULL || depth == NULL ? cli_error(CLI_BAD_INPUT, "out of memory")
                                                  : developed_capture(frame, path, index, out->width, out->height, rgb,
                                                                      out->measured ? depth : NULL, &camera);
    if (code == CLI_OK) {
        out->camera = pinhole_of(&camera);
        out->sharpness = sharpness_of(rgb, out->width, out->height);
    }
    if (code == CLI_OK && out->measured) {
        find_depths(out, depth, ldexp((double)frame->frame.depth_unit_q40, -40));
    }
    free(depth);
    free(rgb);
    return code;
}

void view_surface_assume(view_surface *surface, double depth)
{
    for (uint32_t cell = 0; cell < SURFACE_CELLS && !surface->measured; cell++) {
        surface->depth[cell] = depth;
    }
}

bool view_surface_point(const view_surface *s, uint32_t cell, double point[3])
{
    const double u = (cell % SURFACE_ACROSS + 0.5) * s->width / SURFACE_ACROSS - 0.5;
    const double v = (cell / SURFACE_ACROSS + 0.5) * s->height / SURFACE_DOWN - 0.5;
    pinhole_point(&s->camera, u, v, s->depth[cell], point);
    return s->depth[cell] > 0;
}

/* Whether depth z agrees with the cell's or with that of a cell beside it. */
static bool agrees(const view_surface *s, int32_t column, int32_t row, double z)
{
    bool any = false;
    for (int32_t y = row - 1; y <= row + 1; y++) {
        for (int32_t x = column - 1; x <= column + 1; x++) {
            const bool inside = x >= 0 && y >= 0 && x < SURFACE_ACROSS && y < SURFACE_DOWN;
            const double depth = inside ? s->depth[y * SURFACE_ACROSS + x] : 0;
            any = any || (depth > 0 && fabs(depth - z) <= WITHIN * z);
        }
    }
    return any;
}

bool view_surface_sees(const view_surface *s, const double point[3])
{
    double pixel[2], z;
    if (!pinhole_project(&s->camera, point, pixel, &z)) {
        return false;
    }
    const double x = (pixel[0] + 0.5) / s->width, y = (pixel[1] + 0.5) / s->height;
    return x >= 0 && y >= 0 && x < 1 && y < 1 &&
           (!s->measured || agrees(s, (int32_t)(x * SURFACE_ACROSS), (int32_t)(y * SURFACE_DOWN), z));
}

double view_surface_shared(const view_surface *of, const view_surface *by)
{
    uint32_t known = 0, seen = 0;
    for (uint32_t cell = 0; cell < SURFACE_CELLS; cell++) {
        double point[3];
        if (view_surface_point(of, cell, point)) {
            known++;
            seen += view_surface_sees(by, point);
        }
    }
    return known > 0 ? (double)seen / known : 0;
}

static int ascending(const void *a, const void *b)
{
    const double p = *(const double *)a, q = *(const double *)b;
    return (p > q) - (p < q);
}

double view_sharpness_usual(const double *values, uint32_t count)
{
    double *sorted = malloc((count + 1) * sizeof *sorted), usual = 0;
    if (sorted != NULL && count > 0) {
        memcpy(sorted, values, count * sizeof *sorted);
        qsort(sorted, count, sizeof *sorted, ascending);
        usual = sorted[count / 2];
    }
    free(sorted);
    return usual;
}

bool view_sharpness_is_blurred(double sharpness, double usual)
{
    return sharpness < BLURRED * usual;
}
