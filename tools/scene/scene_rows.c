/* SPDX-License-Identifier: Apache-2.0 */
#include "scene/scene_rows.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>

#include "core/scene_frame.h"
#include "host/reason.h"
#include "scene/gaussian_shape.h"

/* Farthest position for the runtime, in scene units; leaves a margin for the rounding of the origin. */
#define FARTHEST 1023

static int compare_doubles(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Converts a world coordinate to Q32; |value| < 2^30. */
static int64_t to_q32(double value)
{
    return (int64_t)nearbyint(ldexp(value, 32));
}

static int read_row(const scene_rows *rows, const scene_turn *turn, uint32_t index, scene_row *row, char *error,
                    size_t error_bytes)
{
    if (rows->read(rows->user, index, row, error, error_bytes) != 0) {
        return -1;
    }
    scene_turn_apply(turn, row->position, row->rotation, rows->degree, row->rest);
    return 0;
}

/* Chooses a frame for a file without one: origin at the mean position, median distance from it in [1, 2) scene units.
 * If the farthest is beyond the runtime's range of 2^10, the exponent rises by up to 6: positions then still resolve
 * 2^-14 of the median distance. */
static int choose_frame(const scene_rows *rows, const scene_turn *turn, t3r_scene_frame *frame, char *error,
                        size_t error_bytes)
{
    double mean[3] = {0};
    scene_row row;
    for (uint32_t i = 0; i < rows->count; i++) {
        if (read_row(rows, turn, i, &row, error, error_bytes) != 0) {
            return -1;
        }
        for (int axis = 0; axis < 3; axis++) {
            mean[axis] += row.position[axis] / rows->count;
        }
    }
    double *distance = malloc(rows->count * sizeof *distance);
    if (distance == NULL) {
        return t3r_reason(error, error_bytes, "out of memory for %" PRIu32 " Gaussians", rows->count);
    }
    double largest_scale = -INFINITY;
    for (uint32_t i = 0; i < rows->count; i++) {
        (void)read_row(rows, turn, i, &row, error, error_bytes); /* checked above */
        const double *p = row.position, *scale = row.log_scale;
        distance[i] = sqrt((p[0] - mean[0]) * (p[0] - mean[0]) + (p[1] - mean[1]) * (p[1] - mean[1]) +
                           (p[2] - mean[2]) * (p[2] - mean[2]));
        largest_scale = fmax(largest_scale, fmax(scale[0], fmax(scale[1], scale[2])));
    }
    qsort(distance, rows->count, sizeof *distance, compare_doubles);
    double median = distance[rows->count / 2], farthest = distance[rows->count - 1];
    free(distance);
    /* Gaussians that share one place are as large as their scales */
    double size = median > 0 ? median : farthest > 0 ? farthest : exp(fmin(fmax(largest_scale, -30), 30));
    double span = fmax(fmax(fabs(mean[0]), fabs(mean[1])), fmax(fabs(mean[2]), farthest));
    int exponent;
    (void)frexp(size, &exponent);
    exponent--;
    if (!(span < 0x1p30) || exponent < T3R_EXPONENT_LEAST || exponent > T3R_EXPONENT_MOST) {
        return t3r_reason(error, error_bytes,
                          "half of the positions lie within %g units of (%g, %g, %g): outside 2^-24..2^24", size,
                          mean[0], mean[1], mean[2]);
    }
    int raised = 0;
    while (raised < 6 && exponent + raised < T3R_EXPONENT_MOST && ldexp(farthest, -exponent - raised) >= FARTHEST) {
        raised++;
    }
    frame->exponent = exponent + raised;
    for (int axis = 0; axis < 3; axis++) {
        frame->origin_q32[axis] = to_q32(mean[axis]);
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

/* Converts harmonics. Coefficients beyond 8 are clamped to 8: colours need no more than 2. */
static void convert_harmonics(const scene_row *row, uint32_t degree, int16_t *harmonics_q12)
{
    for (uint32_t i = 0; i < 3 * (harmonics_rest(degree) + 1); i++) {
        const double value = i < 3 ? row->harmonic[i] : row->rest[i / 3 - 1][i % 3];
        harmonics_q12[i] = (int16_t)fmax(fmin(nearbyint(value * 4096), INT16_MAX), INT16_MIN);
    }
}

static int convert_row(const scene_rows *rows, const scene_turn *turn, uint32_t index, scene_file *scene, char *error,
                       size_t error_bytes)
{
    static const char *const axes[] = {"x", "y", "z"};
    const t3r_scene_frame *frame = &scene->frame;
    t3r_gaussian *g = &scene->gaussians[index];
    scene_row row;
    double scale[3];
    if (read_row(rows, turn, index, &row, error, error_bytes) != 0) {
        return -1;
    }
    *g = (t3r_gaussian){.confidence = 255};
    for (int i = 0; i < 3; i++) {
        double origin = rows->has_frame && rows->local ? 0 : ldexp((double)frame->origin_q32[i], -32);
        double position = nearbyint(ldexp(row.position[i] - origin, 20 - frame->exponent));
        if (!(fabs(position) < T3R_POSITION_MOST_Q20)) {
            return t3r_reason(error, error_bytes, "vertex %" PRIu32 ": %s = %g lies too far from the others", index,
                              axes[i], row.position[i]);
        }
        g->position_q20[i] = (int32_t)position;
        g->colour_q7[i] = clamp_to((0.5 + HARMONICS_ZERO * row.harmonic[i]) * 32640, 32640);
        scale[i] = exp(row.log_scale[i] - frame->exponent * M_LN2);
    }
    if (gaussian_shape_set(g, scale, row.rotation) != 0) {
        return t3r_reason(error, error_bytes,
                          "vertex %" PRIu32 ": a rotation without length, or a scale beyond the format", index);
    }
    g->opacity_q15 = clamp_to(32768 / (1 + exp(-row.opacity_logit)), 32767);
    if (scene->degree > 0) {
        convert_harmonics(&row, scene->degree, scene_file_harmonics(scene, index));
    }
    return 0;
}

int scene_file_from_rows(const scene_rows *rows, scene_file *out, char *error, size_t error_bytes)
{
    *out = (scene_file){0};
    scene_file scene = {.frame = rows->frame, .count = rows->count, .degree = rows->degree};
    const scene_turn turn = scene_turn_from(rows->axes);
    if ((rows->has_frame ? check_frame(&scene.frame, error, error_bytes)
                         : choose_frame(rows, &turn, &scene.frame, error, error_bytes)) != 0) {
        return -1;
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
    *out = scene;
    return 0;
}

void scene_file_free(scene_file *scene)
{
    free(scene->gaussians);
    free(scene->harmonics_q12);
    *scene = (scene_file){0};
}
