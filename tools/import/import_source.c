/* SPDX-License-Identifier: Apache-2.0 */
#include "import/import_source.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>
#include <sys/stat.h>

#include "cli/cli.h"
#include "cli/files/foreign_scene.h"
#include "cli/options/file_kind.h"
#include "host/file_bytes.h"
#include "host/reason.h"
#include "import/folders/posed_folder.h"
#include "pictures/foreign_file.h"
#include "recording/recording_folder.h"

#define ERROR_BYTES 1024

import_source import_source_of(const char *path, const char **advice)
{
    struct stat about;
    if (stat(path, &about) != 0 || !S_ISREG(about.st_mode)) {
        return t3r_recording_is_folder(path) ? IMPORT_RECORDING : IMPORT_FOLDER;
    }
    uint8_t bytes[FOREIGN_FILE_BYTES];
    FILE *file = t3r_file_open(path, NULL, 0);
    const size_t count = file != NULL ? fread(bytes, 1, sizeof bytes, file) : 0;
    if (file != NULL) {
        fclose(file);
    }
    *advice = foreign_file_of_bytes(bytes, count);
    if (*advice == NULL && file_kind_of(path) != FILE_RECORDING) {
        *advice = foreign_scene_of_name(path);
    }
    return *advice == NULL ? IMPORT_RECORDING : IMPORT_FOREIGN;
}

/* Names the folder's kind and the command that makes a recording of it, or why import refuses it. */
static void explain_folder(const char *path, char *text, size_t bytes)
{
    char reason[ERROR_BYTES];
    posed_folder folder;
    const posed_folder_options options = posed_folder_look(path);
    if (posed_folder_open(path, &options, &folder, reason, sizeof reason) == 0) {
        (void)t3r_reason(text, bytes,
                         "%s: a folder (%s); first make a recording of it: trim3r import %s%s -o NAME.mcap", path,
                         folder.kind, path, options.without_poses ? " --poses estimate" : "");
    } else {
        (void)t3r_reason(text, bytes, "%s", reason);
    }
    posed_folder_close(&folder);
}

static bool is_directory(const char *path)
{
    struct stat about;
    return stat(path, &about) == 0 && S_ISDIR(about.st_mode);
}

t3r_recording *import_source_open(const char *path)
{
    char error[2 * ERROR_BYTES] = "";
    const char *advice;
    const import_source source = import_source_of(path, &advice);
    t3r_recording *recording = NULL;
    if (source == IMPORT_FOREIGN) {
        (void)t3r_reason(error, sizeof error, "%s: %s", path, advice);
    } else if (source == IMPORT_FOLDER && is_directory(path)) {
        explain_folder(path, error, sizeof error);
    } else {
        recording = t3r_recording_open(path, error, sizeof error);
    }
    if (recording == NULL) {
        (void)cli_error(CLI_BAD_INPUT, "%s", error);
    }
    return recording;
}
