/* SPDX-License-Identifier: Apache-2.0 */
/* Scene files of commands: remarks are warnings on stderr, and files are guarded. */
#include "scene/scene_file.h"

#include <unistd.h>

#include "cli/cli.h"
#include "cli/files/foreign_scene.h"
#include "cli/files/whole_file.h"
#include "cli/options/file_kind.h"
#include "host/reason.h"
#include "scene/store/scene_formats.h"
#include "scene/store/scene_store.h"

static void warn(void *user, const char *text)
{
    (void)user;
    (void)cli_error(CLI_OK, "warning: %s", text);
}

static const scene_caller command = {.remark = warn, .begin = whole_file_begin};

bool scene_file_is_one(const char *path)
{
    const file_kind kind = file_kind_of(path);
    const scene_format *named = scene_format_of_path(path);
    const bool is_named = (named != NULL && named->parse != NULL) || foreign_scene_of_name(path) != NULL;
    return kind == FILE_SCENE || (kind != FILE_RECORDING && kind != FILE_PICTURE && is_named);
}

/* Names what makes a scene of a file that was not read, if its suffix or its first bytes are those of such a kind.
 * Returns `status`. */
static int explained(int status, const char *path, char *error, size_t error_bytes)
{
    const char *advice = foreign_scene_of_name(path);
    if (status != 0 && advice == NULL) {
        advice = foreign_scene_of_start(path);
    }
    if (status != 0 && advice != NULL && access(path, R_OK) == 0) {
        (void)t3r_reason(error, error_bytes, "%s: %s", path, advice);
    }
    return status;
}

int scene_file_read(const char *path, int flags, scene_file *out, char *error, size_t error_bytes)
{
    return explained(scene_store_read(path, flags, &command, out, error, error_bytes), path, error, error_bytes);
}

int scene_file_take(const char *path, int flags, const scene_sink *sink, char *error, size_t error_bytes)
{
    return explained(scene_store_take(path, flags, &command, sink, error, error_bytes), path, error, error_bytes);
}

int scene_file_write(const char *path, const t3r_scene *scene, int flags, const char *note, char *error,
                     size_t error_bytes)
{
    const scene_file made = scene_store_scene(scene);
    return scene_store_write(path, &made, flags, note, &command, error, error_bytes);
}

int scene_file_convert(const char *from, const char *to, int flags, const scene_crop *crop, scene_conversion *out,
                       char *error, size_t error_bytes)
{
    return explained(scene_store_convert(from, to, flags, crop, &command, out, error, error_bytes), from, error,
                     error_bytes);
}
