/* SPDX-License-Identifier: Apache-2.0 */
#include "scene/scene_rows.h"

#include <inttypes.h>
#include <math.h>

#include "geometry/quaternion.h"
#include "host/reason.h"
#include "scene/gaussian_shape.h"

#define UNIT_WITHIN 0x1p-22 /* of length 1: quaternions of floats are nearer if they were unit ones */

/* Reads a row. Returns 0, or -1 with the reason in error[], if one of its numbers cannot be used. */
static int read_valid(const scene_rows *rows, uint32_t index, scene_row *row, char *error, size_t error_bytes)
{
    static const char *const axes[] = {"x", "y", "z"};
    if (rows->read(rows->user, index, row, error, error_bytes) != 0) {
        return -1;
    }
    for (int i = 0; i < 3; i++) {
        if (!(fabs(row->position[i]) <= SCENE_POSITION_MOST)) {
            return t3r_reason(error, error_bytes, "Gaussian %" PRIu32 ": %s = %g", index, axes[i], row->position[i]);
        }
    }
    const double norm = quaternion_norm(row->rotation);
    return norm > 0 && isfinite(norm)
               ? 0
               : t3r_reason(error, error_bytes, "Gaussian %" PRIu32 ": a rotation without length", index);
}

int scene_rows_read(const scene_rows *rows, uint32_t index, scene_row *row, char *error, size_t error_bytes)
{
    char reason[160] = "";
    return read_valid(rows, index, row, reason, sizeof reason) == 0
               ? 0
               : t3r_reason(error, error_bytes, "%s (--drop-invalid leaves such Gaussians out)", reason);
}

/* ---- rows of the runtime's fixed point --------------------------------------------------------------------------- */

/* Returns the logit of an opacity. 0 has no logit, so it is written as an eighth of a step, which reads as 0 again. */
static double opacity_logit(uint16_t opacity_q15)
{
    double opacity = opacity_q15 == 0 ? 0.125 / 32768 : opacity_q15 / 32768.0;
    return log(opacity / (1 - opacity));
}

static void put_harmonics(const scene_file *scene, uint32_t index, scene_row *row)
{
    const int16_t *harmonics_q12 = scene_file_harmonics(scene, index);
    for (uint32_t i = 0; i < 3 * (harmonics_rest(scene->degree) + 1); i++) {
        *(i < 3 ? &row->harmonic[i] : &row->rest[i / 3 - 1][i % 3]) = ldexp(harmonics_q12[i], -12);
    }
}

static int read_gaussian(void *user, uint32_t index, scene_row *row, char *error, size_t error_bytes)
{
    (void)error;
    (void)error_bytes;
    const scene_file *scene = user;
    const t3r_gaussian *g = &scene->gaussians[index];
    const int32_t exponent = scene->frame.exponent;
    gaussian_shape shape = gaussian_shape_of(g);
    *row = (scene_row){.opacity_logit = opacity_logit(g->opacity_q15)};
    for (int i = 0; i < 3; i++) {
        row->position[i] = ldexp(g->position_q20[i], exponent - 20);
        row->harmonic[i] = (g->colour_q7[i] / 32640.0 - 0.5) / HARMONICS_ZERO;
        row->log_scale[i] = log(shape.scale[i]) + exponent * M_LN2;
    }
    for (int i = 0; i < 4; i++) {
        row->rotation[i] = shape.rotation[i];
    }
    if (scene->degree > 0) {
        put_harmonics(scene, index, row);
    }
    return 0;
}

scene_rows scene_rows_of(const scene_file *scene)
{
    return (scene_rows){.count = scene->count,
                        .has_frame = true,
                        .local = true,
                        .frame = scene->frame,
                        .degree = scene->degree,
                        .mip = scene->mip,
                        .up = scene->up,
                        .backdrop = scene->count - scene_surfaces(scene->gaussians, scene->count),
                        .read = read_gaussian,
                        .user = (void *)(uintptr_t)scene}; /* only read */
}

/* ---- rows of a file to write ------------------------------------------------------------------------------------- */

/* Replaces infinite logarithms, of which readers make no use: opacities within 2^-20 of the ends, and scales of 0 as
 * the thinnest that are written. */
static void make_finite(scene_row *row)
{
    const double logit_most = 20 * M_LN2;
    row->opacity_logit = isfinite(row->opacity_logit) ? row->opacity_logit : copysign(logit_most, row->opacity_logit);
    const double largest = fmax(row->log_scale[0], fmax(row->log_scale[1], row->log_scale[2]));
    const double least = isfinite(largest) ? largest + log(GAUSSIAN_SHAPE_THINNEST) : log(GAUSSIAN_SHAPE_POINT);
    for (int i = 0; i < 3; i++) {
        row->log_scale[i] = isfinite(row->log_scale[i]) ? row->log_scale[i] : least;
    }
}

/* Makes a quaternion a unit one. One that is so within the rounding of floats stays as it is: otherwise each conversion
 * of a file would change its last digits. */
static void make_unit(double rotation[4])
{
    if (fabs(quaternion_norm(rotation) - 1) > UNIT_WITHIN) {
        quaternion_normalise(rotation);
    }
}

void scene_source_row(const scene_source *source, uint32_t index, scene_row *row)
{
    const scene_rows *rows = source->rows;
    (void)rows->read(rows->user, index, row, NULL, 0); /* checked when the scene's extent was measured */
    for (int i = 0; i < 3; i++) {
        row->position[i] += source->shift[i];
    }
    make_finite(row);
    make_unit(row->rotation);
    scene_turn_apply(&source->turn, row->position, row->rotation, rows->degree, row->rest);
}

double scene_row_opacity(const scene_row *row)
{
    return 1 / (1 + exp(-row->opacity_logit));
}

double scene_row_colour(const scene_row *row, int channel)
{
    return 0.5 + HARMONICS_ZERO * row->harmonic[channel];
}
