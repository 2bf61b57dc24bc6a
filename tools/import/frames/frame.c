/* SPDX-License-Identifier: Apache-2.0 */
#include "import/frames/frame.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "core/camera.h"
#include "host/reason.h"
#include "image/image.h"
#include "image/undistort.h"
#include "import/depth/exr_depth.h"
#include "import/frames/align_depth.h"
#include "import/frames/crop.h"
#include "import/frames/straighten.h"
#include "mcap/reader_limits.h"
#include "messages/camera_crop.h"
#include "messages/fixed_camera.h"
#include "pictures/exif.h"
#include "pictures/picture.h"
#include "pictures/picture_shape.h"

_Static_assert(T3R_MAX_POSITION_Q32 == INT64_C(1) << (T3R_LIMIT_POSITION_LOG2 + 32) &&
                   T3R_MAX_TANGENTIAL_Q24 == T3R_LIMIT_TANGENTIAL << 24 &&
                   T3R_MAX_DEPTH_UNIT_Q40 == ((uint64_t)T3R_LIMIT_DEPTH_UNIT << 40) - 1,
               "readers and runtime have the same limits");

/* ---- pictures -------------------------------------------------------------------------------------------------- */

/* Returns the picture's path; synthetic NeRF scenes omit the suffix. */
static char *find_picture(const char *directory, const char *name)
{
    static const char *const endings[] = {".png", ".jpg", ".jpeg"};
    char *path = posed_path(directory, name);
    const char *base = path == NULL ? NULL : strrchr(path, '/');
    if (path == NULL || access(path, F_OK) == 0 || strchr(base != NULL ? base : path, '.') != NULL) {
        return path;
    }
    size_t bytes = strlen(path) + 8;
    char *longer = malloc(bytes);
    for (size_t i = 0; longer != NULL && i < sizeof endings / sizeof *endings; i++) {
        snprintf(longer, bytes, "%s%s", path, endings[i]);
        if (access(longer, F_OK) == 0) {
            free(path);
            return longer;
        }
    }
    free(longer);
    return path;
}

/* Finds whether a picture is to be turned upright as EXIF states: not if its camera sees the stored pixels. Its sides
 * decide if they can; the orientation of a picture whose pose is given may have been obeyed or not where that was
 * made. */
static int find_turn(const posed_frame *frame, const picture *p, bool *turn, char *error, size_t error_bytes)
{
    const posed_intrinsics *in = &frame->intrinsics;
    const bool swaps = p->orientation >= EXIF_SWAPS_FROM, grid = in->grid_width > 0;
    const double width = grid ? in->grid_width : in->width, height = grid ? in->grid_height : in->height;
    const bool stored = posed_same_aspect(width, height, p->width, p->height);
    const bool turned = swaps ? posed_same_aspect(width, height, p->height, p->width) : stored;
    *turn = p->orientation > EXIF_UPRIGHT && !frame->as_stored && (turned || !stored);
    return !*turn || !frame->posed || frame->upright || stored != turned
               ? 0
               : t3r_reason(
                     error, error_bytes,
                     "%s: EXIF turns the picture (orientation %u), and nothing says whether its pose is that of "
                     "the turned one; mogrify -auto-orient turns the pixels, exiftool -Orientation= drops the mark",
                     frame->image, p->orientation);
}

int import_picture_facts(const char *directory, const posed_frame *frame, uint32_t *width, uint32_t *height,
                         double *focal_35mm, char *error, size_t error_bytes)
{
    picture header = {0};
    bool turn = false;
    char *path = find_picture(directory, frame->image);
    const int status = path == NULL ? t3r_reason(error, error_bytes, "out of memory")
                       : picture_header(path, &header, error, error_bytes) != 0
                           ? -1
                           : find_turn(frame, &header, &turn, error, error_bytes);
    const bool swap = turn && header.orientation >= EXIF_SWAPS_FROM;
    *width = swap ? header.height : header.width;
    *height = swap ? header.width : header.height;
    *focal_35mm = header.focal_35mm;
    free(path);
    return status;
}

int import_picture_size(const char *directory, const posed_frame *frame, uint32_t *width, uint32_t *height, char *error,
                        size_t error_bytes)
{
    double focal_35mm;
    return import_picture_facts(directory, frame, width, height, &focal_35mm, error, error_bytes);
}

int import_depth_size(const char *directory, const posed_frame *frame, uint32_t *width, uint32_t *height, char *error,
                      size_t error_bytes)
{
    char *path = find_picture(directory, frame->depth);
    const bool raw = frame->depth_raw.kind == RAW_DEPTH_PLAIN || frame->depth_raw.kind == RAW_DEPTH_COLMAP;
    picture numbers = {0};
    const int status = path == NULL         ? t3r_reason(error, error_bytes, "out of memory")
                       : raw                ? raw_depth_read(path, &frame->depth_raw, &numbers, error, error_bytes)
                       : exr_depth_is(path) ? exr_depth_size(path, width, height, error, error_bytes)
                                            : picture_size(path, width, height, error, error_bytes);
    if (raw) { /* their sides are no header, or one that only the whole file confirms */
        *width = numbers.width;
        *height = numbers.height;
    }
    picture_free(&numbers);
    free(path);
    return status;
}

static int read_colour(const char *path, picture *out, char *error, size_t error_bytes)
{
    if (picture_read_large(path, out, error, error_bytes) != 0) {
        return -1;
    }
    if (out->bits != 8) {
        return t3r_reason(error, error_bytes, "%s: 16-bit grey, but a colour picture has 8 bits", path);
    }
    if (out->width < IMPORT_LEAST_SIDE || out->height < IMPORT_LEAST_SIDE) {
        return t3r_reason(error, error_bytes, "%s: %ux%u pixels are too few", path, out->width, out->height);
    }
    return 0;
}

static int read_depth(const char *path, const raw_depth *raw, picture *out, char *error, size_t error_bytes)
{
    if ((raw->kind == RAW_DEPTH_EXR    ? exr_depth_read(path, raw->unit, out, error, error_bytes)
         : raw->kind != RAW_DEPTH_NONE ? raw_depth_read(path, raw, out, error, error_bytes)
                                       : picture_read(path, out, error, error_bytes)) != 0) {
        return -1;
    }
    if (out->bits != 16 || out->channels != 1) {
        return t3r_reason(error, error_bytes, "%s: %u-bit %s, but depth is a 16-bit grey PNG", path, out->bits,
                          out->channels == 1 ? "grey" : "colour");
    }
    if (out->width < IMPORT_LEAST_SIDE || out->height < IMPORT_LEAST_SIDE) {
        return t3r_reason(error, error_bytes, "%s: %ux%u pixels are too few", path, out->width, out->height);
    }
    return 0;
}

/* Reads a picture of a frame; raw: it is a depth picture. */
static int read_named(const char *directory, const char *name, const raw_depth *raw, picture *out, char *error,
                      size_t error_bytes)
{
    char *path = find_picture(directory, name);
    const int status = path == NULL  ? t3r_reason(error, error_bytes, "out of memory")
                       : raw == NULL ? read_colour(path, out, error, error_bytes)
                                     : read_depth(path, raw, out, error, error_bytes);
    free(path);
    return status;
}

/* Sets samples that mean "no depth" to 0. */
static void forget_samples(picture *depth, uint16_t no_depth)
{
    uint16_t *samples = depth->samples;
    for (size_t i = 0; i < (size_t)depth->width * depth->height; i++) {
        samples[i] = samples[i] == no_depth ? 0 : samples[i];
    }
}

/* ---- adapting -------------------------------------------------------------------------------------------------- */

/* Whether the lens folds: with some coefficients the runtime cannot invert the distortion within the picture. -1 when
 * memory is out. */
static int lens_folds(const t3r_camera *camera, uint32_t width, uint32_t height)
{
    if (camera->distortion == T3R_DISTORTION_NONE) {
        return 0;
    }
    int32_t *grid = malloc(T3R_GRID_VALUES(width, height) * sizeof *grid);
    int folds = grid == NULL ? -1 : t3r_undistort_grid(camera, width, height, grid) != T3R_OK;
    free(grid);
    return folds;
}

/* Checks that build can use the camera that results from cropping and resizing. */
static int check_camera(const t3r_recorded_camera *camera, const char *name, char *error, size_t error_bytes)
{
    t3r_camera fixed;
    const char *wrong = t3r_fixed_camera(camera, &fixed);
    if (wrong != NULL) {
        return t3r_reason(error, error_bytes, "%s: %s; after resizing fl_x, fl_y, cx, cy are %g, %g, %g, %g", name,
                          wrong, camera->fx, camera->fy, camera->cx, camera->cy);
    }
    int folds = lens_folds(&fixed, camera->width, camera->height);
    return folds == 0 ? 0
                      : t3r_reason(error, error_bytes, "%s: %s", name,
                                   folds < 0 ? "out of memory"
                                             : "distortion: the coefficients fold more than half of the picture");
}

/* ---- colour ---------------------------------------------------------------------------------------------------- */

/* Turns a frame's picture as its camera sees it. */
static int turn_upright(const posed_frame *frame, picture *colour, char *error, size_t error_bytes)
{
    bool turn;
    if (find_turn(frame, colour, &turn, error, error_bytes) != 0) {
        return -1;
    }
    return !turn || picture_turn(colour) == 0 ? 0 : t3r_reason(error, error_bytes, "%s: out of memory", frame->image);
}

/* Marks the pixels invalid that the frame's mask has black. */
static int apply_mask(const char *directory, const posed_frame *frame, picture *colour, char *error, size_t error_bytes)
{
    const size_t pixels = (size_t)colour->width * colour->height;
    picture mask = {0};
    if (frame->mask == NULL) {
        return 0;
    }
    int status = read_named(directory, frame->mask, NULL, &mask, error, error_bytes);
    if (status == 0 && !posed_same_aspect(mask.width, mask.height, colour->width, colour->height)) {
        status = t3r_reason(error, error_bytes, "%s: a mask of %ux%u pixels, but the picture has %ux%u", frame->mask,
                            mask.width, mask.height, colour->width, colour->height);
    }
    if (status == 0 && colour->valid == NULL && (colour->valid = malloc(pixels)) != NULL) {
        memset(colour->valid, 1, pixels);
    }
    if (status == 0 && (colour->valid == NULL || picture_keep_bright(&mask) != 0)) {
        status = t3r_reason(error, error_bytes, "%s: out of memory", frame->mask);
    }
    for (size_t i = 0; i < pixels && status == 0; i++) {
        const uint32_t x = (uint32_t)(i % colour->width), y = (uint32_t)(i / colour->width);
        colour->valid[i] = colour->valid[i] != 0 && picture_valid_at(&mask, x, y, colour);
    }
    picture_free(&mask);
    return status;
}

int import_picture_upright(const char *directory, const posed_frame *frame, picture *out, char *error,
                           size_t error_bytes)
{
    return read_named(directory, frame->image, NULL, out, error, error_bytes) == 0
               ? turn_upright(frame, out, error, error_bytes)
               : -1;
}

/* Drops the border of colour, and adapts its camera. */
static void cut_colour(const posed_frame *frame, picture *colour, t3r_recorded_camera *camera)
{
    const t3r_crop *part = &frame->inner.part;
    if (frame->inner.width != 0) {
        picture_crop(colour, part);
        t3r_crop_camera(camera, part, part->width, part->height);
    }
}

/* Drops the border of depth of the same view. */
static void cut_depth(const posed_frame *frame, picture *depth)
{
    const picture_inner *inner = &frame->inner;
    if (inner->width != 0) {
        const t3r_crop part =
            import_crop_in_proportion(&inner->part, inner->width, inner->height, depth->width, depth->height);
        picture_crop(depth, &part);
    }
}

/* Reads the picture and makes its camera: upright, without a border, at most T3R_MAX_SIDE pixels wide and high if
 * `large`, and without a distortion that no recording holds: `bent` is then that lens. */
static int read_view(const char *directory, const posed_frame *frame, bool large, picture *colour,
                     t3r_recorded_camera *camera, lens *bent, char *error, size_t error_bytes)
{
    char reason[512];
    if (import_picture_upright(directory, frame, colour, error, error_bytes) != 0 ||
        apply_mask(directory, frame, colour, error, error_bytes) != 0) {
        return -1;
    }
    if (posed_frame_camera(frame, colour->width, colour->height, camera, reason, sizeof reason) != 0) {
        return t3r_reason(error, error_bytes, "%s: %s", frame->image, reason);
    }
    cut_colour(frame, colour, camera);
    const uint32_t n = picture_reduction(colour->width, colour->height);
    if (n > 1 && !large) {
        return t3r_reason(error, error_bytes,
                          "%s: %ux%u pixels; sides of up to %u are supported, larger ones with --size", frame->image,
                          colour->width, colour->height, T3R_MAX_SIDE);
    }
    if (n > 1) {
        const t3r_crop whole = {.width = colour->width / n * n, .height = colour->height / n * n};
        picture_reduce(colour, n);
        t3r_crop_camera(camera, &whole, colour->width, colour->height);
    }
    if (posed_is_bent(&frame->intrinsics)) {
        *bent = posed_lens(&frame->intrinsics, camera);
        if (straighten(bent, colour, reason, sizeof reason) != 0) {
            return t3r_reason(error, error_bytes, "%s: %s", frame->image, reason);
        }
        camera->distortion = T3R_DISTORTION_NONE;
        memset(camera->coefficients, 0, sizeof camera->coefficients);
    }
    return picture_blacken(colour)
               ? 0
               : t3r_reason(error, error_bytes, "%s: alpha or the mask leaves no pixel of it", frame->image);
}

/* Returns 0, or -1 with a reason. */
static int adapt_colour(const posed_frame *frame, const picture *colour, t3r_crop *crop, uint32_t width,
                        uint32_t height, import_buffers *buffers, t3r_recorded_frame *out, char *error,
                        size_t error_bytes)
{
    out->format = T3R_PIXEL_RGB24;
    out->width = width != 0 ? width : colour->width;
    out->height = width != 0 ? height : colour->height;
    if (out->width < T3R_MIN_SIDE || out->height < T3R_MIN_SIDE) {
        return t3r_reason(error, error_bytes, "%s: %ux%u pixels; sides of %u and more are supported, or give --size",
                          frame->image, out->width, out->height, T3R_MIN_SIDE);
    }
    *crop = import_largest_crop(colour->width, colour->height, out->width, out->height);
    if (crop->width < IMPORT_LEAST_SIDE || crop->height < IMPORT_LEAST_SIDE) {
        return t3r_reason(error, error_bytes, "%s: too narrow to crop to that aspect", frame->image);
    }
    t3r_crop_camera(&out->camera, crop, out->width, out->height);
    if (check_camera(&out->camera, frame->image, error, error_bytes) != 0) {
        return -1;
    }
    buffers->rgb = malloc((size_t)out->width * out->height * 3);
    if (buffers->rgb == NULL || import_crop_colour(colour, crop, out->width, out->height, buffers->rgb) != 0) {
        return t3r_reason(error, error_bytes, "%s: out of memory", frame->image);
    }
    out->planes[0] = buffers->rgb;
    out->stride_bytes[0] = out->width * 3;
    return 0;
}

/* ---- depth ----------------------------------------------------------------------------------------------------- */

/* Reads the frame's depth as its colour camera sees it. */
static int read_aligned(const char *directory, const posed_frame *frame, const picture *colour,
                        const t3r_recorded_camera *camera, const lens *bent, picture *depth, char *error,
                        size_t error_bytes)
{
    char reason[512];
    if (read_named(directory, frame->depth, &frame->depth_raw, depth, error, error_bytes) != 0) {
        return -1;
    }
    if (frame->no_depth != 0) {
        forget_samples(depth, frame->no_depth);
    }
    if (frame->depth_lens.fx != 0) {
        return align_depth(frame, camera, depth, reason, sizeof reason) == 0
                   ? 0
                   : t3r_reason(error, error_bytes, "%s: its lens: %s", frame->depth, reason);
    }
    cut_depth(frame, depth);
    if (!posed_same_aspect(depth->width, depth->height, colour->width, colour->height)) {
        return t3r_reason(error, error_bytes,
                          "%s: %ux%u pixels of depth cannot show the view of a picture of %ux%u: another aspect; crop "
                          "the depth to that view, or give its lens (intrinsic/intrinsic_depth.txt beside pose texts)",
                          frame->depth, depth->width, depth->height, colour->width, colour->height);
    }
    return bent->fx == 0 || straighten(bent, depth, reason, sizeof reason) == 0
               ? 0
               : t3r_reason(error, error_bytes, "%s: %s", frame->depth, reason);
}

/* t3r_frame takes depth as little-endian bytes. */
static void to_little_endian(uint16_t *values, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        uint8_t bytes[2] = {(uint8_t)values[i], (uint8_t)(values[i] >> 8)};
        memcpy(&values[i], bytes, sizeof bytes);
    }
}

/* Sets depth to 0 where colour is invalid. */
static void forget_invalid(const picture *colour, picture *depth)
{
    uint16_t *samples = depth->samples;
    for (size_t i = 0; i < (size_t)depth->width * depth->height && colour->valid != NULL; i++) {
        if (!picture_valid_at(colour, (uint32_t)(i % depth->width), (uint32_t)(i / depth->width), depth)) {
            samples[i] = 0;
        }
    }
}

/* Adapts depth of the same view as colour. */
static int adapt_depth(const posed_frame *frame, const picture *colour, const t3r_crop *crop, picture *depth,
                       bool resize, import_buffers *buffers, t3r_recorded_frame *out, char *error, size_t error_bytes)
{
    const char *name = frame->depth != NULL ? frame->depth : "pointmap";
    const t3r_crop part = import_crop_in_proportion(crop, colour->width, colour->height, depth->width, depth->height);
    if (part.width < IMPORT_LEAST_SIDE || part.height < IMPORT_LEAST_SIDE) {
        return t3r_reason(error, error_bytes, "%s: too small to crop", name);
    }
    forget_invalid(colour, depth);
    to_little_endian(depth->samples, (size_t)depth->width * depth->height);
    out->depth_width = resize ? out->width : depth->width;
    out->depth_height = resize ? out->height : depth->height;
    buffers->depth = malloc((size_t)out->depth_width * out->depth_height * sizeof *buffers->depth);
    if (buffers->depth == NULL || import_crop_depth(depth->samples, depth->width * 2, &part, out->depth_width,
                                                    out->depth_height, buffers->depth) != 0) {
        return t3r_reason(error, error_bytes, "%s: out of memory", name);
    }
    out->depth = buffers->depth;
    return 0;
}

/* ---- both ------------------------------------------------------------------------------------------------------ */

static int adapt(const char *directory, const posed_frame *frame, uint32_t width, uint32_t height, picture *colour,
                 picture *depth, import_buffers *buffers, t3r_recorded_frame *out, char *error, size_t error_bytes)
{
    t3r_crop crop = {0};
    lens bent = {0};
    const bool made = depth->samples != NULL;
    if (read_view(directory, frame, width != 0, colour, &out->camera, &bent, error, error_bytes) != 0) {
        return IMPORT_NO_FRAME;
    }
    const t3r_recorded_camera whole = out->camera;
    if (adapt_colour(frame, colour, &crop, width, height, buffers, out, error, error_bytes) != 0) {
        return IMPORT_NO_FRAME;
    }
    if (!made && frame->depth == NULL) {
        return 0;
    }
    if (made) {
        cut_depth(frame, depth);
    }
    if (made && !posed_same_aspect(depth->width, depth->height, colour->width, colour->height)) {
        (void)t3r_reason(error, error_bytes, "%s: a pointmap of %ux%u pixels, but the picture has %ux%u", frame->image,
                         depth->width, depth->height, colour->width, colour->height);
        return IMPORT_NO_DEPTH;
    }
    if ((!made && read_aligned(directory, frame, colour, &whole, &bent, depth, error, error_bytes) != 0) ||
        adapt_depth(frame, colour, &crop, depth, width != 0, buffers, out, error, error_bytes) != 0) {
        return IMPORT_NO_DEPTH;
    }
    return 0;
}

int import_frame(const char *directory, const posed_frame *frame, picture *made, uint32_t width, uint32_t height,
                 import_buffers *buffers, t3r_recorded_frame *out, char *error, size_t error_bytes)
{
    picture colour = {0}, depth = made != NULL ? *made : (picture){0};
    if (made != NULL) {
        *made = (picture){0};
    }
    *buffers = (import_buffers){0};
    *out = (t3r_recorded_frame){0};
    int status = adapt(directory, frame, width, height, &colour, &depth, buffers, out, error, error_bytes);
    picture_free(&colour);
    picture_free(&depth);
    return status;
}

void import_buffers_free(import_buffers *buffers)
{
    free(buffers->rgb);
    free(buffers->depth);
    *buffers = (import_buffers){0};
}
