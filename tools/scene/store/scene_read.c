/* SPDX-License-Identifier: Apache-2.0 */
#include <inttypes.h>
#include <stdlib.h>
#include <sys/stat.h>

#include "host/file_bytes.h"
#include "host/reason.h"
#include "scene/chosen_rows.h"
#include "scene/store/scene_formats.h"
#include "scene/store/scene_store.h"

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
    const scene_format *format = scene_format_of(name, bytes, count);
    *dropped = 0;
    if (format->parse == NULL) {
        return t3r_reason(error, error_bytes, "%s is written, not read", format->suffix);
    }
    if ((flags & T3R_SCENE_DROP_INVALID) == 0) {
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

/* Returns the bytes of a scene file; NULL with the reason in error[]. */
static uint8_t *read_bytes(const char *path, size_t *count, char *error, size_t error_bytes)
{
    struct stat about;
    if (stat(path, &about) == 0 && S_ISDIR(about.st_mode)) {
        (void)t3r_reason(error, error_bytes,
                         "%s: a folder, not a scene file (an unpacked .sog is read once its files are zipped)", path);
        return NULL;
    }
    const scene_format *named = scene_format_of_path(path);
    const bool begins_with_anything = named != NULL && named->magic == NULL && named->parse != NULL;
    return t3r_file_bytes_checked(path, SIZE_MAX, begins_with_anything ? NULL : scene_format_check, count, error,
                                  error_bytes);
}

static void remark_dropped(const scene_caller *caller, const char *path, uint32_t dropped)
{
    if (dropped > 0) {
        scene_remark(caller, path, "%" PRIu32 " invalid Gaussians are left out", dropped);
    }
}

void scene_store_remark(const scene_caller *caller, const char *path, const scene_remarks *remarks)
{
    if (remarks->text[0] != '\0') {
        scene_remark(caller, path, "%s", remarks->text);
    }
    remark_dropped(caller, path, remarks->dropped);
    if (remarks->step > 0) {
        scene_remark_rounded(caller, path, remarks->step, remarks->width);
    }
    if (remarks->pulled > 0) {
        scene_remark_far(caller, path, remarks->pulled, "drawn nearer, and smaller in proportion");
    }
    if (remarks->clipped > 0) {
        scene_remark(caller, path, "%" PRIu32 " Gaussians have harmonics beyond 8: they are drawn with 8",
                     remarks->clipped);
    }
}

int scene_store_read(const char *path, int flags, const scene_caller *caller, scene_file *out, char *error,
                     size_t error_bytes)
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
        scene_store_remark(caller, path, &out->remarks);
    }
    return result;
}

typedef struct noting_sink {
    const scene_sink *next;
    const scene_caller *caller;
    const char *path;
    bool is_reached; /* a reason is the sink's own */
} noting_sink;

static int take_noting(void *user, const scene_rows *rows, char *error, size_t error_bytes)
{
    noting_sink *noting = user;
    noting->is_reached = true;
    if (rows->remark != NULL) {
        scene_remark(noting->caller, noting->path, "%s", rows->remark);
    }
    return noting->next->take(noting->next->user, rows, error, error_bytes);
}

int scene_store_take(const char *path, int flags, const scene_caller *caller, const scene_sink *sink, char *error,
                     size_t error_bytes)
{
    size_t count;
    uint32_t dropped;
    uint8_t *bytes = read_bytes(path, &count, error, error_bytes);
    if (bytes == NULL) {
        return -1;
    }
    char reason[512] = "";
    noting_sink noting = {.next = sink, .caller = caller, .path = path};
    const scene_sink noted = {take_noting, &noting};
    const int result = parse_rows(path, bytes, count, flags, &noted, &dropped, reason, sizeof reason);
    free(bytes);
    remark_dropped(caller, path, dropped);
    return result == 0         ? 0
           : noting.is_reached ? t3r_reason(error, error_bytes, "%s", reason)
                               : t3r_reason(error, error_bytes, "%s: %s", path, reason);
}
