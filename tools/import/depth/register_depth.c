#include "import/depth/register_depth.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/little_endian.h"

void register_depth_size(const t3r_frame *frame, uint32_t *width, uint32_t *height)
{
    uint32_t n = 1;
    while (frame->width / n > frame->depth_width || frame->height / n > frame->depth_height) {
        n++;
    }
    *width = frame->width / n > 2 ? frame->width / n : 2;
    *height = frame->height / n > 2 ? frame->height / n : 2;
}

/* Constants of the target for all samples. */
typedef struct target {
    const lens *colour;
    const rigid *from_depth;
    uint32_t width, height;
    double scale[2];  /* its pixels per pixel of colour */
    double widest[2]; /* largest square of a sample in its pixels: a larger one is at the camera itself */
    double unit;
    uint8_t *out;
} target;

/* Projects a corner of a sample's square into the target's pixels; *depth is its depth in the colour camera. */
static bool corner(const target *t, const float ray[2], double z, double pixel[2], double *depth)
{
    const double point[3] = {(double)ray[0] * z, (double)ray[1] * z, z};
    double moved[3];
    rigid_apply(t->from_depth, point, moved);
    if (!lens_project(t->colour, moved, pixel)) {
        return false;
    }
    for (int i = 0; i < 2; i++) {
        pixel[i] = (pixel[i] + 0.5) * t->scale[i] - 0.5;
    }
    *depth = moved[2];
    return true;
}

/* Finds the pixels whose centres lie from a to b, at least the nearest one; within 0..count - 1. */
static bool span(double a, double b, double widest, uint32_t count, uint32_t *first, uint32_t *last)
{
    double low = ceil(fmin(a, b)), high = ceil(fmax(a, b)) - 1;
    if (fmax(a, b) - fmin(a, b) > widest) {
        return false;
    }
    if (high < low) {
        low = high = floor((a + b) / 2 + 0.5);
    }
    if (high < 0 || low > count - 1) {
        return false;
    }
    *first = low < 0 ? 0 : (uint32_t)low;
    *last = high > count - 1 ? count - 1 : (uint32_t)high;
    return true;
}

static void draw(const target *t, const float from[2], const float to[2], double z)
{
    double a[2], b[2], depth_a, depth_b;
    uint32_t x0, x1, y0, y1;
    if (!corner(t, from, z, a, &depth_a) || !corner(t, to, z, b, &depth_b) ||
        !span(a[0], b[0], t->widest[0], t->width, &x0, &x1) || !span(a[1], b[1], t->widest[1], t->height, &y0, &y1)) {
        return;
    }
    double steps = nearbyint((depth_a + depth_b) / 2 / t->unit);
    if (!(steps >= 1 && steps <= UINT16_MAX)) {
        return;
    }
    for (uint32_t y = y0; y <= y1; y++) {
        for (uint32_t x = x0; x <= x1; x++) {
            uint8_t *sample = t->out + 2 * ((size_t)y * t->width + x);
            uint16_t there = t3r_load_le16(sample);
            if (there == 0 || there > steps) {
                t3r_store_le16(sample, (uint16_t)steps);
            }
        }
    }
}

bool ray_grid_make(ray_grid *grid, const lens *l, uint32_t width, uint32_t height, const void *of)
{
    if (grid->rays != NULL && grid->of == of && grid->width == width && grid->height == height) {
        return true;
    }
    free(grid->rays);
    *grid = (ray_grid){malloc(((size_t)width + 1) * (height + 1) * sizeof *grid->rays), width, height, of};
    for (uint32_t y = 0; y <= height && grid->rays != NULL; y++) {
        for (uint32_t x = 0; x <= width; x++) {
            double ray[2];
            lens_ray(l, x - 0.5, y - 0.5, ray);
            float *kept = grid->rays[(size_t)y * (width + 1) + x];
            kept[0] = (float)ray[0];
            kept[1] = (float)ray[1];
        }
    }
    return grid->rays != NULL;
}

void ray_grid_free(ray_grid *grid)
{
    free(grid->rays);
    *grid = (ray_grid){0};
}

void register_depth(const t3r_frame *frame, const ray_grid *rays, const lens *colour, const rigid *from_depth,
                    uint8_t *out)
{
    target t = {
        .colour = colour, .from_depth = from_depth, .unit = ldexp((double)frame->depth_unit_q40, -40), .out = out};
    register_depth_size(frame, &t.width, &t.height);
    t.scale[0] = t.width / (double)frame->width;
    t.scale[1] = t.height / (double)frame->height;
    t.widest[0] = 4 + 2.0 * t.width / frame->depth_width;
    t.widest[1] = 4 + 2.0 * t.height / frame->depth_height;
    memset(out, 0, (size_t)t.width * t.height * 2);
    for (uint32_t y = 0; y < frame->depth_height; y++) {
        const uint8_t *row = frame->depth + (size_t)y * frame->depth_stride_bytes;
        const float(*above)[2] = (const float(*)[2])rays->rays + (size_t)y * (rays->width + 1);
        const float(*below)[2] = above + rays->width + 1;
        for (uint32_t x = 0; x < frame->depth_width; x++) {
            uint16_t steps = t3r_load_le16(row + 2 * (size_t)x);
            if (steps > 0) {
                draw(&t, above[x], below[x + 1], steps * t.unit);
            }
        }
    }
}
