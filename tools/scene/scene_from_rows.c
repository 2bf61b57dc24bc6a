/* SPDX-License-Identifier: Apache-2.0 */
/* Converts rows to the fixed point of the runtime. */
#include "scene/scene_rows.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "core/scene_frame.h"
#include "host/reason.h"
#include "scene/gaussian_shape.h"
#include "scene/scene_extent.h"

/* Widest scale of the fixed point, in scene units: such a Gaussian covers every picture. */
#define SCALE_MOST 0x1p29
/* Farthest distance of a Gaussian, in reaches of the fixed point. */
#define TIMES_MOST 0x1p200

/* Converts a world coordinate to Q32; |value| < 2^30. */
static int64_t to_q32(double value)
{
    return (int64_t)nearbyint(ldexp(value, 32));
}

int scene_rows_choose_frame(const scene_rows *rows, const scene_turn *turn, t3r_scene_frame *frame,
                            scene_extent *extent, char *error, size_t error_bytes)
{
    if (scene_extent_of(rows, extent, error, error_bytes) != 0) {
        return -1;
    }
    double centre[3] = {extent->centre[0], extent->centre[1], extent->centre[2]}, none[4] = {1, 0, 0, 0};
    scene_turn_apply(turn, centre, none, 0, NULL);
    frame->exponent = scene_extent_exponent(extent);
    if (!(fmax(fabs(centre[0]), fmax(fabs(centre[1]), fabs(centre[2]))) < 0x1p30) ||
        frame->exponent < T3R_EXPONENT_LEAST || frame->exponent > T3R_EXPONENT_MOST) {
        return t3r_reason(error, error_bytes,
                          "half of the positions lie within %g units of (%g, %g, %g): outside 2^-24..2^24",
                          extent->typical, centre[0], centre[1], centre[2]);
    }
    for (int axis = 0; axis < 3; axis++) {
        frame->origin_q32[axis] = to_q32(centre[axis]);
    }
    return 0;
}

static int check_frame(const t3r_scene_frame *frame, char *error, size_t error_bytes)
{
    if (frame->exponent < T3R_EXPONENT_LEAST || frame->exponent > T3R_EXPONENT_MOST) {
        return t3r_reason(error, error_bytes, "the header names an exponent of %" PRId32 ", outside %d..%d",
                          frame->exponent, T3R_EXPONENT_LEAST, T3R_EXPONENT_MOST);
    }
    for (int axis = 0; axis < 3; axis++) {
        /* 2^30 world units, so that the difference of two origins fits */
        if (frame->origin_q32[axis] <= -(INT64_C(1) << 62) || frame->origin_q32[axis] >= INT64_C(1) << 62) {
            return t3r_reason(error, error_bytes, "the header names an origin beyond 2^30");
        }
    }
    return 0;
}

static uint16_t clamp_to(double value, int most)
{
    return (uint16_t)(value <= 0 ? 0 : value >= most ? most : nearbyint(value));
}

/* Converts a coefficient of red, green and blue. Returns whether one is beyond 8, where it is clamped. */
static bool convert_coefficient(const double coefficient[3], int16_t q12[3])
{
    bool clipped = false;
    for (int i = 0; i < 3; i++) {
        const double value = nearbyint(coefficient[i] * 4096);
        q12[i] = (int16_t)(value > INT16_MAX ? INT16_MAX : value < INT16_MIN ? INT16_MIN : value);
        clipped |= value != q12[i];
    }
    return clipped;
}

/* Converts harmonics. Returns whether one is clamped. */
static bool convert_harmonics(const scene_row *row, uint32_t degree, int16_t *harmonics_q12)
{
    bool clipped = convert_coefficient(row->harmonic, harmonics_q12);
    for (uint32_t i = 0; i < harmonics_rest(degree); i++) {
        clipped |= convert_coefficient(row->rest[i], &harmonics_q12[3 * (i + 1)]);
    }
    return clipped;
}

/* Notes how far a Gaussian is that was pulled. Returns 0, or -1 without memory. */
static int add_far(scene_file *scene, uint32_t index, double times)
{
    const uint32_t count = scene->far_count;
    if ((count & (count - 1)) == 0) { /* it is full at powers of two */
        t3r_scene_far *more = realloc(scene->far, (count == 0 ? 1 : 2 * (size_t)count) * sizeof *more);
        if (more == NULL) {
            return -1;
        }
        scene->far = more;
    }
    scene->far[scene->far_count++] = (t3r_scene_far){index, fmin(times, TIMES_MOST)};
    scene->remarks.pulled = scene->far_count;
    return 0;
}

static int convert_row(const scene_rows *rows, const scene_turn *turn, uint32_t index, scene_file *scene, char *error,
                       size_t error_bytes)
{
    const t3r_scene_frame *frame = &scene->frame;
    t3r_gaussian *g = &scene->gaussians[index];
    scene_row row;
    double scale[3];
    if (scene_rows_read(rows, index, &row, error, error_bytes) != 0) {
        return -1;
    }
    scene_turn_apply(turn, row.position, row.rotation, rows->degree, row.rest);
    for (int i = 0; i < 3 && !(rows->has_frame && rows->local); i++) {
        row.position[i] -= ldexp((double)frame->origin_q32[i], -32);
    }
    const double times = scene_pull(&row, ldexp(SCENE_REACH, frame->exponent));
    if (times > 1 && add_far(scene, index, times) != 0) {
        return t3r_reason(error, error_bytes, "out of memory for a Gaussian far away");
    }
    const bool is_backdrop = index >= rows->count - rows->backdrop;
    *g = (t3r_gaussian){.confidence = is_backdrop ? 0 : 255, .view = is_backdrop ? T3R_NO_VIEW : 0};
    for (int i = 0; i < 3; i++) {
        g->position_q20[i] = (int32_t)nearbyint(ldexp(row.position[i], 20 - frame->exponent));
        g->colour_q7[i] = clamp_to((0.5 + HARMONICS_ZERO * row.harmonic[i]) * 32640, 32640);
        scale[i] = fmin(exp(row.log_scale[i] - frame->exponent * M_LN2), SCALE_MOST);
    }
    if (gaussian_shape_set(g, scale, row.rotation) != 0) {
        return t3r_reason(error, error_bytes, "Gaussian %" PRIu32 ": a shape beyond the format", index);
    }
    g->opacity_q15 = clamp_to(32768 / (1 + exp(-row.opacity_logit)), 32767);
    if (scene->degree > 0) {
        scene->remarks.clipped += convert_harmonics(&row, scene->degree, scene_file_harmonics(scene, index));
    }
    return 0;
}

int scene_file_from_rows(const scene_rows *rows, scene_file *out, char *error, size_t error_bytes)
{
    *out = (scene_file){0};
    scene_file scene = {
        .frame = rows->frame, .count = rows->count, .degree = rows->degree, .mip = rows->mip, .up = rows->up};
    const scene_turn turn = scene_turn_between(rows->axes, SCENE_AXES_AS_THEY_ARE, T3R_UP_UNKNOWN);
    scene_extent extent = {0};
    if ((rows->has_frame ? check_frame(&scene.frame, error, error_bytes)
                         : scene_rows_choose_frame(rows, &turn, &scene.frame, &extent, error, error_bytes)) != 0) {
        return -1;
    }
    scene.finer = extent.finer;
    if (scene_extent_is_rounded(&extent)) {
        scene.remarks.step = extent.step;
        scene.remarks.width = extent.width;
    }
    scene.gaussians = malloc(rows->count * sizeof *scene.gaussians);
    scene.harmonics_q12 =
        rows->degree == 0 ? NULL : malloc(rows->count * scene_file_harmonics_count(&scene) * sizeof(int16_t));
    if (scene.gaussians == NULL || (rows->degree > 0 && scene.harmonics_q12 == NULL)) {
        scene_file_free(&scene);
        return t3r_reason(error, error_bytes, "out of memory for %" PRIu32 " Gaussians", rows->count);
    }
    for (uint32_t i = 0; i < rows->count; i++) {
        if (convert_row(rows, &turn, i, &scene, error, error_bytes) != 0) {
            scene_file_free(&scene);
            return -1;
        }
    }
    snprintf(scene.remarks.text, sizeof scene.remarks.text, "%s", rows->remark != NULL ? rows->remark : "");
    *out = scene;
    return 0;
}

void scene_file_free(scene_file *scene)
{
    free(scene->gaussians);
    free(scene->harmonics_q12);
    free(scene->far);
    *scene = (scene_file){0};
}
