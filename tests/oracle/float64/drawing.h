/* SPDX-License-Identifier: Apache-2.0 */
/* Shared by the raster tests: generated scenes, rendered by the runtime in arenas of chosen sizes. */
#ifndef TRIM3R_TESTS_ORACLE_DRAWING_H
#define TRIM3R_TESTS_ORACLE_DRAWING_H

#include <stddef.h>
#include <stdint.h>

#include "trim3r.h"

/* A picture rendered by the runtime; draw() checks guard bytes around every plane. */
typedef struct drawing {
    uint32_t width, height;
    uint8_t *rgb;
    uint32_t *depth_q20;
    uint16_t *alpha_q15;
    uint32_t passes;
} drawing;

/* Arena sizes: the minimum, or this multiple of the full size. */
enum { ARENA_AT_MINIMUM = 0, ARENA_AT_FULL = 1, ARENA_AT_TEN_TIMES = 10 };

typedef struct arena {
    void *bytes;
    size_t count;
} arena;
arena arena_of(const t3r_config *config, int size);
arena arena_of_bytes(size_t count);
void arena_free(arena *a);

/* Returns a configuration that only renders. */
t3r_config render_config(uint32_t max_gaussians, uint32_t width, uint32_t height);

/* Loads the scene into rt and renders it; asserts statuses. Call drawing_free(). */
void load_scene(t3r_runtime *rt, const t3r_scene_frame *frame, const t3r_gaussian *gaussians, size_t count);
drawing draw(t3r_runtime *rt, const t3r_camera *camera, uint32_t width, uint32_t height);
drawing draw_scene(const t3r_scene_frame *frame, const t3r_gaussian *gaussians, size_t count, const t3r_camera *camera,
                   uint32_t width, uint32_t height, int arena_size);
void drawing_free(drawing *d);
int drawing_equal(const drawing *a, const drawing *b);

/* A fixed sequence of 64-bit numbers (xorshift64*). */
typedef struct dice {
    uint64_t state;
} dice;
uint32_t dice_below(dice *d, uint32_t bound);
double dice_between(dice *d, double low, double high);

/* factor = round(f / 2^e) with the smallest e that holds all nine in 16 bits. */
void set_factor(t3r_gaussian *g, const double f[9]);
/* Position in scene units, isotropic of the given sigma, full confidence. */
t3r_gaussian round_gaussian(double x, double y, double z, double sigma, double opacity, double r, double g, double b);
/* Makes a random rotation times diag(s0, s1, s2). */
void random_factor(dice *d, const double sigma[3], double f[9]);

/* fx = fy = focal, principal point in the middle of the pixel grid, at the world's origin, looking along +z. */
t3r_camera plain_camera(double focal, uint32_t width, uint32_t height);
/* Returns a camera at `position` (scene units of the plain frame) that looks at `at`, with the world's y pointing
 * down. */
t3r_camera camera_towards(double focal, uint32_t width, uint32_t height, const double position[3], const double at[3]);

#endif
