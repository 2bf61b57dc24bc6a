/* A sparse model of COLMAP: its cameras and the poses of its images. Points are passed over. */
#ifndef TRIM3R_TOOLS_COLMAP_MODEL_H
#define TRIM3R_TOOLS_COLMAP_MODEL_H

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include "import/folders/posed_frame.h"

#define COLMAP_NAME_BYTES 4097u /* of a picture's path, its end among them */

typedef struct colmap_camera {
    uint32_t id;
    posed_intrinsics intrinsics;
    const char *wrong; /* why frames cannot have it; NULL = they can */
} colmap_camera;

typedef struct colmap_image {
    char *name; /* path in the folder of pictures */
    uint32_t camera;
    rigid pose; /* camera to world */
} colmap_image;

/* Starts with zeros. */
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
/* Once all are added: sorts the cameras by their numbers, and the images by their names, numbers in them by value.
 * NULL, or what is wrong: a camera that is there twice. */
const char *colmap_model_sort(colmap_model *model);
/* NULL: there is none. After colmap_model_sort(). */
const colmap_camera *colmap_model_camera(const colmap_model *model, uint32_t id);

/* cameras.txt, images.txt and their binary kin from files that are open, of any length: nothing is held but what the
 * model keeps. 0, or -1 with "line N: what" or "camera N: what" in error[]. */
int colmap_read_cameras_text(FILE *file, colmap_model *model, char *error, size_t error_bytes);
int colmap_read_images_text(FILE *file, colmap_model *model, char *error, size_t error_bytes);
int colmap_read_cameras_binary(FILE *file, colmap_model *model, char *error, size_t error_bytes);
int colmap_read_images_binary(FILE *file, colmap_model *model, char *error, size_t error_bytes);

#endif
