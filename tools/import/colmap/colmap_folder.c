/* SPDX-License-Identifier: Apache-2.0 */
#include "import/colmap/colmap_folder.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "host/file_bytes.h"
#include "host/reason.h"
#include "import/colmap/colmap_depth.h"
#include "import/colmap/colmap_model.h"
#include "import/frames/picture_folder.h"
#include "import/frames/rejected.h"

#define PATH_BYTES 8192
#define MODELS_MOST 100u /* numbered folders of models */

typedef struct model_files {
    const char *cameras, *images;
    int (*read_cameras)(FILE *file, colmap_model *model, char *error, size_t error_bytes);
    int (*read_images)(FILE *file, colmap_model *model, char *error, size_t error_bytes);
} model_files;

/* in COLMAP's order of preference */
static const model_files forms[] = {
    {"cameras.bin", "images.bin", colmap_read_cameras_binary, colmap_read_images_binary},
    {"cameras.txt", "images.txt", colmap_read_cameras_text, colmap_read_images_text},
};
#define FORMS (sizeof forms / sizeof *forms)

/* Folders with models: those of COLMAP, 3DGS and nerfstudio, or the folder itself. */
static const char *const model_places[] = {"sparse", "colmap/sparse", "."};
/* Folders with pictures; the last ones are for a model in the folder itself. */
static const char *const picture_places[] = {"images", "input", "rgb", "color", ".", "../images", "../../images"};
static const char *const depth_places[] = {"depth", "depths"};
static const char *const depth_endings[] = {".png", ".exr"};

/* Joins FOLDER/NAME; "", which is no path, if it is too long. */
static void join(char path[PATH_BYTES], const char *folder, const char *name)
{
    int length = snprintf(path, PATH_BYTES, "%s/%s", folder, name);
    path[length < 0 || length >= PATH_BYTES ? 0 : length] = '\0';
    path[0] = length >= PATH_BYTES ? '\0' : path[0];
}

/* Returns the form of the model in DIR/PLACE; NULL: none. */
static const model_files *form_of(const char *directory, const char *place)
{
    for (size_t i = 0; i < FORMS; i++) {
        char cameras[PATH_BYTES], images[PATH_BYTES];
        join(cameras, place, forms[i].cameras);
        join(images, place, forms[i].images);
        if (posed_exists(directory, cameras) && posed_exists(directory, images)) {
            return &forms[i];
        }
    }
    return NULL;
}

/* Finds the folder's first model, numbered ones first, and its `place`. NULL: none. */
static const model_files *find_model(const char *directory, char place[PATH_BYTES])
{
    const model_files *form = NULL;
    for (size_t i = 0; i < sizeof model_places / sizeof *model_places && form == NULL; i++) {
        join(place, model_places[i], "0");
        form = form_of(directory, place);
        if (form == NULL) {
            snprintf(place, PATH_BYTES, "%s", model_places[i]);
            form = form_of(directory, place);
        }
    }
    return form;
}

bool colmap_folder_is(const char *directory)
{
    char place[PATH_BYTES];
    return find_model(directory, place) != NULL;
}

/* Remarks on other models in the same place, which COLMAP could not join to the one that is read. */
static void tell_others(const char *directory, const char *place, posed_folder *out)
{
    const char *slash = strrchr(place, '/');
    if (slash == NULL || strcmp(slash, "/0") != 0) {
        return;
    }
    for (uint32_t i = 1; i < MODELS_MOST; i++) {
        char other[PATH_BYTES];
        snprintf(other, sizeof other, "%.*s/%u", (int)(slash - place), place, i);
        if (form_of(directory, other) != NULL) {
            (void)text_list_add(&out->remarks, "%s is another model, which is not read; import %s/%s reads it", other,
                                directory, other);
        }
    }
}

static int read_list(const char *directory, const char *place, const char *name,
                     int (*read)(FILE *file, colmap_model *model, char *error, size_t error_bytes), colmap_model *model,
                     char *error, size_t error_bytes)
{
    char in_folder[PATH_BYTES], reason[512];
    join(in_folder, place, name);
    char *path = posed_path(directory, in_folder);
    if (path == NULL) {
        return t3r_reason(error, error_bytes, "out of memory");
    }
    FILE *file = t3r_file_open(path, error, error_bytes);
    int status = file == NULL ? -1 : 0;
    if (file != NULL) {
        if (read(file, model, reason, sizeof reason) != 0) {
            status = t3r_reason(error, error_bytes, "%s: %s", path, reason);
        }
        fclose(file);
    }
    free(path);
    return status;
}

/* Returns the first of the places that has the picture; NULL: none. */
static const char *place_of(const char *directory, const char *const *places, size_t count, const char *name)
{
    for (size_t i = 0; i < count; i++) {
        char path[PATH_BYTES];
        join(path, places[i], name);
        if (path[0] != '\0' && posed_exists(directory, path)) {
            return places[i];
        }
    }
    return NULL;
}

/* Makes the name of a picture's depth: the same name with another suffix. */
static void depth_name(const char *image, const char *depth_ending, char name[PATH_BYTES])
{
    const char *slash = strrchr(image, '/'), *dot = strrchr(image, '.');
    bool ending = dot != NULL && (slash == NULL || dot > slash);
    snprintf(name, PATH_BYTES, "%.*s%s", (int)(ending ? (size_t)(dot - image) : strlen(image)), image, depth_ending);
}

static int add_depth(const char *directory, const posed_folder_options *options, const char *image, posed_frame *frame,
                     char *error, size_t error_bytes)
{
    char name[PATH_BYTES], path[PATH_BYTES];
    const char *place = NULL;
    for (size_t i = 0; i < sizeof depth_endings / sizeof *depth_endings && place == NULL; i++) {
        depth_name(image, depth_endings[i], name);
        place = place_of(directory, depth_places, sizeof depth_places / sizeof *depth_places, name);
    }
    if (place == NULL) {
        return colmap_depth_find(directory, image, frame) == 0 ? 0 : t3r_reason(error, error_bytes, "out of memory");
    }
    if (options == NULL || options->depth_unit == 0) {
        return t3r_reason(error, error_bytes,
                          "%s/%s/%s: depth, but nothing says how long its steps are; give --depth-unit", directory,
                          place, name);
    }
    join(path, place, name);
    frame->depth = strdup(path);
    return frame->depth != NULL ? 0 : t3r_reason(error, error_bytes, "out of memory");
}

static int add_frames(const char *directory, const posed_folder_options *options, const colmap_model *model,
                      posed_folder *out, char *error, size_t error_bytes)
{
    const char *place =
        place_of(directory, picture_places, sizeof picture_places / sizeof *picture_places, model->images[0].name);
    place = place != NULL ? place : picture_places[0]; /* pictures are then reported as missing when they are read */
    out->frames = calloc(model->image_count, sizeof *out->frames);
    if (out->frames == NULL) {
        return t3r_reason(error, error_bytes, "out of memory");
    }
    for (uint32_t i = 0; i < model->image_count; i++) {
        const colmap_image *image = &model->images[i];
        const colmap_camera *camera = colmap_model_camera(model, image->camera);
        posed_frame *frame = &out->frames[out->frame_count++];
        char path[PATH_BYTES];
        if (camera == NULL || camera->wrong != NULL) {
            rejected_mark(frame, "%s: camera %u: %s", image->name, image->camera,
                          camera == NULL ? "it is not among the cameras" : camera->wrong);
        } else if (image->wrong != NULL) {
            rejected_mark(frame, "%s: its pose: %s", image->name, image->wrong);
        }
        if (image->name[0] == '/') {
            snprintf(path, sizeof path, "%s", image->name);
        } else {
            join(path, place, image->name);
        }
        frame->image = strdup(path);
        frame->posed = true;
        frame->as_stored = true; /* COLMAP does not turn pictures by EXIF */
        frame->intrinsics = camera != NULL ? camera->intrinsics : (posed_intrinsics){0};
        frame->pose = image->pose;
        if (frame->image == NULL) {
            return t3r_reason(error, error_bytes, "out of memory");
        }
        if (add_depth(directory, options, image->name, frame, error, error_bytes) != 0) {
            return -1;
        }
    }
    return picture_folder_rest(directory, place, "the model has no pose of it", out, error, error_bytes);
}

int colmap_folder_read(const char *directory, const posed_folder_options *options, posed_folder *out, char *error,
                       size_t error_bytes)
{
    char place[PATH_BYTES];
    colmap_model model = {0};
    const model_files *form = find_model(directory, place);
    if (options != NULL && options->intrinsics != NULL) {
        return t3r_reason(error, error_bytes,
                          "%s/%s: the model has its own intrinsics; --intrinsics is for folders without", directory,
                          place);
    }
    out->depth_unit_given = options != NULL && options->depth_unit != 0;
    out->depth_unit = out->depth_unit_given ? options->depth_unit : 0.001;
    int status = read_list(directory, place, form->cameras, form->read_cameras, &model, error, error_bytes);
    if (status == 0) {
        status = read_list(directory, place, form->images, form->read_images, &model, error, error_bytes);
    }
    if (status == 0) {
        const char *wrong = colmap_model_sort(&model);
        status = wrong == NULL ? add_frames(directory, options, &model, out, error, error_bytes)
                               : t3r_reason(error, error_bytes, "%s/%s: %s", directory, place, wrong);
    }
    if (status == 0) {
        tell_others(directory, place, out);
        colmap_depth_set_unit(directory, out);
        (void)colmap_depth_tell(directory, out);
        (void)text_list_add(&out->remarks, "lengths are in the model's own unit: COLMAP cannot know metres");
    }
    colmap_model_free(&model);
    return status;
}
