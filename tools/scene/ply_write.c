/* 3DGS .ply, binary little-endian, harmonics of degree 0 and therefore no f_rest: readers take their number from
 * the header. */
#include "scene/ply.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "scene/gaussian_shape.h"
#include "scene/scene_rows.h"

static const char *const properties[] = {"x",       "y",      "z",      "nx",      "ny",      "nz",
                                         "f_dc_0",  "f_dc_1", "f_dc_2", "opacity", "scale_0", "scale_1",
                                         "scale_2", "rot_0",  "rot_1",  "rot_2",   "rot_3"};
enum { PROPERTY_COUNT = sizeof properties / sizeof properties[0] };

static void put_float(uint8_t *bytes, double value)
{
    float narrow = (float)value;
    uint32_t bits;
    memcpy(&bits, &narrow, sizeof bits);
    for (int i = 0; i < 4; i++) {
        bytes[i] = (uint8_t)(bits >> (8 * i));
    }
}

/* Opacities of 0 would have no logit: they are written as an eighth of a step, which reads as 0 again. */
static double opacity_logit(uint16_t opacity_q15)
{
    double opacity = opacity_q15 == 0 ? 0.125 / 32768 : opacity_q15 / 32768.0;
    return log(opacity / (1 - opacity));
}

static void put_gaussian(uint8_t row[4 * PROPERTY_COUNT], const t3r_gaussian *g, const t3r_scene_frame *frame,
                         int local)
{
    double value[PROPERTY_COUNT] = {0};
    gaussian_shape shape = gaussian_shape_of(g);
    for (int i = 0; i < 3; i++) {
        double origin = local ? 0 : ldexp((double)frame->origin_q32[i], -32);
        value[i] = origin + ldexp(g->position_q20[i], frame->exponent - 20);
        value[6 + i] = (g->colour_q7[i] / 32640.0 - 0.5) / SCENE_HARMONIC_0;
        value[10 + i] = log(shape.scale[i]) + frame->exponent * M_LN2;
    }
    value[9] = opacity_logit(g->opacity_q15);
    for (int i = 0; i < 4; i++) {
        value[13 + i] = shape.rotation[i];
    }
    for (int i = 0; i < PROPERTY_COUNT; i++) {
        put_float(row + 4 * i, value[i]);
    }
}

static void write_header(FILE *file, const t3r_scene *scene, int flags, const char *note)
{
    fputs("ply\nformat binary_little_endian 1.0\n", file);
    if (flags & SCENE_FILE_COMMENTS) {
        fprintf(file, "comment trim3r bits_epoch %d\n", T3R_BITS_EPOCH);
        fprintf(file, "comment trim3r exponent %" PRId32 "\n", scene->frame.exponent);
        fprintf(file, "comment trim3r origin_q32 %" PRId64 " %" PRId64 " %" PRId64 "\n", scene->frame.origin_q32[0],
                scene->frame.origin_q32[1], scene->frame.origin_q32[2]);
        fprintf(file, "comment trim3r local %d\n", (flags & SCENE_FILE_LOCAL) != 0);
        if (note != NULL) {
            fprintf(file, "comment trim3r %s\n", note);
        }
    }
    fprintf(file, "element vertex %" PRIu32 "\n", scene->count);
    for (int i = 0; i < PROPERTY_COUNT; i++) {
        fprintf(file, "property float %s\n", properties[i]);
    }
    fputs("end_header\n", file);
}

void ply_write(FILE *file, const t3r_scene *scene, int flags, const char *note)
{
    write_header(file, scene, flags, note);
    for (uint32_t i = 0; i < scene->count; i++) {
        uint8_t row[4 * PROPERTY_COUNT];
        put_gaussian(row, &scene->gaussians[i], &scene->frame, flags & SCENE_FILE_LOCAL);
        fwrite(row, 1, sizeof row, file);
    }
}
