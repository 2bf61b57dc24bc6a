/* SPDX-License-Identifier: Apache-2.0 */
#include "splat_scenes.h"

const t3r_scene_frame scene_frame = {{0, 0, 0}, 0};

double *parameters_of(const splat_model *model, uint32_t gaussian)
{
    return &model->parameters[(size_t)gaussian * SPLAT_PARAMETERS];
}

void set_ball(const splat_model *model, uint32_t gaussian, double x, double y, double z, double sigma, double opacity)
{
    double *p = parameters_of(model, gaussian);
    const double ball[SPLAT_PARAMETERS] = {
        x, y, z, log(sigma), log(sigma), log(sigma), 1, 0, 0, 0, log(opacity / (1 - opacity)), 0.5, 0.5, 0.5};
    memcpy(p, ball, sizeof ball);
}

splat_model plain_model(uint32_t count)
{
    splat_model model = {count, count, calloc(count, SPLAT_PARAMETERS * sizeof(double))};
    assert_non_null(model.parameters);
    for (uint32_t i = 0; i < count; i++) {
        set_ball(&model, i, 0, 0, 1, 1e-3, 0.5);
    }
    return model;
}

splat_model random_model(dice *d, uint32_t count, double focal, uint32_t width, uint32_t height)
{
    splat_model model = plain_model(count);
    for (uint32_t i = 0; i < count; i++) {
        double *p = parameters_of(&model, i), z = 1 + (i + dice_between(d, 0, 0.5)) / count;
        p[0] = dice_between(d, -0.5, 0.5) * width * z / focal;
        p[1] = dice_between(d, -0.5, 0.5) * height * z / focal;
        p[2] = z;
        for (int k = 0; k < 3; k++) {
            p[SPLAT_LOG_SCALE + k] = log(dice_between(d, 0.5, 3) * z / focal);
            p[SPLAT_COLOUR + k] = dice_between(d, 0, 1);
        }
        for (int k = 0; k < 4; k++) {
            p[SPLAT_ROTATION + k] = dice_between(d, -1, 1);
        }
        p[SPLAT_LOGIT] = dice_between(d, -3, 2);
    }
    return model;
}

splat_camera middle_camera(double focal, uint32_t width, uint32_t height)
{
    t3r_camera camera = plain_camera(focal, width, height);
    return splat_camera_of(&camera, &scene_frame, width, height);
}

splat_view view_of(const splat_model *model, const splat_camera *camera, double alpha_least)
{
    splat_view view;
    assert_true(splat_view_open(&view, camera, model->count));
    view.alpha_least = alpha_least;
    assert_true(splat_view_project(&view, model));
    return view;
}
