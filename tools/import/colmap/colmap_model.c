/* SPDX-License-Identifier: Apache-2.0 */
#define _GNU_SOURCE /* strverscmp() */
#include "import/colmap/colmap_model.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "geometry/pose_check.h"
#include "geometry/quaternion.h"
#include "mcap/reader_limits.h"

void colmap_model_free(colmap_model *model)
{
    for (uint32_t i = 0; i < model->image_count; i++) {
        free(model->images[i].name);
    }
    free(model->images);
    free(model->cameras);
    *model = (colmap_model){0};
}

/* Makes room for one more; lists double at powers of two. NULL: out of memory. */
static void *grown(void *list, uint32_t count, size_t each)
{
    return (count & (count - 1)) == 0 ? realloc(list, (count == 0 ? 1 : (size_t)count * 2) * each) : list;
}

const char *colmap_model_add_camera(colmap_model *model, const colmap_camera *camera)
{
    if (model->camera_count == T3R_LIMIT_FRAMES) {
        return T3R_LIMIT_TEXT("more than ", T3R_LIMIT_FRAMES, " cameras");
    }
    colmap_camera *list = grown(model->cameras, model->camera_count, sizeof *list);
    if (list == NULL) {
        return "out of memory";
    }
    model->cameras = list;
    model->cameras[model->camera_count++] = *camera;
    return NULL;
}

const char *colmap_model_add_image(colmap_model *model, const char *name, uint32_t camera, rigid from_world)
{
    colmap_image image = {.camera = camera};
    if (model->image_count == T3R_LIMIT_FRAMES) {
        return T3R_LIMIT_TEXT("more than ", T3R_LIMIT_FRAMES, " images");
    }
    if (name[0] == '\0') {
        return "no name";
    }
    image.wrong = pose_check(&from_world);
    quaternion_normalise(from_world.rotation);
    image.pose = rigid_inverse(&from_world);
    image.wrong = image.wrong != NULL ? image.wrong : pose_check_position(image.pose.position);
    colmap_image *list = grown(model->images, model->image_count, sizeof *list);
    if (list != NULL) {
        model->images = list;
        image.name = strdup(name);
    }
    if (image.name == NULL) {
        return "out of memory";
    }
    model->images[model->image_count++] = image;
    return NULL;
}

static int by_id(const void *a, const void *b)
{
    uint32_t x = ((const colmap_camera *)a)->id, y = ((const colmap_camera *)b)->id;
    return (x > y) - (x < y);
}

static int by_name(const void *a, const void *b)
{
    return strverscmp(((const colmap_image *)a)->name, ((const colmap_image *)b)->name);
}

const char *colmap_model_sort(colmap_model *model)
{
    if (model->camera_count == 0 || model->image_count == 0) {
        return model->camera_count == 0 ? "no camera" : "no image";
    }
    qsort(model->cameras, model->camera_count, sizeof *model->cameras, by_id);
    qsort(model->images, model->image_count, sizeof *model->images, by_name);
    for (uint32_t i = 1; i < model->camera_count; i++) {
        if (model->cameras[i].id == model->cameras[i - 1].id) {
            return "a camera is there twice";
        }
    }
    return NULL;
}

const colmap_camera *colmap_model_camera(const colmap_model *model, uint32_t id)
{
    const colmap_camera wanted = {.id = id};
    return bsearch(&wanted, model->cameras, model->camera_count, sizeof wanted, by_id);
}
