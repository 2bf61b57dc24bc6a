#include "scene/scene_rows.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>

#include "core/scene_frame.h"
#include "reason.h"
#include "scene/gaussian_shape.h"

/* Positions the runtime takes, scene units; a little is left for the rounding of the origin. */
#define FARTHEST 1023

static int compare_doubles(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Q32 of a world coordinate; |value| < 2^30 */
static int64_t to_q32(double value)
{
    return (int64_t)nearbyint(ldexp(value, 32));
}

/* A frame for positions that name none: origin at their mean, the median distance from it in [1, 2) scene units.
 * Where the runtime's range of 2^10 does not hold the farthest, the exponent rises by up to 6: positions then still
 * keep 2^-14 of the median distance. */
static int choose_frame(const scene_rows *rows, t3r_scene_frame *frame, char *error, size_t error_bytes)
{
    double mean[3] = {0};
    scene_row row;
    for (uint32_t i = 0; i < rows->count; i++) {
        if (rows->read(rows->user, i, &row, error, error_bytes) != 0) {
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
        (void)rows->read(rows->user, i, &row, error, error_bytes); /* checked above */
        const double *p = row.position, *scale = row.log_scale;
        distance[i] = sqrt((p[0] - mean[0]) * (p[0] - mean[0]) + (p[1] - mean[1]) * (p[1] - mean[1]) +
                           (p[2] - mean[2]) * (p[2] - mean[2]));
        largest_scale = fmax(largest_scale, fmax(scale[0], fmax(scale[1], scale[2])));
    }
    qsort(distance, rows->count, sizeof *distance, compare_doubles);
    double median = distance[rows->count / 2], farthest = distance[rows->count - 1];
    free(distance);
    /* a pile of Gaussians at one place is as large as they are */
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
        /* 2^30 world units, so that differences of two origins fit */
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

static int convert_row(const scene_rows *rows, uint32_t index, const t3r_scene_frame *frame, t3r_gaussian *g,
                       char *error, size_t error_bytes)
{
    static const char *const axes[] = {"x", "y", "z"};
    scene_row row;
    double scale[3];
    if (rows->read(rows->user, index, &row, error, error_bytes) != 0) {
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
        g->colour_q7[i] = clamp_to((0.5 + SCENE_HARMONIC_0 * row.harmonic[i]) * 32640, 32640);
        scale[i] = exp(row.log_scale[i] - frame->exponent * M_LN2);
    }
    if (gaussian_shape_set(g, scale, row.rotation) != 0) {
        return t3r_reason(error, error_bytes,
                          "vertex %" PRIu32 ": a rotation without length, or a scale beyond the format", index);
    }
    g->opacity_q15 = clamp_to(32768 / (1 + exp(-row.opacity_logit)), 32767);
    return 0;
}

int scene_file_from_rows(const scene_rows *rows, scene_file *out, char *error, size_t error_bytes)
{
    *out = (scene_file){0};
    scene_file scene = {.frame = rows->frame, .count = rows->count};
    if ((rows->has_frame ? check_frame(&scene.frame, error, error_bytes)
                         : choose_frame(rows, &scene.frame, error, error_bytes)) != 0) {
        return -1;
    }
    scene.gaussians = malloc(rows->count * sizeof *scene.gaussians);
    if (scene.gaussians == NULL) {
        return t3r_reason(error, error_bytes, "out of memory for %" PRIu32 " Gaussians", rows->count);
    }
    for (uint32_t i = 0; i < rows->count; i++) {
        if (convert_row(rows, i, &scene.frame, &scene.gaussians[i], error, error_bytes) != 0) {
            free(scene.gaussians);
            return -1;
        }
    }
    *out = scene;
    return 0;
}

void scene_file_free(scene_file *scene)
{
    free(scene->gaussians);
    *scene = (scene_file){0};
}
