/* SPDX-License-Identifier: Apache-2.0 */
/* Reads and writes scene files for any caller: a command prints remarks and guards its files (scene_file.h), a library
 * passes them on. */
#ifndef TRIM3R_TOOLS_SCENE_STORE_H
#define TRIM3R_TOOLS_SCENE_STORE_H

#include "host/whole_file.h"
#include "scene/scene_file.h"
#include "scene/scene_rows.h"

typedef struct scene_caller {
    /* Takes a remark on a file that is read or written all the same: "path: what". */
    void (*remark)(void *user, const char *text);
    void *user;
    /* Begins a file that is written, like t3r_whole_file_begin(). */
    int (*begin)(t3r_whole_file *file, const char *path, char *error, size_t error_bytes);
} scene_caller;

/* Returns a scene in the arena as that of a file, which only reads it. */
static inline scene_file scene_store_scene(const t3r_scene *scene)
{
    return (scene_file){
        .frame = scene->frame, .gaussians = (t3r_gaussian *)(uintptr_t)scene->gaussians, .count = scene->count};
}

/* These are the functions of scene_file.h and scene_rows.h of the same names, for a caller. */
int scene_store_read(const char *path, int flags, const scene_caller *caller, scene_file *out, char *error,
                     size_t error_bytes);
int scene_store_take(const char *path, int flags, const scene_caller *caller, const scene_sink *sink, char *error,
                     size_t error_bytes);
int scene_store_write(const char *path, const scene_file *scene, int flags, const char *note,
                      const scene_caller *caller, char *error, size_t error_bytes);
int scene_store_convert(const char *from, const char *to, int flags, const scene_crop *crop, const scene_caller *caller,
                        scene_conversion *out, char *error, size_t error_bytes);

/* Passes the remarks on a scene that was read to the caller. */
void scene_store_remark(const scene_caller *caller, const char *path, const scene_remarks *remarks);
/* Passes a formatted remark on a file to the caller. */
void scene_remark(const scene_caller *caller, const char *path, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
/* Passes on that a file's positions are floats in such steps, while half of the Gaussians have at most this width. */
void scene_remark_rounded(const scene_caller *caller, const char *path, double step, double width);
/* Passes on that so many Gaussians of a file are far away, and what is done with them. */
void scene_remark_far(const scene_caller *caller, const char *path, uint32_t count, const char *done);

#endif
