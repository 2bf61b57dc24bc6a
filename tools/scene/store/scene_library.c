/* SPDX-License-Identifier: Apache-2.0 */
/* Scene files for programs of the host library: remarks go into the caller's text. */
#include <locale.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#include "core/camera.h"
#include "host/program_check.h"
#include "host/reason.h"
#include "scene/scene_append.h"
#include "scene/store/scene_store.h"

typedef struct remarks {
    char text[1024];
    size_t length;
} remarks;

/* Adds a remark to those before, as far as there is room. */
static void add_remark(void *user, const char *text)
{
    remarks *all = user;
    const size_t room = sizeof all->text - all->length;
    const int length = snprintf(all->text + all->length, room, "%s%s", all->length > 0 ? "; " : "", text);
    all->length += length > 0 && (size_t)length < room ? (size_t)length : room - 1;
}

/* The locale of the thread while a file is read or written: a program's may have a comma in its numbers. */
typedef struct file_locale {
    locale_t plain, before;
} file_locale;

static bool enter(file_locale *locale, char *error, size_t error_bytes)
{
    locale->plain = newlocale(LC_ALL_MASK, "C", (locale_t)0);
    if (locale->plain == (locale_t)0) {
        t3r_reason(error, error_bytes, "out of memory");
        return false;
    }
    locale->before = uselocale(locale->plain);
    return true;
}

static void leave(const file_locale *locale)
{
    uselocale(locale->before);
    freelocale(locale->plain);
}

static int begin_whole(t3r_whole_file *file, const char *path, char *error, size_t error_bytes)
{
    return t3r_whole_file_begin(file, path, NULL, error, error_bytes);
}

t3r_status t3r_scene_read_as(t3r_program program, const char *path, int flags, t3r_scene_file *out, char *error,
                             size_t error_bytes)
{
    remarks all = {.length = 0};
    const scene_caller caller = {.remark = add_remark, .user = &all};
    if (!t3r_program_fits(program, t3r_host_program(), error, error_bytes)) {
        return T3R_ERR_INTERFACE;
    }
    file_locale locale;
    if (!enter(&locale, error, error_bytes)) {
        return T3R_HOST_ERR_SYSTEM;
    }
    const int read = scene_store_read(path, flags & T3R_SCENE_DROP_INVALID, &caller, out, error, error_bytes);
    leave(&locale);
    if (read != 0) {
        return T3R_HOST_ERR_FILE;
    }
    t3r_reason(error, error_bytes, "%s", all.text);
    return T3R_OK;
}

void t3r_scene_free(t3r_scene_file *scene)
{
    scene_file_free(scene);
}

t3r_status t3r_scene_file_write_as(t3r_program program, const char *path, const t3r_scene_file *scene, int flags,
                                   char *error, size_t error_bytes)
{
    remarks all = {.length = 0};
    const scene_caller caller = {.remark = add_remark, .user = &all, .begin = begin_whole};
    if (!t3r_program_fits(program, t3r_host_program(), error, error_bytes)) {
        return T3R_ERR_INTERFACE;
    }
    file_locale locale;
    if (!enter(&locale, error, error_bytes)) {
        return T3R_HOST_ERR_SYSTEM;
    }
    const int written = scene_store_write(path, scene, flags & (T3R_SCENE_LOCAL | T3R_SCENE_COMMENTS), NULL, &caller,
                                          error, error_bytes);
    leave(&locale);
    if (written != 0) {
        return T3R_HOST_ERR_FILE;
    }
    t3r_reason(error, error_bytes, "%s", all.text);
    return T3R_OK;
}

t3r_status t3r_scene_write_as(t3r_program program, const char *path, const t3r_scene *scene, int flags, char *error,
                              size_t error_bytes)
{
    if (!t3r_program_fits(program, t3r_host_program(), error, error_bytes)) {
        return T3R_ERR_INTERFACE;
    }
    const scene_file made = scene_store_scene(scene);
    return t3r_scene_file_write_as(program, path, &made, flags, error, error_bytes);
}

t3r_status t3r_scene_load_as(t3r_program program, t3r_runtime *runtime, const t3r_scene_file *scene,
                             const t3r_camera *eye, uint32_t width, uint32_t height)
{
    const scene_eye from = {.camera = eye, .width = width, .height = height};
    uint32_t index;
    if (!t3r_program_fits(program, t3r_host_program(), NULL, 0)) {
        return T3R_ERR_INTERFACE;
    }
    const t3r_status status = eye != NULL ? t3r_camera_check(eye, width, height) : T3R_OK;
    return status == T3R_OK ? scene_append_all(runtime, scene, eye != NULL ? &from : NULL, &index) : status;
}

t3r_status t3r_scene_depths_as(t3r_program program, const t3r_scene_file *scene, const t3r_camera *eye,
                               const uint32_t *depths_q20, size_t count, double *depths)
{
    if (!t3r_program_fits(program, t3r_host_program(), NULL, 0)) {
        return T3R_ERR_INTERFACE;
    }
    const seen_from from = scene_seen_from(scene, &(scene_eye){.camera = eye});
    for (size_t i = 0; i < count; i++) {
        depths[i] = ldexp(seen_depth(&from, depths_q20[i]), from.frame.exponent);
    }
    return T3R_OK;
}
