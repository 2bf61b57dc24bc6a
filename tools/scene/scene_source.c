/* Converts the runtime's fixed point to the numbers of scene files. */
#include <math.h>

#include "scene/gaussian_shape.h"
#include "scene/scene_rows.h"

/* Returns the logit of an opacity. 0 has no logit, so it is written as an eighth of a step, which reads as 0 again. */
static double opacity_logit(uint16_t opacity_q15)
{
    double opacity = opacity_q15 == 0 ? 0.125 / 32768 : opacity_q15 / 32768.0;
    return log(opacity / (1 - opacity));
}

static void put_harmonics(const scene_source *source, uint32_t index, scene_row *row)
{
    const scene_file *scene = source->scene;
    const int16_t *harmonics_q12 = scene_file_harmonics(scene, index);
    for (uint32_t i = 0; i < 3 * (harmonics_rest(scene->degree) + 1); i++) {
        *(i < 3 ? &row->harmonic[i] : &row->rest[i / 3 - 1][i % 3]) = ldexp(harmonics_q12[i], -12);
    }
}

/* Writes the position before the turn. */
static void put_position(const scene_source *source, uint32_t index, double position[3])
{
    const t3r_scene_frame *frame = &source->scene->frame;
    for (int i = 0; i < 3; i++) {
        double origin = (source->flags & SCENE_FILE_LOCAL) != 0 ? 0 : ldexp((double)frame->origin_q32[i], -32);
        position[i] = origin + ldexp(source->scene->gaussians[index].position_q20[i], frame->exponent - 20);
    }
}

void scene_source_position(const scene_source *source, uint32_t index, double position[3])
{
    double rotation[4] = {1, 0, 0, 0}, none[HARMONICS_REST_MOST][3];
    put_position(source, index, position);
    scene_turn_apply(&source->turn, position, rotation, 0, none);
}

void scene_source_row(const scene_source *source, uint32_t index, scene_row *row)
{
    const t3r_scene_frame *frame = &source->scene->frame;
    const t3r_gaussian *g = &source->scene->gaussians[index];
    gaussian_shape shape = gaussian_shape_of(g);
    *row = (scene_row){.opacity_logit = opacity_logit(g->opacity_q15)};
    put_position(source, index, row->position);
    for (int i = 0; i < 3; i++) {
        row->harmonic[i] = (g->colour_q7[i] / 32640.0 - 0.5) / HARMONICS_ZERO;
        row->log_scale[i] = log(shape.scale[i]) + frame->exponent * M_LN2;
    }
    for (int i = 0; i < 4; i++) {
        row->rotation[i] = shape.rotation[i];
    }
    if (source->scene->degree > 0) {
        put_harmonics(source, index, row);
    }
    scene_turn_apply(&source->turn, row->position, row->rotation, source->scene->degree, row->rest);
}

double scene_row_opacity(const scene_row *row)
{
    return 1 / (1 + exp(-row->opacity_logit));
}

double scene_row_colour(const scene_row *row, int channel)
{
    return 0.5 + HARMONICS_ZERO * row->harmonic[channel];
}
