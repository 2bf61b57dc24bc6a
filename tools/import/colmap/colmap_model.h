/* SPDX-License-Identifier: Apache-2.0 */
/* A sparse model of COLMAP: its cameras and the poses of its images. Points are skipped. */
#ifndef TRIM3R_TOOLS_COLMAP_MODEL_H
#define TRIM3R_TOOLS_COLMAP_MODEL_H

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include "import/frames/posed_frame.h"

#define COLMAP_NAME_BYTES 4097u /* a picture's path with its terminating zero */

typedef struct colmap_camera {
    uint32_t id;
    posed_intrinsics intrinsics;
    const char *wrong; /* why frames cannot use it; NULL = they can */
} colmap_camera;

typedef struct colmap_image {
    char *name; /* path in the folder of pictures */
    uint32_t camera;
    rigid pose;        /* camera to world */
    const char *wrong; /* why the pose cannot be used; NULL = it can */
} colmap_image;

/* Initialise with zeros. */
typedef struct colmap_model {
    colmap_camera *cameras;
    uint32_t camera_count;
    colmap_image *images;
    uint32_t image_count;
} colmap_model;

void colmap_model_free(colmap_model *model);

/* Adds what a reader found. NULL, or what is wrong. An image's pose is world to camera. */
const char *colmap_model_add_camera(colmap_model *model, const colmap_camera *camera);
const char *colmap_model_add_image(colmap_model *model, const char *name, uint32_t camera, rigid from_world);
/* Sorts the cameras by number, and the images by name, with numbers in names by value; call when all are added. Returns
 * NULL, or what is wrong: a camera that occurs twice. */
const char *colmap_model_sort(colmap_model *model);
/* Finds a camera after colmap_model_sort(). NULL: there is none. */
const colmap_camera *colmap_model_camera(const colmap_model *model, uint32_t id);

/* Read cameras.txt, images.txt or their binary forms from open files of any length; only what the model keeps is held.
 * Return 0, or -1 with "line N: what" or "camera N: what" in error[]. */
int colmap_read_cameras_text(FILE *file, colmap_model *model, char *error, size_t error_bytes);
int colmap_read_images_text(FILE *file, colmap_model *model, char *error, size_t error_bytes);
int colmap_read_cameras_binary(FILE *file, colmap_model *model, char *error, size_t error_bytes);
int colmap_read_images_binary(FILE *file, colmap_model *model, char *error, size_t error_bytes);

#endif
