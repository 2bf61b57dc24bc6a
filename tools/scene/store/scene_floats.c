/* SPDX-License-Identifier: Apache-2.0 */
/* Scenes from and to arrays of floats, for programs of the host library. */
#include <inttypes.h>
#include <math.h>
#include <stdbool.h>

#include "host/program_check.h"
#include "host/reason.h"
#include "scene/scene_rows.h"

/* Farthest colour of degree 0 in either direction: colours in levels of 255 are beyond it. */
#define COLOUR_MOST 16

/* Copies a Gaussian of the arrays into a row. */
static int read_floats(void *user, uint32_t index, scene_row *row, char *error, size_t error_bytes)
{
    const t3r_scene_floats *floats = user;
    const size_t rest = harmonics_rest(floats->degree);
    const double opacity = floats->opacities[index];
    (void)error;
    (void)error_bytes;
    *row = (scene_row){.opacity_logit = log(opacity / (1 - opacity))};
    for (size_t i = 0; i < 3; i++) {
        row->position[i] = floats->positions[3 * (size_t)index + i];
        row->log_scale[i] = log(floats->scales[3 * (size_t)index + i]);
        row->harmonic[i] = (floats->colours[3 * (size_t)index + i] - 0.5) / HARMONICS_ZERO;
    }
    for (size_t i = 0; i < 4; i++) {
        row->rotation[i] = floats->rotations[4 * (size_t)index + i];
    }
    for (size_t i = 0; i < 3 * rest; i++) {
        row->rest[i / 3][i % 3] = floats->harmonics[3 * rest * index + i];
    }
    return 0;
}

/* ---- checks ------------------------------------------------------------------------------------------------------ */

/* An array of the scene, and the numbers that it may hold. */
typedef struct bounded_array {
    const char *name;
    const double *values;
    uint32_t width; /* numbers of a Gaussian */
    double least, most;
    const char *allowed; /* the bounds in words, and a remedy */
} bounded_array;

static int refuse(const char *name, uint32_t width, size_t at, double value, const char *allowed, char *error,
                  size_t error_bytes)
{
    return width == 1 ? t3r_reason(error, error_bytes, "%s[%zu] is %g, not %s", name, at, value, allowed)
                      : t3r_reason(error, error_bytes, "%s[%zu][%zu] is %g, not %s", name, at / width, at % width,
                                   value, allowed);
}

static int check_array(const bounded_array *array, uint32_t count, char *error, size_t error_bytes)
{
    if (array->values == NULL) {
        return t3r_reason(error, error_bytes, "%s are missing", array->name);
    }
    for (size_t i = 0; i < (size_t)count * array->width; i++) {
        const double value = array->values[i];
        if (!(value >= array->least && value <= array->most)) {
            return refuse(array->name, array->width, i, value, isfinite(value) ? array->allowed : "a finite number",
                          error, error_bytes);
        }
    }
    return 0;
}

static int check_rotations(const t3r_scene_floats *floats, char *error, size_t error_bytes)
{
    for (uint32_t i = 0; i < floats->count; i++) {
        const double *q = &floats->rotations[4 * (size_t)i];
        if (!(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3] > 0)) {
            return t3r_reason(error, error_bytes, "rotations[%" PRIu32 "] is a quaternion without length", i);
        }
    }
    return 0;
}

static int check_harmonics(const t3r_scene_floats *floats, char *error, size_t error_bytes)
{
    const uint32_t numbers = 3 * harmonics_rest(floats->degree);
    if (numbers > 0 && floats->harmonics == NULL) {
        return t3r_reason(error, error_bytes, "harmonics are missing for degree %" PRIu32, floats->degree);
    }
    for (size_t i = 0; i < (size_t)floats->count * numbers; i++) {
        if (!isfinite(floats->harmonics[i])) {
            const size_t within = i % numbers;
            return t3r_reason(error, error_bytes, "harmonics[%zu][%zu][%zu] is %g, not a finite number", i / numbers,
                              within / 3, within % 3, floats->harmonics[i]);
        }
    }
    return 0;
}

static int check_floats(const t3r_scene_floats *floats, char *error, size_t error_bytes)
{
    const bounded_array arrays[] = {
        {"positions", floats->positions, 3, -0x1p30, 0x1p30, "-2^30 to 2^30 units"},
        {"scales", floats->scales, 3, 0, 0x1p30,
         "a standard deviation of 0 to 2^30 units: of logarithms, as in a .ply, take exp()"},
        {"rotations", floats->rotations, 4, -0x1p100, 0x1p100, "a number of a quaternion"},
        {"colours", floats->colours, 3, -COLOUR_MOST, COLOUR_MOST, "about 0 to 1: divide levels of 255 by 255"},
        {"opacities", floats->opacities, 1, 0, 1, "0 to 1: of logits x, as in a .ply, take 1 / (1 + exp(-x))"},
    };
    if (floats->count == 0 || floats->count > T3R_MAX_GAUSSIANS) {
        return t3r_reason(error, error_bytes, "%" PRIu32 " Gaussians: a scene has 1..%d", floats->count,
                          T3R_MAX_GAUSSIANS);
    }
    if (floats->degree > HARMONICS_DEGREE_MOST) {
        return t3r_reason(error, error_bytes, "the degree of the harmonics is 0..%u, not %" PRIu32,
                          HARMONICS_DEGREE_MOST, floats->degree);
    }
    for (size_t i = 0; i < sizeof arrays / sizeof arrays[0]; i++) {
        if (check_array(&arrays[i], floats->count, error, error_bytes) != 0) {
            return -1;
        }
    }
    return check_rotations(floats, error, error_bytes) != 0 ? -1 : check_harmonics(floats, error, error_bytes);
}

/* ---- the library's calls ----------------------------------------------------------------------------------------- */

t3r_status t3r_scene_of_floats_as(t3r_program program, const t3r_scene_floats *floats, t3r_scene_file *out, char *error,
                                  size_t error_bytes)
{
    if (!t3r_program_fits(program, t3r_host_program(), error, error_bytes)) {
        return T3R_ERR_INTERFACE;
    }
    const scene_rows rows = {.count = floats->count,
                             .degree = floats->degree,
                             .mip = floats->mip,
                             .read = read_floats,
                             .user = (void *)(uintptr_t)floats}; /* only read */
    if (check_floats(floats, error, error_bytes) != 0 || scene_file_from_rows(&rows, out, error, error_bytes) != 0) {
        *out = (t3r_scene_file){0};
        return T3R_ERR_ARGUMENT;
    }
    t3r_reason(error, error_bytes, "%s", "");
    return T3R_OK;
}

t3r_status t3r_floats_of_scene_as(t3r_program program, const t3r_scene_file *scene, t3r_scene_floats *out)
{
    if (!t3r_program_fits(program, t3r_host_program(), NULL, 0)) {
        return T3R_ERR_INTERFACE;
    }
    if (out->count != scene->count || out->degree > scene->degree) {
        return T3R_ERR_ARGUMENT;
    }
    const scene_rows rows = scene_rows_of(scene);
    const size_t rest = harmonics_rest(out->degree);
    for (uint32_t index = 0; index < scene->count; index++) {
        scene_row row;
        (void)rows.read(rows.user, index, &row, NULL, 0); /* of a scene in memory, which does not fail */
        out->opacities[index] = scene_row_opacity(&row);
        for (size_t i = 0; i < 3; i++) {
            out->positions[3 * (size_t)index + i] = row.position[i] + ldexp((double)scene->frame.origin_q32[i], -32);
            out->scales[3 * (size_t)index + i] = exp(row.log_scale[i]);
            out->colours[3 * (size_t)index + i] = scene_row_colour(&row, (int)i);
        }
        for (size_t i = 0; i < 4; i++) {
            out->rotations[4 * (size_t)index + i] = row.rotation[i];
        }
        for (size_t i = 0; i < 3 * rest; i++) {
            out->harmonics[3 * rest * index + i] = (float)row.rest[i / 3][i % 3];
        }
    }
    out->mip = scene->mip;
    return T3R_OK;
}
