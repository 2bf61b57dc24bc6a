/* SPDX-License-Identifier: Apache-2.0 */
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "api/checks.h"
#include "core/scene_frame.h"
#include "host/reason.h"
#include "scene/chosen_rows.h"
#include "scene/scene_cuts.h"
#include "scene/scene_extent.h"
#include "scene/store/scene_formats.h"
#include "scene/store/scene_store.h"

/* Floats have 24 bits: with the world's origin farther away than this many typical distances, positions lose more than
 * 2^-11 of one. */
#define FAR_FROM_ORIGIN 0x1p13

/* Returns a frame for rows without one: its origin is a whole number of units. */
static t3r_scene_frame frame_of(const scene_rows *rows, const scene_extent *extent)
{
    t3r_scene_frame frame = rows->frame;
    for (int axis = 0; axis < 3 && !rows->has_frame; axis++) {
        const double whole = nearbyint(fmin(fmax(extent->centre[axis], -0x1p29), 0x1p29));
        frame.origin_q32[axis] = (int64_t)whole * (INT64_C(1) << 32);
    }
    if (!rows->has_frame) {
        const int exponent = scene_extent_exponent(extent);
        frame.exponent = exponent < T3R_EXPONENT_LEAST  ? T3R_EXPONENT_LEAST
                         : exponent > T3R_EXPONENT_MOST ? T3R_EXPONENT_MOST
                                                        : exponent;
    }
    return frame;
}

/* Moves the centre of rows that are relative to an origin to the world. */
static void add_origin(scene_extent *extent, const scene_rows *rows)
{
    for (int axis = 0; axis < 3 && rows->has_frame && rows->local; axis++) {
        extent->centre[axis] += ldexp((double)rows->frame.origin_q32[axis], -32);
    }
}

static bool is_far_from_origin(const scene_extent *extent)
{
    const double *c = extent->centre;
    return fmax(fabs(c[0]), fmax(fabs(c[1]), fabs(c[2]))) > FAR_FROM_ORIGIN * extent->typical;
}

/* Describes the rows as the format writes them. */
static scene_source source_of(const scene_format *format, const scene_rows *rows, const scene_extent *extent, int flags,
                              const char *note)
{
    scene_source source = {.rows = rows,
                           .flags = flags,
                           .note = note,
                           .frame = frame_of(rows, extent),
                           .turn = scene_turn_between(rows->axes, format->axes, (scene_up)(flags / SCENE_FILE_UP)),
                           .typical = extent->typical,
                           .degree = rows->degree < format->degree ? rows->degree : format->degree};
    const bool is_local = rows->has_frame && rows->local, writes_local = (flags & T3R_SCENE_LOCAL) != 0;
    for (int axis = 0; axis < 3; axis++) {
        const double origin = ldexp((double)source.frame.origin_q32[axis], -32);
        source.shift[axis] = is_local == writes_local ? 0 : is_local ? origin : -origin;
        source.centre[axis] = extent->centre[axis] - (writes_local ? origin : 0);
    }
    double unturned[4] = {1, 0, 0, 0};
    scene_turn_apply(&source.turn, source.centre, unturned, 0, NULL);
    return source;
}

static void remark_origin(const scene_caller *caller, const char *path, const scene_format *format,
                          const scene_source *source)
{
    const int64_t *origin = source->frame.origin_q32;
    scene_remark(caller, path,
                 "floats would lose the detail of positions so far from the world's origin: they are relative to "
                 "(%.15g, %.15g, %.15g), which %s",
                 ldexp((double)origin[0], -32), ldexp((double)origin[1], -32), ldexp((double)origin[2], -32),
                 format->holds_origin ? "the file says" : "this format has no place for");
}

/* Remarks on colours and widths that the format has no numbers for, and cuts off. */
static void remark_cuts(const scene_caller *caller, const char *path, const scene_format *format,
                        const scene_source *source, const scene_extent *extent)
{
    const scene_cuts cuts = scene_cuts_of(format, source, extent);
    if (cuts.colours > 0) {
        scene_remark(caller, path,
                     "%" PRIu32 " Gaussians have colours outside %.3g to %.3g, where this format cuts them off",
                     cuts.colours, format->colour.least, format->colour.most);
    }
    if (cuts.widths > 0) {
        scene_remark(caller, path,
                     "%" PRIu32 " Gaussians have widths outside %.3g to %.3g units, where this format cuts them off",
                     cuts.widths, exp(format->log_scale.least), exp(format->log_scale.most));
    }
}

/* Writes all rows; `extent` is theirs, in world units. */
static int write_all(const char *path, const scene_rows *rows, const scene_extent *extent, int flags, const char *note,
                     const scene_caller *caller, scene_conversion *out, char *error, size_t error_bytes)
{
    const scene_format *format = scene_format_of_path(path);
    const bool moves = (flags & T3R_SCENE_LOCAL) == 0 && is_far_from_origin(extent);
    const scene_source source =
        source_of(format, rows, extent, moves ? flags | T3R_SCENE_LOCAL | T3R_SCENE_COMMENTS : flags, note);
    out->count = rows->count;
    out->degree = source.degree;
    t3r_whole_file file;
    if (caller->begin(&file, path, error, error_bytes) != 0) {
        return -1;
    }
    char reason[256] = "";
    if (format->write(file.stream, &source, reason, sizeof reason) != 0) {
        t3r_whole_file_abandon(&file);
        return t3r_reason(error, error_bytes, "%s: %s", file.path, reason);
    }
    if (moves) {
        remark_origin(caller, path, format, &source);
    }
    if (source.degree > 0 && format->harmonics > 0 && extent->harmonics > format->harmonics) {
        scene_remark(caller, path, "harmonics of up to %.3g are cut off at %.3g, the most of this format",
                     extent->harmonics, format->harmonics);
    }
    remark_cuts(caller, path, format, &source, extent);
    if (rows->mip && !format->holds_mip) {
        scene_remark(caller, path,
                     "this format has no place for the mark of mip-splatting (antialiased): viewers will draw the "
                     "scene too bright");
    }
    if (rows->backdrop > 0 && !format->holds_backdrop) {
        scene_remark(caller, path,
                     "this format has no place for the mark of the %" PRIu32 " Gaussians beyond the pictures: drawn "
                     "from this file they have a depth; a .ply keeps the mark",
                     rows->backdrop);
    }
    return t3r_whole_file_commit(&file, NULL, error, error_bytes);
}

/* Writes the rows that the format has bits for; `extent` is in the rows' own units. */
static int write_rows(const char *path, const scene_rows *rows, const scene_extent *extent, int flags, const char *note,
                      const scene_caller *caller, scene_conversion *out, char *error, size_t error_bytes)
{
    const scene_format *format = scene_format_of_path(path);
    if (format == NULL || format->write == NULL) {
        char known[SCENE_FILE_SUFFIXES_BYTES];
        return t3r_reason(error, error_bytes, "%s: scenes are written as %s", path, scene_file_suffixes(known));
    }
    scene_extent in_world = *extent;
    add_origin(&in_world, rows);
    if (!format->shares_bits || extent->far == 0) {
        return write_all(path, rows, &in_world, flags, note, caller, out, error, error_bytes);
    }
    chosen_rows chosen;
    int result = chosen_rows_near(rows, extent, &chosen, error, error_bytes);
    if (result == 0) {
        result = write_all(path, &chosen.rows, &in_world, flags, note, caller, out, error, error_bytes);
    }
    if (result == 0) {
        scene_remark_far(caller, path, chosen.left_out, "left out, as their range would cost the others their bits");
    }
    chosen_rows_free(&chosen);
    return result;
}

/* Bounds of the distance of two different positions, as powers of 2 in scene units. */
#define NEAREST (-20)
#define FARTHEST 12

/* Checks that a file of the scene can be read again. */
static int check_scene(const scene_file *scene, const scene_rows *rows, char *error, size_t error_bytes)
{
    if (scene->count == 0 || scene->count > T3R_MAX_GAUSSIANS) {
        return t3r_reason(error, error_bytes, "%" PRIu32 " Gaussians: a file has 1..%d", scene->count,
                          T3R_MAX_GAUSSIANS);
    }
    if (!t3r_is_scene_frame(&scene->frame)) {
        return t3r_reason(error, error_bytes, "the scene's origin or exponent is out of its range");
    }
    const t3r_gaussian *gaussians = scene->gaussians;
    bool differ = false;
    for (uint32_t i = 0; i < scene->count; i++) {
        if (!t3r_is_gaussian(&gaussians[i])) {
            return t3r_reason(error, error_bytes, "Gaussian %" PRIu32 ": a field is out of its range", i);
        }
        differ = differ ||
                 memcmp(gaussians[i].position_q20, gaussians[0].position_q20, sizeof gaussians[0].position_q20) != 0;
    }
    const int32_t exponent = scene->frame.exponent;
    if (differ && exponent + NEAREST >= T3R_EXPONENT_LEAST && exponent + FARTHEST <= T3R_EXPONENT_MOST) {
        return 0; /* whatever the reader finds as the typical distance */
    }
    const scene_turn as_they_are = scene_turn_between(rows->axes, rows->axes, T3R_UP_UNKNOWN);
    t3r_scene_frame chosen;
    scene_extent extent;
    return scene_rows_choose_frame(rows, &as_they_are, &chosen, &extent, error, error_bytes);
}

/* Returns the largest harmonic above degree 0. */
static double largest_harmonic(const scene_file *scene)
{
    int32_t largest = 0;
    const size_t numbers = scene_file_harmonics_count(scene);
    for (size_t i = 0; scene->degree > 0 && i < scene->count * numbers; i++) {
        const int32_t size = i % numbers < 3 ? 0 : abs(scene->harmonics_q12[i]);
        largest = size > largest ? size : largest;
    }
    return ldexp(largest, -12);
}

int scene_store_write(const char *path, const scene_file *scene, int flags, const char *note,
                      const scene_caller *caller, char *error, size_t error_bytes)
{
    scene_conversion written;
    const scene_rows rows = scene_rows_of(scene);
    const scene_bounds any = {-INFINITY, INFINITY};
    char reason[256] = "";
    if (check_scene(scene, &rows, reason, sizeof reason) != 0) {
        return t3r_reason(error, error_bytes, "%s: %s", path, reason);
    }
    const scene_extent extent = {.typical = ldexp(1, scene->frame.exponent),
                                 .harmonics = largest_harmonic(scene),
                                 .colour = any,
                                 .log_scale = any};
    return write_rows(path, &rows, &extent, flags, note, caller, &written, error, error_bytes);
}

typedef struct conversion {
    const char *from, *to;
    int flags;
    const scene_crop *crop;
    const scene_caller *caller;
    scene_conversion *out;
} conversion;

static int convert_rows(const conversion *c, const scene_rows *rows, char *error, size_t error_bytes)
{
    const int kept = rows->has_frame ? T3R_SCENE_COMMENTS | (rows->local ? T3R_SCENE_LOCAL : 0) : 0;
    scene_extent extent;
    char reason[256] = "";
    if (scene_extent_of(rows, &extent, reason, sizeof reason) != 0) {
        return t3r_reason(error, error_bytes, "%s: %s", c->from, reason);
    }
    if (scene_extent_is_rounded(&extent)) {
        scene_remark_rounded(c->caller, c->from, extent.step, extent.width);
    }
    return write_rows(c->to, rows, &extent, c->flags | kept, NULL, c->caller, c->out, error, error_bytes);
}

static int take_conversion(void *user, const scene_rows *rows, char *error, size_t error_bytes)
{
    const conversion *c = user;
    c->out->count_read = rows->count;
    c->out->degree_read = rows->degree;
    if (c->crop == NULL) {
        return convert_rows(c, rows, error, error_bytes);
    }
    chosen_rows kept;
    char reason[256] = "";
    const int result = chosen_rows_cropped(rows, c->crop, &kept, reason, sizeof reason) == 0
                           ? convert_rows(c, &kept.rows, error, error_bytes)
                           : t3r_reason(error, error_bytes, "%s: %s", c->from, reason);
    chosen_rows_free(&kept);
    return result;
}

int scene_store_convert(const char *from, const char *to, int flags, const scene_crop *crop, const scene_caller *caller,
                        scene_conversion *out, char *error, size_t error_bytes)
{
    *out = (scene_conversion){0};
    conversion to_do = {.from = from, .to = to, .flags = flags, .crop = crop, .caller = caller, .out = out};
    return scene_store_take(from, flags, caller, &(scene_sink){take_conversion, &to_do}, error, error_bytes);
}
