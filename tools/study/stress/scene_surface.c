/* SPDX-License-Identifier: Apache-2.0 */
#include <math.h>

#include "study/stress/random.h"
#include "study/stress/scene.h"

#define RADIANS 0.017453292519943295
#define OCTAVES 4
#define LEAF_LAYERS 8u
#define LEAVES_NEAR 1.0
#define LEAVES_FAR 2.4
#define BACKDROP 3.0

/* [0, 1) of the whole-numbered corner (x, y) */
static double corner(double x, double y, uint32_t seed)
{
    return stress_uniform(stress_random(seed, (uint32_t)(int32_t)x), (uint32_t)(int32_t)y);
}

/* Smooth noise over a unit grid, 0..1 */
static double cloud(double x, double y, uint32_t seed)
{
    double x0 = floor(x), y0 = floor(y), u = x - x0, v = y - y0;
    u = u * u * (3 - 2 * u);
    v = v * v * (3 - 2 * v);
    double above = corner(x0, y0, seed) * (1 - u) + corner(x0 + 1, y0, seed) * u;
    double below = corner(x0, y0 + 1, seed) * (1 - u) + corner(x0 + 1, y0 + 1, seed) * u;
    return above * (1 - v) + below * v;
}

/* Returns octaves of noise from a period of half a metre down, 0..1. */
static double speckle(double x, double y, uint32_t seed)
{
    double sum = 0, weight = 0.5;
    for (uint32_t o = 0; o < OCTAVES; o++) {
        sum += weight * cloud(x * (double)(2u << o), y * (double)(2u << o), seed + o);
        weight /= 2;
    }
    return sum / (1 - 1.0 / (1 << OCTAVES));
}

static void tint(stress_hit *hit, double r, double g, double b, double light)
{
    hit->rgb[0] = r * light;
    hit->rgb[1] = g * light;
    hit->rgb[2] = b * light;
}

/* Returns the hit on a papered wall at depth z. */
static stress_hit paper(double x, double y, double dx, double dy, double z)
{
    stress_hit hit = {.depth = z};
    double at_x = x + dx * z, at_y = y + dy * z;
    tint(&hit, 210, 190, 160, 0.5 + 0.5 * speckle(at_x, at_y, 31));
    return hit;
}

/* Draws squares of `side` pixels on a plane two metres away that leans by one in five. */
stress_hit stress_plane(double x, double y, double dx, double dy, double pixel, double side)
{
    stress_hit hit = {.depth = (2 + 0.2 * x) / (1 - 0.2 * dx)};
    double at_x = x + dx * hit.depth, at_y = y + dy * hit.depth, square = side * pixel * 2;
    double column = floor(at_x / square), row = floor(at_y / square);
    bool odd = fmod(fabs(column + row), 2) > 0.5;
    double light = (0.6 + 0.4 * corner(column, row, 7)) * (0.7 + 0.3 * speckle(at_x * 3, at_y * 3, 8));
    tint(&hit, odd ? 235 : 40, odd ? 225 : 70, odd ? 190 : 130, light);
    return hit;
}

/* Draws a wall 2.5 metres away on the axis, turned about the vertical; the light falls off across it, and it has no
 * other texture. */
stress_hit stress_wall(double x, double y, double dx, double dy, double pixel, double slant)
{
    (void)pixel;
    double tangent = tan(slant * RADIANS); /* tan(55) x tan(30) < 1: every ray meets the wall */
    stress_hit hit = {.depth = (2.5 + tangent * x) / (1 - tangent * dx)};
    double at_x = x + dx * hit.depth, at_y = y + dy * hit.depth;
    tint(&hit, 215, 212, 205, 1 / (1 + 0.02 * (at_x * at_x + at_y * at_y)));
    return hit;
}

/* Draws upright bars 1.5 metres away, covering a quarter of the width, before a papered wall. */
stress_hit stress_bars(double x, double y, double dx, double dy, double pixel, double width)
{
    double at_x = x + dx * 1.5, period = 4 * width * pixel * 1.5, bar = floor(at_x / period);
    double across = (at_x - bar * period) / period * 4; /* 0..1 on the bar */
    if (across >= 1) {
        return paper(x, y, dx, dy, BACKDROP);
    }
    stress_hit hit = {.depth = 1.5};
    double light = 0.6 + 0.4 * sqrt(fmax(0, 1 - (2 * across - 1) * (2 * across - 1)));
    tint(&hit, 60 + 140 * corner(bar, 0, 3), 60 + 140 * corner(bar, 1, 3), 60 + 140 * corner(bar, 2, 3), light);
    return hit;
}

/* Finds the leaf of a layer's cell that covers (x, y), in lengths of a leaf; one leaf per cell of 1.5 x 1.5. */
static bool leaf(stress_hit *hit, double x, double y, double column, double row, uint32_t layer)
{
    uint32_t seed = stress_random(stress_random(100 + layer, (uint32_t)(int32_t)column), (uint32_t)(int32_t)row);
    double dx = x - (column + 0.25 + 0.5 * stress_uniform(seed, 0)) * 1.5;
    double dy = y - (row + 0.25 + 0.5 * stress_uniform(seed, 1)) * 1.5;
    double turn = 6.283185307179586 * stress_uniform(seed, 2);
    double along = dx * cos(turn) + dy * sin(turn), across = dy * cos(turn) - dx * sin(turn);
    double inside = 4 * along * along + 25 * across * across;
    if (inside >= 1) {
        return false;
    }
    double light = (0.5 + 0.5 * stress_uniform(seed, 3)) * (across > 0 ? 1 : 0.85) * (1 - 0.3 * inside);
    tint(hit, 60 + 90 * stress_uniform(seed, 4), 130 + 90 * stress_uniform(seed, 5), 40, light);
    return true;
}

/* Draws leaves that face the camera, in eight layers from one metre to 2.4, before a papered wall. */
stress_hit stress_foliage(double x, double y, double dx, double dy, double pixel, double length)
{
    for (uint32_t layer = 0; layer < LEAF_LAYERS; layer++) {
        stress_hit hit = {.depth = LEAVES_NEAR + (LEAVES_FAR - LEAVES_NEAR) * layer / (LEAF_LAYERS - 1)};
        double unit = length * pixel * 1.5; /* metres a leaf */
        double at_x = (x + dx * hit.depth) / unit, at_y = (y + dy * hit.depth) / unit;
        double column = floor(at_x / 1.5), row = floor(at_y / 1.5);
        for (int neighbour = 0; neighbour < 9; neighbour++) {
            if (leaf(&hit, at_x, at_y, column + neighbour % 3 - 1, row + neighbour / 3 - 1, layer)) {
                return hit;
            }
        }
    }
    return paper(x, y, dx, dy, BACKDROP);
}

/* Draws a papered wall two metres away with an upright mirror around its middle, which shows squares 1.5 metres
 * behind the camera. Sensors that project a pattern measure the glass. */
stress_hit stress_mirror(double x, double y, double dx, double dy, double pixel, double share)
{
    (void)pixel;
    double at_x = x + dx * 2;
    if (fabs(at_x) > share / 100 * 2 / 1.7320508075688772) { /* half the visible width from the middle */
        return paper(x, y, dx, dy, 2);
    }
    stress_hit hit = {.depth = 2};
    double far_x = x + dx * 5.5, far_y = y + dy * 5.5; /* 2 m there, 3.5 m back */
    bool odd = fmod(fabs(floor(far_x / 0.5) + floor(far_y / 0.5)), 2) > 0.5;
    tint(&hit, odd ? 90 : 200, odd ? 60 : 195, odd ? 50 : 180, 0.6 + 0.4 * speckle(far_x, far_y, 55));
    return hit;
}
