/* SPDX-License-Identifier: Apache-2.0 */
#include "room/room.h"

#include <stddef.h>

#include "core/fixed.h"
#include "room/scene.h"
#include "room/texture.h"

#define FOCAL_PER_WIDTH_Q16 56756u /* 1 / (2 tan 30 degrees): 60 degrees across the width */
#define RADIUS ROOM_MM(2600)       /* of the arc around the room's centre */
#define HALF_STEP_Q14 330          /* half the tangent of half the rotation between frames: 4.6 degrees, 0.21 m */
#define SUBSAMPLES 2               /* per side */

typedef struct view {
    int32_t rotation_q30[4]; /* w x y z */
    int64_t matrix_q30[9];
    room_vector position;
} view;

/* Returns 0, 1 .. half, half - 1 .. 1, 0, 1 ... */
static int32_t swing(uint32_t index, uint32_t half)
{
    uint32_t phase = index % (2 * half);
    return (int32_t)(phase < half ? phase : 2 * half - phase);
}

/* Normalises a whole-number quaternion to Q30; |q| below 2^16. */
static void normalise(const int64_t q[4], int32_t out_q30[4])
{
    uint64_t squared = (uint64_t)(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    int64_t norm_q14 = (int64_t)t3r_isqrt64(squared << 28);
    for (int i = 0; i < 4; i++) {
        out_q30[i] = (int32_t)(q[i] * ((int64_t)1 << 44) / norm_q14);
    }
}

static void to_matrix(const int32_t q[4], int64_t m[9])
{
    int64_t w = q[0], x = q[1], y = q[2], z = q[3];
    const int64_t one = (int64_t)1 << 60;
    const int64_t doubled[9] = {one - 2 * (y * y + z * z), 2 * (x * y - w * z),       2 * (x * z + w * y),
                                2 * (x * y + w * z),       one - 2 * (x * x + z * z), 2 * (y * z - w * x),
                                2 * (x * z - w * y),       2 * (y * z + w * x),       one - 2 * (x * x + y * y)};
    for (int i = 0; i < 9; i++) {
        m[i] = t3r_round_shift64(doubled[i], 30);
    }
}

/* Moves along the arc and back and, at another period, up and down: the path repeats after 70 frames. The camera looks
 * at the arc's centre. Yaw is about y, pitch about x; a quaternion (1, tan of half the angle) need not be unit. */
static void view_of(uint32_t index, view *out)
{
    static const int64_t middle[3] = {ROOM_MM(0), ROOM_MM(260), ROOM_MM(2550)};
    const int64_t one = 1 << 14;
    int64_t yaw = -(2 * swing(index, 5) - 5) * HALF_STEP_Q14;
    int64_t pitch = -700 + (swing(index + 2, 7) - 3) * 45;
    const int64_t q[4] = {one, pitch, yaw, -t3r_round_shift64(yaw * pitch, 14)};
    normalise(q, out->rotation_q30);
    to_matrix(out->rotation_q30, out->matrix_q30);
    for (int i = 0; i < 3; i++) {
        out->position.v[i] = middle[i] - t3r_round_shift64(out->matrix_q30[i * 3 + 2] * RADIUS, 30);
    }
}

void room_camera(uint32_t index, uint32_t width, uint32_t height, t3r_camera *camera)
{
    view v;
    view_of(index, &v);
    *camera = (t3r_camera){.width = width, .height = height, .distortion = T3R_DISTORTION_NONE};
    camera->fx_q16 = camera->fy_q16 = (int32_t)(width * FOCAL_PER_WIDTH_Q16);
    camera->cx_q16 = (int32_t)((width - 1) << 15);
    camera->cy_q16 = (int32_t)((height - 1) << 15);
    for (int i = 0; i < 3; i++) {
        camera->position_q32[i] = v.position.v[i] * 65536;
    }
    for (int i = 0; i < 4; i++) {
        camera->rotation_q30[i] = v.rotation_q30[i];
    }
}

void room_recorded_camera(uint32_t index, uint32_t width, uint32_t height, t3r_recorded_camera *camera)
{
    t3r_camera c;
    room_camera(index, width, height, &c);
    *camera = (t3r_recorded_camera){.width = width, .height = height};
    camera->fx = c.fx_q16 * 0x1p-16;
    camera->fy = c.fy_q16 * 0x1p-16;
    camera->cx = c.cx_q16 * 0x1p-16;
    camera->cy = c.cy_q16 * 0x1p-16;
    for (int i = 0; i < 3; i++) {
        camera->position[i] = (double)c.position_q32[i] * 0x1p-32;
    }
    for (int i = 0; i < 4; i++) {
        camera->rotation[i] = c.rotation_q30[i] * 0x1p-30;
    }
}

static const int64_t light[3] = {ROOM_MM(350), ROOM_MM(-1480), ROOM_MM(1500)};

/* Returns the light from a ceiling lamp of 0.3 x 0.3 m (each subsample uses its own quarter of it) and ambient light,
 * Q8. */
static int64_t shade(const room_scene *scene, const room_hit *hit, uint32_t quarter)
{
    room_vector origin, to_light;
    int64_t squared = 0, facing = 0;
    for (uint32_t i = 0; i < 3; i++) {
        origin.v[i] = hit->point.v[i] + hit->normal_q14[i] / 256; /* 1 mm off the surface */
        int64_t offset = i == 0 ? ((quarter & 1) != 0 ? 1 : -1) : i == 2 ? ((quarter & 2) != 0 ? 1 : -1) : 0;
        to_light.v[i] = light[i] + offset * ROOM_MM(75) - origin.v[i];
        squared += to_light.v[i] * to_light.v[i];
        facing += to_light.v[i] * hit->normal_q14[i];
    }
    int64_t around = 112 + (hit->normal_q14[1] < 0 ? -hit->normal_q14[1] : hit->normal_q14[1] / 2) / 512;
    if (hit->solid == ROOM_SOLIDS) {
        around -= T3R_MAX(0, 40 - room_scene_corner(&hit->point, hit->axis) / 10); /* corners are darker */
    }
    if (facing <= 0) {
        return around;
    }
    room_vector ray = {{to_light.v[0] * 16, to_light.v[1] * 16, to_light.v[2] * 16}};
    if (room_scene_blocked(scene, &origin, &ray)) {
        return around;
    }
    int64_t cosine_q14 = facing / (int64_t)t3r_isqrt64((uint64_t)squared);
    int64_t distance_squared_q16 = squared >> 16;
    /* 220 cos / (0.6 + 0.14 d^2) */
    return around + 220 * cosine_q14 * 4 / (39322 + distance_squared_q16 * 9 / 64);
}

typedef struct canvas {
    room_scene scene;
    view view;
    uint32_t width, height, seed;
    int64_t focal_q16;
} canvas;

/* Returns the ray through (x, y), in quarters of a pixel from the centre of the picture; its camera z is 1, so
 * distances along it are depths. */
static room_vector ray_through(const canvas *c, int64_t x, int64_t y)
{
    /* Q2 / Q16 to Q24; |x| < 2^14, so the dividend is below 2^52 */
    int64_t a = x * ((int64_t)1 << 38) / c->focal_q16, b = y * ((int64_t)1 << 38) / c->focal_q16;
    room_vector ray;
    for (int i = 0; i < 3; i++) {
        const int64_t *row = &c->view.matrix_q30[i * 3];
        ray.v[i] = t3r_round_shift64(row[0] * a + row[1] * b + row[2] * ((int64_t)1 << 24), 34);
    }
    return ray;
}

static void add_sample(const canvas *c, int64_t x, int64_t y, uint32_t quarter, int64_t sum[3])
{
    room_hit hit;
    room_vector ray = ray_through(c, x, y);
    room_scene_trace(&c->scene, &c->view.position, &ray, &hit);
    /* Q20 to Q16, over f in pixels */
    int64_t footprint = hit.distance * ((int64_t)1 << 12) / (c->focal_q16 * SUBSAMPLES);
    room_colour colour = room_texture(&hit, c->seed, T3R_MAX(footprint, 1));
    int64_t light_q8 = hit.material == ROOM_LAMP ? 256 : shade(&c->scene, &hit, quarter);
    for (int i = 0; i < 3; i++) {
        sum[i] += T3R_MIN(4080, colour.c[i] * light_q8 >> 8);
    }
}

/* Returns the sum of four uniform bytes: nearly normal, deviation 148; 1.15 levels after the shift. Q4 levels. */
static int64_t sensor_noise(uint32_t noise_seed, uint32_t sample)
{
    uint32_t h = t3r_mix32(noise_seed + sample * 0x9e3779b1u);
    int64_t sum = (int64_t)(h & 255) + (h >> 8 & 255) + (h >> 16 & 255) + (h >> 24);
    return (sum - 510) >> 3;
}

static uint16_t depth_at(const canvas *c, int64_t x, int64_t y)
{
    room_hit hit;
    room_vector ray = ray_through(c, x, y);
    room_scene_trace(&c->scene, &c->view.position, &ray, &hit);
    return (uint16_t)t3r_round_shift64(hit.distance * 1000, 20); /* below 8 m */
}

void room_frame(uint32_t index, uint32_t width, uint32_t height, uint32_t seed, uint8_t *rgb, uint16_t *depth_mm)
{
    canvas c = {.width = width, .height = height, .seed = seed, .focal_q16 = (int64_t)width * FOCAL_PER_WIDTH_Q16};
    room_scene_build(&c.scene);
    view_of(index, &c.view);
    uint32_t noise_seed = t3r_mix32(t3r_mix32(seed) + index + 1);
    for (uint32_t y = 0; y < height; y++) {
        for (uint32_t x = 0; x < width; x++) {
            int64_t right = 4 * (int64_t)x - 2 * ((int64_t)width - 1);
            int64_t down = 4 * (int64_t)y - 2 * ((int64_t)height - 1);
            int64_t sum[3] = {0, 0, 0};
            uint32_t at = y * width + x;
            for (uint32_t s = 0; s < SUBSAMPLES * SUBSAMPLES; s++) {
                add_sample(&c, right + ((s & 1) != 0 ? 1 : -1), down + ((s & 2) != 0 ? 1 : -1), s, sum);
            }
            for (uint32_t i = 0; i < 3; i++) {
                int64_t level_q4 = sum[i] / (SUBSAMPLES * SUBSAMPLES) + sensor_noise(noise_seed, at * 3 + i);
                rgb[(size_t)at * 3 + i] = (uint8_t)t3r_clamp64(t3r_round_shift64(level_q4, 4), 0, 255);
            }
            if (depth_mm != NULL) {
                depth_mm[at] = depth_at(&c, right, down);
            }
        }
    }
}

uint32_t room_triplets(uint32_t frames, t3r_triplet triplets[ROOM_MAX_TRIPLETS])
{
    static const t3r_triplet all[ROOM_MAX_TRIPLETS] = {{{0, 2}, 1}, {{3, 5}, 4}, {{0, 5}, 3}};
    static const uint32_t needed[ROOM_MAX_TRIPLETS] = {3, 6, 6};
    uint32_t count = 0;
    while (count < ROOM_MAX_TRIPLETS && needed[count] <= frames) {
        triplets[count] = all[count];
        count++;
    }
    return count;
}
