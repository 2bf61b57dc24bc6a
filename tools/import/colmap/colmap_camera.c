/* SPDX-License-Identifier: Apache-2.0 */
#include "import/colmap/colmap_camera.h"

#include <math.h>
#include <string.h>

/* Index of a coefficient in posed_intrinsics.coefficients. */
typedef enum coefficient {
    K1 = 0,
    K2 = 1,
    P1 = 2, /* for radial-tangential lenses */
    P2 = 3,
    K3 = 4,
    FISH_K3 = 2, /* for fisheye lenses */
    FISH_K4 = 3,
    K4 = 5,
    K5 = 6,
    K6 = 7
} coefficient;

struct colmap_camera_model {
    int32_t id;
    const char *name;
    uint32_t parameters;
    uint32_t focals;  /* 1: fx is also fy; cx, cy and the coefficients follow */
    const char *lens; /* NULL: the runtime has it; else its name for messages */
    t3r_distortion distortion;
    coefficient coefficients[8];
};

#define NO_COUNTERPART(name) "the camera model " name " is not supported; colmap image_undistorter makes PINHOLE of it"

/* In the order of COLMAP's documentation. */
static const colmap_camera_model models[] = {
    {0, "SIMPLE_PINHOLE", 3, 1, NULL, T3R_DISTORTION_NONE, {0}},
    {1, "PINHOLE", 4, 2, NULL, T3R_DISTORTION_NONE, {0}},
    {2, "SIMPLE_RADIAL", 4, 1, NULL, T3R_DISTORTION_RADTAN, {K1}},
    {3, "RADIAL", 5, 1, NULL, T3R_DISTORTION_RADTAN, {K1, K2}},
    {4, "OPENCV", 8, 2, NULL, T3R_DISTORTION_RADTAN, {K1, K2, P1, P2}},
    {5, "OPENCV_FISHEYE", 8, 2, NULL, T3R_DISTORTION_FISHEYE, {K1, K2, FISH_K3, FISH_K4}},
    {6, "FULL_OPENCV", 12, 2, NULL, T3R_DISTORTION_RADTAN, {K1, K2, P1, P2, K3, K4, K5, K6}},
    {7, "FOV", 5, 2, NO_COUNTERPART("FOV"), T3R_DISTORTION_NONE, {0}},
    {8, "SIMPLE_RADIAL_FISHEYE", 4, 1, NULL, T3R_DISTORTION_FISHEYE, {K1}},
    {9, "RADIAL_FISHEYE", 5, 1, NULL, T3R_DISTORTION_FISHEYE, {K1, K2}},
    {10, "THIN_PRISM_FISHEYE", 12, 2, NO_COUNTERPART("THIN_PRISM_FISHEYE"), T3R_DISTORTION_NONE, {0}},
    {11, "RAD_TAN_THIN_PRISM_FISHEYE", 16, 2, NO_COUNTERPART("RAD_TAN_THIN_PRISM_FISHEYE"), T3R_DISTORTION_NONE, {0}},
};
#define MODELS (sizeof models / sizeof *models)

const colmap_camera_model *colmap_model_of_id(int32_t id)
{
    return id >= 0 && (size_t)id < MODELS ? &models[id] : NULL;
}

const colmap_camera_model *colmap_model_of_name(const char *name)
{
    for (size_t i = 0; i < MODELS; i++) {
        if (strcmp(models[i].name, name) == 0) {
            return &models[i];
        }
    }
    return NULL;
}

uint32_t colmap_model_parameters(const colmap_camera_model *model)
{
    return model->parameters;
}

const char *colmap_intrinsics(const colmap_camera_model *model, const double *parameters, uint64_t width,
                              uint64_t height, posed_intrinsics *out)
{
    if (model->lens != NULL) {
        return model->lens;
    }
    for (uint32_t i = 0; i < model->parameters; i++) {
        if (!isfinite(parameters[i])) {
            return "a parameter is not a finite number";
        }
    }
    if (width == 0 || height == 0 || width > PICTURE_LARGEST_SIDE || height > PICTURE_LARGEST_SIDE) {
        return "a side is not 1 to 16384 pixels";
    }
    const double *centre = parameters + model->focals;
    *out = (posed_intrinsics){.width = (double)width,
                              .height = (double)height,
                              .fx = parameters[0],
                              .fy = parameters[model->focals - 1],
                              .cx = centre[0],
                              .cy = centre[1],
                              .angle_x = NAN,
                              .angle_y = NAN};
    if (!(out->fx > 0 && out->fy > 0)) {
        return "a focal length is not positive";
    }
    bool any = model->distortion == T3R_DISTORTION_FISHEYE; /* fisheye lenses bend rays even without coefficients */
    for (uint32_t i = 0; i < model->parameters - model->focals - 2; i++) {
        double value = centre[2 + i];
        any = any || value != 0;
        out->coefficients[model->coefficients[i]] = value;
    }
    out->distortion = any ? model->distortion : T3R_DISTORTION_NONE;
    return NULL;
}
