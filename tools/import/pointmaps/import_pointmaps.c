/* SPDX-License-Identifier: Apache-2.0 */
#include "import/pointmaps/import_pointmaps.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "host/reason.h"
#include "import/frames/frame.h"
#include "messages/camera_crop.h"
#include "messages/fixed_camera.h"
#include "posing/opencv_module.h"

#define RESECTED 3000u       /* points that a pose is computed from */
#define RESECTION_PIXELS 5.0 /* largest error of a right point, for 512 pixels */
#define SAMPLED 20000u       /* depths per frame for the median */
#define MEDIAN_STEPS 8192.0
#define MOST_STEPS 65535.0
#define SAME_POSE 1e-3 /* equal poses differ at most so: rotation in radians, and relative position */

static int open_maps(const pointmap_source *source, uint32_t index, pointmaps *maps, char *error, size_t error_bytes)
{
    const posed_frame *frame = &source->folder->frames[index];
    char *path = posed_path(source->directory, frame->pointmap);
    char *confidence = frame->confidence != NULL ? posed_path(source->directory, frame->confidence) : NULL;
    *maps = (pointmaps){0};
    int status = path == NULL || (frame->confidence != NULL && confidence == NULL)
                     ? t3r_reason(error, error_bytes, "out of memory")
                     : pointmaps_open(path, confidence, maps, error, error_bytes);
    if (status == 0 && maps->count != 1) {
        status = t3r_reason(error, error_bytes, "%s: %u pointmaps, but it is one frame's", path, maps->count);
    }
    free(path);
    free(confidence);
    return status;
}

/* Returns the maps that hold frame `index`, with its view read, and which view it is; NULL when it has none. `own`
 * receives what must be freed. */
static int maps_of(pointmap_source *source, uint32_t index, pointmaps *own, pointmaps **maps, uint32_t *which,
                   char *error, size_t error_bytes)
{
    *own = (pointmaps){0};
    *maps = NULL;
    if (source->options.file == NULL && source->folder->frames[index].pointmap == NULL) {
        return 0;
    }
    *maps = source->options.file != NULL ? &source->stack : own;
    *which = source->options.file != NULL ? index : 0;
    if (*maps == own && open_maps(source, index, own, error, error_bytes) != 0) {
        return -1;
    }
    return pointmaps_read(*maps, *which, error, error_bytes);
}

/* ---- cameras ---------------------------------------------------------------------------------------------------- */

static void set_pose(posed_frame *frame, const rigid *pose)
{
    frame->posed = true;
    frame->upright = true; /* networks see the turned picture */
    frame->pose = *pose;
}

static int ascending(const void *a, const void *b)
{
    float p = *(const float *)a, q = *(const float *)b;
    return (p > q) - (p < q);
}

/* Returns the median confidence of a view's points. */
static double median_confidence(const float *confidence, size_t pixels)
{
    size_t stride = pixels / SAMPLED + 1, count = 0;
    float *some = malloc((pixels / stride + 1) * sizeof *some), median = 0;
    for (size_t i = 0; i < pixels && some != NULL; i += stride) {
        some[count++] = confidence[i];
    }
    if (count > 0) {
        qsort(some, count, sizeof *some, ascending);
        median = some[count / 2];
    }
    free(some);
    return median;
}

/* Makes the lens of a frame's picture in pixels of its map. */
static int map_lens(const pointmap_source *source, const posed_frame *frame, const pointmaps *maps,
                    t3r_recorded_camera *lens, char *error, size_t error_bytes)
{
    uint32_t width, height;
    char reason[256];
    if (import_picture_size(source->directory, frame, &width, &height, error, error_bytes) != 0) {
        return -1;
    }
    if (posed_frame_camera(frame, width, height, lens, reason, sizeof reason) != 0) {
        return t3r_reason(error, error_bytes, "%s: %s", frame->image, reason);
    }
    const t3r_crop whole = {.width = width, .height = height};
    t3r_crop_camera(lens, &whole, maps->width, maps->height);
    return 0;
}

/* Computes the pose from which the points lie on their pixels' rays; uses the more confident half, spread over the
 * view. */
static int resect_map(const pointmaps *maps, const t3r_recorded_camera *lens, double least, rigid *camera,
                      double *pixels_off, char *error, size_t error_bytes)
{
    const pose_module *module = pose_module_load(error, error_bytes);
    if (module == NULL) {
        return -1;
    }
    size_t pixels = (size_t)maps->width * maps->height, stride = pixels / (2 * (size_t)RESECTED) + 1, count = 0;
    const float *confidence = maps->confidence;
    double(*points)[3] = malloc((pixels / stride + 1) * sizeof *points);
    double(*rays)[2] = malloc((pixels / stride + 1) * sizeof *rays), off = 0;
    int status = points != NULL && rays != NULL ? 0 : t3r_reason(error, error_bytes, "out of memory");
    double enough = confidence != NULL ? fmax(least, median_confidence(confidence, pixels)) : 0;
    for (size_t i = stride / 2; i < pixels && status == 0; i += stride) {
        if (confidence == NULL || confidence[i] >= enough) {
            for (int c = 0; c < 3; c++) {
                points[count][c] = maps->points[3 * i + (size_t)c];
            }
            rays[count][0] = ((double)(i % maps->width) - lens->cx) / lens->fx;
            rays[count][1] = ((double)(i / maps->width) - lens->cy) / lens->fy;
            count++;
        }
    }
    if (status == 0) {
        const double band = RESECTION_PIXELS * fmax(maps->width, maps->height) / 512 / lens->fx;
        status = module->resect((const double(*)[3])points, (const double(*)[2])rays, (uint32_t)count, band, camera,
                                &off, error, error_bytes);
    }
    free(points);
    free(rays);
    *pixels_off = off * lens->fx;
    return status;
}

/* Returns the frame's own pose in the first camera's frame, before it is changed. */
static rigid in_first(const pointmap_source *source, uint32_t index)
{
    const rigid back = rigid_inverse(&source->first);
    return rigid_compose(&back, &source->folder->frames[index].pose);
}

/* Notes the first frame of each world, for messages. */
static void note_world(const char **world, const posed_frame *frame)
{
    *world = *world != NULL ? *world : frame->image;
}

/* Whether the folder gives the frame the same pose; the pose then does not distinguish the two worlds. */
static bool folder_agrees(const posed_frame *frame, const rigid *pose)
{
    if (!frame->posed) {
        return false;
    }
    const rigid *own = &frame->pose;
    double alike = 0, apart = 0, far = 0;
    for (int i = 0; i < 4; i++) {
        alike += own->rotation[i] * pose->rotation[i];
    }
    for (int i = 0; i < 3; i++) {
        apart = fmax(apart, fabs(own->position[i] - pose->position[i]));
        far = fmax(far, fmax(fabs(own->position[i]), fabs(pose->position[i])));
    }
    return 2 * acos(fmin(1, fabs(alike))) <= SAME_POSE && apart <= SAME_POSE * far;
}

static int place_camera(pointmap_source *source, posed_folder *folder, uint32_t index, const pointmaps *maps,
                        uint32_t which, char *error, size_t error_bytes)
{
    posed_frame *frame = &folder->frames[index];
    rigid *camera = &source->cameras[index];
    if (maps->intrinsics != NULL) {
        const double *k = maps->intrinsics[which];
        frame->intrinsics = posed_intrinsics_pinhole(k[0], k[1], k[2], k[3]);
        frame->intrinsics.grid_width = maps->width;
        frame->intrinsics.grid_height = maps->height;
    }
    if (maps->poses != NULL && !source->options.resect) {
        *camera = maps->poses[which];
        if (!folder_agrees(frame, camera)) {
            note_world(&source->in_points, frame);
        }
        set_pose(frame, camera);
        return 0;
    }
    if (frame->posed && source->first_posed && !source->options.resect) {
        *camera = in_first(source, index);
        note_world(&source->in_folder, frame);
        return 0;
    }
    if (frame->intrinsics.distortion != T3R_DISTORTION_NONE) {
        return t3r_reason(error, error_bytes, "%s: a pose cannot be taken from points through a lens with distortion",
                          frame->image);
    }
    double off = 0;
    t3r_recorded_camera lens;
    if (map_lens(source, frame, maps, &lens, error, error_bytes) != 0) {
        return -1;
    }
    char reason[512];
    if (resect_map(maps, &lens, source->options.confidence_least, camera, &off, reason, sizeof reason) != 0) {
        return t3r_reason(error, error_bytes, "%s: no pose, and %s", frame->image, reason);
    }
    source->worst_px = fmax(source->worst_px, off);
    const bool in_points = source->options.resect || !source->first_posed; /* the points' frame is the world */
    const rigid world = in_points ? *camera : rigid_compose(&source->first, camera);
    note_world(in_points ? &source->in_points : &source->in_folder, frame);
    set_pose(frame, &world);
    return 0;
}

/* ---- the unit --------------------------------------------------------------------------------------------------- */

typedef struct depths {
    float *some;
    size_t count, room;
} depths;

static int note_depths(depths *d, const float *depth, size_t pixels)
{
    size_t stride = pixels / SAMPLED + 1;
    if (d->room - d->count < pixels / stride + 1) {
        d->room = 2 * d->room + pixels / stride + 1;
        float *grown = realloc(d->some, d->room * sizeof *grown);
        if (grown == NULL) {
            return -1;
        }
        d->some = grown;
    }
    for (size_t i = 0; i < pixels; i += stride) {
        if (depth[i] > 0) {
            d->some[d->count++] = depth[i];
        }
    }
    return 0;
}

static int settle_unit(const pointmap_source *source, depths *d, posed_folder *folder, char *error, size_t error_bytes)
{
    if (d->count == 0) {
        return t3r_reason(error, error_bytes, "%s: no point of any pointmap is confident enough and before its camera",
                          source->directory);
    }
    double unit = source->options.depth_unit;
    for (uint32_t i = 0; i < folder->frame_count && unit != 0 && source->options.file == NULL; i++) {
        if (folder->frames[i].depth != NULL && unit != folder->depth_unit) {
            return t3r_reason(error, error_bytes, "%s: a depth_path whose steps are %g, so --depth-unit cannot be %g",
                              folder->frames[i].image, folder->depth_unit, unit);
        }
    }
    if (unit == 0 && folder->depth_unit_given) {
        unit = folder->depth_unit;
    }
    if (unit == 0) {
        qsort(d->some, d->count, sizeof *d->some, ascending);
        unit = exp2(ceil(log2(d->some[d->count / 2] / MEDIAN_STEPS)));
    }
    uint64_t fixed;
    if (!t3r_fixed_depth_unit(unit, &fixed)) {
        return t3r_reason(error, error_bytes,
                          "%s: the points' depths ask for a unit of %g, which is not within "
                          "1e-12 to 128; scale them",
                          source->directory, unit);
    }
    folder->depth_unit = unit;
    folder->depth_unit_given = true;
    return 0;
}

/* ---- all frames ------------------------------------------------------------------------------------------------- */

static int note_frame(pointmap_source *source, posed_folder *folder, uint32_t index, depths *d, char *error,
                      size_t error_bytes)
{
    pointmaps own, *maps;
    uint32_t which;
    int status = maps_of(source, index, &own, &maps, &which, error, error_bytes);
    if (status == 0 && maps != NULL) {
        size_t pixels = (size_t)maps->width * maps->height;
        float *depth = malloc(pixels * sizeof *depth);
        status = depth != NULL ? place_camera(source, folder, index, maps, which, error, error_bytes)
                               : t3r_reason(error, error_bytes, "out of memory");
        if (status == 0) {
            pointmaps_depth(maps, &source->cameras[index], source->options.confidence_least, depth);
            status = note_depths(d, depth, pixels) == 0 ? 0 : t3r_reason(error, error_bytes, "out of memory");
            source->count++;
        }
        free(depth);
    } else if (status == 0 && (source->options.resect || !folder->frames[index].posed)) {
        status = t3r_reason(error, error_bytes, "%s: no pointmap to estimate its pose from, as the others have",
                            folder->frames[index].image);
    } else if (status == 0) {
        note_world(&source->in_folder, &folder->frames[index]);
    }
    pointmaps_free(&own);
    return status;
}

int pointmap_source_open(pointmap_source *source, const char *directory, const pointmap_options *options,
                         posed_folder *folder, char *error, size_t error_bytes)
{
    *source = (pointmap_source){.options = *options, .directory = directory, .folder = folder};
    source->cameras = calloc(folder->frame_count, sizeof *source->cameras);
    if (source->cameras == NULL) {
        return t3r_reason(error, error_bytes, "out of memory");
    }
    if (options->file != NULL) {
        if (pointmaps_open(options->file, NULL, &source->stack, error, error_bytes) != 0) {
            return -1;
        }
        if (source->stack.count != folder->frame_count) {
            return t3r_reason(error, error_bytes, "%s: %u pointmaps, but %s has %u frames", options->file,
                              source->stack.count, directory, folder->frame_count);
        }
    }
    depths d = {0};
    int status = 0;
    source->first_posed = folder->frames[0].posed;
    source->first = folder->frames[0].pose;
    for (uint32_t i = 0; i < folder->frame_count && status == 0; i++) {
        status = note_frame(source, folder, i, &d, error, error_bytes);
    }
    if (status == 0 && source->in_folder != NULL && source->in_points != NULL) {
        status = t3r_reason(error, error_bytes,
                            "%s: its pose is the folder's, but that of %s is in its points' frame, another world",
                            source->in_folder, source->in_points);
    }
    if (status == 0 && source->count > 0) {
        status = settle_unit(source, &d, folder, error, error_bytes);
    }
    free(d.some);
    return status;
}

int pointmap_source_depth(pointmap_source *source, uint32_t index, picture *depth, char *error, size_t error_bytes)
{
    pointmaps own, *maps;
    uint32_t which;
    *depth = (picture){0};
    int status = maps_of(source, index, &own, &maps, &which, error, error_bytes);
    if (status == 0 && maps != NULL) {
        size_t pixels = (size_t)maps->width * maps->height;
        float *z = malloc(pixels * sizeof *z);
        uint16_t *steps = malloc(pixels * sizeof *steps);
        if (z == NULL || steps == NULL) {
            free(steps);
            status = t3r_reason(error, error_bytes, "out of memory");
        } else {
            pointmaps_depth(maps, &source->cameras[index], source->options.confidence_least, z);
            for (size_t i = 0; i < pixels; i++) {
                double step = floor(z[i] / source->folder->depth_unit + 0.5);
                steps[i] = step >= 1 && step <= MOST_STEPS ? (uint16_t)step : 0;
            }
            *depth =
                (picture){.width = maps->width, .height = maps->height, .channels = 1, .bits = 16, .samples = steps};
        }
        free(z);
        pointmaps_forget(maps); /* frees memory for the frame's pictures */
    }
    pointmaps_free(&own);
    return status;
}

void pointmap_source_close(pointmap_source *source)
{
    pointmaps_free(&source->stack);
    free(source->cameras);
    *source = (pointmap_source){0};
}
