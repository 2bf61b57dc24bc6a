/* SPDX-License-Identifier: Apache-2.0 */
#include "scene/scene_file.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>

#include "api/checks.h"
#include "cli/cli.h"
#include "cli/files/whole_file.h"
#include "cli/options/file_kind.h"
#include "core/scene_frame.h"
#include "host/file_bytes.h"
#include "host/reason.h"
#include "scene/chosen_rows.h"
#include "scene/scene_cuts.h"
#include "scene/scene_extent.h"
#include "scene/scene_format.h"

/* All formats. Of two with one suffix the first is written; `ply` is used for files that no format recognises. */
#ifdef T3R_WEBP
#define FORMATS_OF_WEBP FORMAT(sog)
#else
#define FORMATS_OF_WEBP
#endif
#define FORMATS FORMAT(ply) FORMAT(packed_ply) FORMAT(splat) FORMAT(spz) FORMAT(spz_gzip) FORMAT(glb) FORMATS_OF_WEBP

#define FORMAT(name) extern const scene_format scene_format_##name;
FORMATS
#undef FORMAT

static const scene_format *const formats[] = {
#define FORMAT(name) &scene_format_##name,
    FORMATS
#undef FORMAT
};
enum { FORMATS_COUNT = sizeof formats / sizeof formats[0] };

/* Returns the format with the longest matching suffix. */
static const scene_format *format_of_path(const char *path)
{
    const scene_format *found = NULL;
    const size_t length = strlen(path);
    size_t longest = 0;
    for (int i = 0; i < FORMATS_COUNT; i++) {
        const size_t end = strlen(formats[i]->suffix);
        if (length > end && end > longest && strcasecmp(path + length - end, formats[i]->suffix) == 0) {
            found = formats[i];
            longest = end;
        }
    }
    return found;
}

static const scene_format *format_of_bytes(const uint8_t *bytes, size_t count)
{
    for (int i = 0; i < FORMATS_COUNT; i++) {
        const char *magic = formats[i]->magic;
        if (magic != NULL && count >= strlen(magic) && memcmp(bytes, magic, strlen(magic)) == 0) {
            return formats[i];
        }
    }
    return NULL;
}

bool scene_file_is_one(const char *path)
{
    const file_kind kind = file_kind_of(path);
    const scene_format *named = format_of_path(path);
    return kind == FILE_SCENE ||
           (kind != FILE_RECORDING && kind != FILE_PICTURE && named != NULL && named->parse != NULL);
}

bool scene_file_is_written(const char *path)
{
    const scene_format *format = format_of_path(path);
    return format != NULL && format->write != NULL;
}

const char *scene_file_suffixes(char text[SCENE_FILE_SUFFIXES_BYTES])
{
    size_t length = 0;
    for (int i = 0; i < FORMATS_COUNT; i++) {
        if (formats[i]->write != NULL && length < SCENE_FILE_SUFFIXES_BYTES) {
            length += (size_t)snprintf(text + length, SCENE_FILE_SUFFIXES_BYTES - length, "%s%s",
                                       length > 0 ? ", " : "", formats[i]->suffix);
        }
    }
    return text;
}

/* Finds the format by the first bytes, else by the name. */
static const scene_format *format_of(const char *name, const uint8_t *bytes, size_t count)
{
    const scene_format *format = format_of_bytes(bytes, count);
    format = format != NULL ? format : format_of_path(name);
    return format != NULL ? format : &scene_format_ply;
}

/* ---- reading ----------------------------------------------------------------------------------------------------- */

typedef struct valid_sink {
    const scene_sink *next;
    uint32_t dropped;
} valid_sink;

static int take_valid(void *user, const scene_rows *rows, char *error, size_t error_bytes)
{
    valid_sink *valid = user;
    chosen_rows chosen;
    int result = chosen_rows_valid(rows, &chosen, error, error_bytes);
    valid->dropped = chosen.left_out;
    if (result == 0) {
        result = valid->next->take(valid->next->user, &chosen.rows, error, error_bytes);
    }
    chosen_rows_free(&chosen);
    return result;
}

/* Hands the rows of a file to the sink, without the invalid ones if the flags say so; counts those. */
static int parse_rows(const char *name, const uint8_t *bytes, size_t count, int flags, const scene_sink *sink,
                      uint32_t *dropped, char *error, size_t error_bytes)
{
    const scene_format *format = format_of(name, bytes, count);
    *dropped = 0;
    if (format->parse == NULL) {
        return t3r_reason(error, error_bytes, "%s is written, not read", format->suffix);
    }
    if ((flags & SCENE_FILE_DROP_INVALID) == 0) {
        return format->parse(bytes, count, sink, error, error_bytes);
    }
    valid_sink valid = {.next = sink};
    const int result = format->parse(bytes, count, &(scene_sink){take_valid, &valid}, error, error_bytes);
    *dropped = valid.dropped;
    return result;
}

static int take_scene(void *user, const scene_rows *rows, char *error, size_t error_bytes)
{
    return scene_file_from_rows(rows, user, error, error_bytes);
}

int scene_file_parse(const char *name, const uint8_t *bytes, size_t count, int flags, scene_file *out, char *error,
                     size_t error_bytes)
{
    uint32_t dropped;
    *out = (scene_file){0};
    const scene_sink sink = {take_scene, out};
    const int result = parse_rows(name, bytes, count, flags, &sink, &dropped, error, error_bytes);
    out->remarks.dropped = dropped;
    return result;
}

/* Checks the first bytes before the whole file is read. */
static const char *check_first(const uint8_t *first, size_t count)
{
    return format_of_bytes(first, count) != NULL ? NULL : scene_format_ply.foreign;
}

/* Returns the bytes of a scene file; NULL with the reason in error[]. */
static uint8_t *read_bytes(const char *path, size_t *count, char *error, size_t error_bytes)
{
    struct stat about;
    if (stat(path, &about) == 0 && S_ISDIR(about.st_mode)) {
        (void)t3r_reason(error, error_bytes,
                         "%s: a folder, not a scene file (an unpacked .sog is read once its files are zipped)", path);
        return NULL;
    }
    const scene_format *named = format_of_path(path);
    const bool begins_with_anything = named != NULL && named->magic == NULL && named->parse != NULL;
    return t3r_file_bytes_checked(path, SIZE_MAX, begins_with_anything ? NULL : check_first, count, error, error_bytes);
}

static void warn_of_dropped(const char *path, uint32_t dropped)
{
    if (dropped > 0) {
        (void)cli_error(CLI_OK, "warning: %s: %" PRIu32 " invalid Gaussians are left out", path, dropped);
    }
}

static void warn_of_far(const char *path, uint32_t count, const char *done)
{
    (void)cli_error(CLI_OK,
                    "warning: %s: %" PRIu32 " Gaussians are about 1,000 times as far away as half of all, or farther: "
                    "they are %s",
                    path, count, done);
}

static void warn_of_text(const char *path, const char *text)
{
    if (text != NULL && text[0] != '\0') {
        (void)cli_error(CLI_OK, "warning: %s: %s", path, text);
    }
}

static void warn_of_remarks(const char *path, const scene_remarks *remarks)
{
    warn_of_text(path, remarks->text);
    warn_of_dropped(path, remarks->dropped);
    if (remarks->pulled > 0) {
        warn_of_far(path, remarks->pulled, "drawn nearer, and smaller in proportion");
    }
    if (remarks->clipped > 0) {
        (void)cli_error(CLI_OK, "warning: %s: %" PRIu32 " Gaussians have harmonics beyond 8: they are drawn with 8",
                        path, remarks->clipped);
    }
}

int scene_file_read(const char *path, int flags, scene_file *out, char *error, size_t error_bytes)
{
    *out = (scene_file){0};
    size_t count;
    uint8_t *bytes = read_bytes(path, &count, error, error_bytes);
    if (bytes == NULL) {
        return -1;
    }
    char reason[256] = "";
    int result = scene_file_parse(path, bytes, count, flags, out, reason, sizeof reason);
    if (result != 0) {
        t3r_reason(error, error_bytes, "%s: %s", path, reason);
    }
    free(bytes);
    if ((flags & SCENE_FILE_QUIET) == 0) {
        warn_of_remarks(path, &out->remarks);
    }
    return result;
}

/* ---- writing ----------------------------------------------------------------------------------------------------- */

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
                           .degree = rows->degree < format->degree ? rows->degree : format->degree};
    const bool is_local = rows->has_frame && rows->local, writes_local = (flags & SCENE_FILE_LOCAL) != 0;
    for (int axis = 0; axis < 3; axis++) {
        const double origin = ldexp((double)source.frame.origin_q32[axis], -32);
        source.shift[axis] = is_local == writes_local ? 0 : is_local ? origin : -origin;
    }
    return source;
}

static void warn_of_origin(const char *path, const scene_format *format, const scene_source *source)
{
    const int64_t *origin = source->frame.origin_q32;
    (void)cli_error(CLI_OK,
                    "warning: %s: floats would lose the detail of positions so far from the world's origin: they are "
                    "relative to (%.15g, %.15g, %.15g), which %s",
                    path, ldexp((double)origin[0], -32), ldexp((double)origin[1], -32), ldexp((double)origin[2], -32),
                    format->holds_origin ? "the file says" : "this format has no place for");
}

/* Warns of colours and widths that the format has no numbers for, and cuts off. */
static void warn_of_cuts(const char *path, const scene_format *format, const scene_source *source,
                         const scene_extent *extent)
{
    const scene_cuts cuts = scene_cuts_of(format, source, extent);
    if (cuts.colours > 0) {
        (void)cli_error(CLI_OK,
                        "warning: %s: %" PRIu32 " Gaussians have colours outside %.3g to %.3g, where this format cuts "
                        "them off",
                        path, cuts.colours, format->colour.least, format->colour.most);
    }
    if (cuts.widths > 0) {
        (void)cli_error(CLI_OK,
                        "warning: %s: %" PRIu32 " Gaussians have widths outside %.3g to %.3g units, where this format "
                        "cuts them off",
                        path, cuts.widths, exp(format->log_scale.least), exp(format->log_scale.most));
    }
}

/* Writes all rows; `extent` is theirs, in world units. */
static int write_all(const char *path, const scene_rows *rows, const scene_extent *extent, int flags, const char *note,
                     scene_conversion *out, char *error, size_t error_bytes)
{
    const scene_format *format = format_of_path(path);
    const bool moves = (flags & SCENE_FILE_LOCAL) == 0 && is_far_from_origin(extent);
    const scene_source source =
        source_of(format, rows, extent, moves ? flags | SCENE_FILE_LOCAL | SCENE_FILE_COMMENTS : flags, note);
    out->count = rows->count;
    out->degree = source.degree;
    whole_file file;
    if (whole_file_begin(&file, path, error, error_bytes) != 0) {
        return -1;
    }
    char reason[256] = "";
    if (format->write(file.stream, &source, reason, sizeof reason) != 0) {
        whole_file_abandon(&file);
        return t3r_reason(error, error_bytes, "%s: %s", path, reason);
    }
    if (moves) {
        warn_of_origin(path, format, &source);
    }
    if (source.degree > 0 && format->harmonics > 0 && extent->harmonics > format->harmonics) {
        (void)cli_error(CLI_OK, "warning: %s: harmonics of up to %.3g are cut off at %.3g, the most of this format",
                        path, extent->harmonics, format->harmonics);
    }
    warn_of_cuts(path, format, &source, extent);
    if (rows->mip && !format->holds_mip) {
        warn_of_text(path,
                     "this format has no place for the mark of mip-splatting (antialiased): viewers will draw the "
                     "scene too bright");
    }
    return whole_file_commit(&file, NULL, error, error_bytes);
}

/* Writes the rows that the format has bits for; `extent` is in the rows' own units. */
static int write_rows(const char *path, const scene_rows *rows, const scene_extent *extent, int flags, const char *note,
                      scene_conversion *out, char *error, size_t error_bytes)
{
    const scene_format *format = format_of_path(path);
    if (format == NULL || format->write == NULL) {
        char known[SCENE_FILE_SUFFIXES_BYTES];
        return t3r_reason(error, error_bytes, "%s: scenes are written as %s", path, scene_file_suffixes(known));
    }
    scene_extent in_world = *extent;
    add_origin(&in_world, rows);
    if (!format->shares_bits || extent->far == 0) {
        return write_all(path, rows, &in_world, flags, note, out, error, error_bytes);
    }
    chosen_rows chosen;
    int result = chosen_rows_near(rows, extent, &chosen, error, error_bytes);
    if (result == 0) {
        result = write_all(path, &chosen.rows, &in_world, flags, note, out, error, error_bytes);
    }
    if (result == 0) {
        warn_of_far(path, chosen.left_out, "left out, as their range would cost the others their bits");
    }
    chosen_rows_free(&chosen);
    return result;
}

/* Bounds of the distance of two different positions, as powers of 2 in scene units. */
#define NEAREST (-20)
#define FARTHEST 12

/* Checks that a file of the scene can be read again. */
static int check_scene(const t3r_scene *scene, const scene_rows *rows, char *error, size_t error_bytes)
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
    const scene_turn as_they_are = scene_turn_between(rows->axes, rows->axes, SCENE_UP_UNKNOWN);
    t3r_scene_frame chosen;
    return scene_rows_choose_frame(rows, &as_they_are, &chosen, error, error_bytes);
}

int scene_file_write(const char *path, const t3r_scene *scene, int flags, const char *note, char *error,
                     size_t error_bytes)
{
    scene_conversion written;
    /* only read */
    const scene_file made = {
        .frame = scene->frame, .gaussians = (t3r_gaussian *)(uintptr_t)scene->gaussians, .count = scene->count};
    const scene_rows rows = scene_rows_of(&made);
    const scene_bounds any = {-INFINITY, INFINITY};
    const scene_extent extent = {.typical = ldexp(1, scene->frame.exponent), .colour = any, .log_scale = any};
    char reason[256] = "";
    if (check_scene(scene, &rows, reason, sizeof reason) != 0) {
        return t3r_reason(error, error_bytes, "%s: %s", path, reason);
    }
    return write_rows(path, &rows, &extent, flags, note, &written, error, error_bytes);
}

/* ---- rows in doubles --------------------------------------------------------------------------------------------- */

typedef struct noting_sink {
    const scene_sink *next;
    const char *path;
    bool is_reached; /* a reason is the sink's own */
} noting_sink;

static int take_noting(void *user, const scene_rows *rows, char *error, size_t error_bytes)
{
    noting_sink *noting = user;
    noting->is_reached = true;
    warn_of_text(noting->path, rows->remark);
    return noting->next->take(noting->next->user, rows, error, error_bytes);
}

int scene_file_take(const char *path, int flags, const scene_sink *sink, char *error, size_t error_bytes)
{
    size_t count;
    uint32_t dropped;
    uint8_t *bytes = read_bytes(path, &count, error, error_bytes);
    if (bytes == NULL) {
        return -1;
    }
    char reason[512] = "";
    noting_sink noting = {.next = sink, .path = path};
    const scene_sink noted = {take_noting, &noting};
    const int result = parse_rows(path, bytes, count, flags, &noted, &dropped, reason, sizeof reason);
    free(bytes);
    warn_of_dropped(path, dropped);
    return result == 0         ? 0
           : noting.is_reached ? t3r_reason(error, error_bytes, "%s", reason)
                               : t3r_reason(error, error_bytes, "%s: %s", path, reason);
}

typedef struct conversion {
    const char *from, *to;
    int flags;
    scene_conversion *out;
} conversion;

static int take_conversion(void *user, const scene_rows *rows, char *error, size_t error_bytes)
{
    const conversion *c = user;
    const int kept = rows->has_frame ? SCENE_FILE_COMMENTS | (rows->local ? SCENE_FILE_LOCAL : 0) : 0;
    scene_extent extent;
    char reason[256] = "";
    if (scene_extent_of(rows, &extent, reason, sizeof reason) != 0) {
        return t3r_reason(error, error_bytes, "%s: %s", c->from, reason);
    }
    c->out->degree_read = rows->degree;
    return write_rows(c->to, rows, &extent, c->flags | kept, NULL, c->out, error, error_bytes);
}

int scene_file_convert(const char *from, const char *to, int flags, scene_conversion *out, char *error,
                       size_t error_bytes)
{
    *out = (scene_conversion){0};
    conversion to_do = {.from = from, .to = to, .flags = flags, .out = out};
    return scene_file_take(from, flags, &(scene_sink){take_conversion, &to_do}, error, error_bytes);
}
