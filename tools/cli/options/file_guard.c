/* SPDX-License-Identifier: Apache-2.0 */
/* The state here is per process: the files of its command line. */
#include "cli/options/file_guard.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <unistd.h>

#include "cli/cli.h"
#include "cli/options/file_place.h"
#include "host/reason.h"
#include "recording/recording_folder.h"

#define STANDARD_OUTPUT "standard output"
/* The kinds that commands read in a folder: pictures, and files without a kind of their own (JSON, lists, pointmaps).
 * Recordings are read in folders of rosbag2 alone. No command reads scenes, pages or tables in a folder. */
#define READ_IN_FOLDERS (FILE_PICTURE | FILE_OTHER)

static struct {
    named_file *files;
    file_place *places; /* of each file */
    uint32_t count;
    bool force;
} guard;

static bool writes(const named_file *file)
{
    return (file->flags & OPTION_WRITES_BIT) != 0;
}

/* Whether a file is /dev/null or /dev/full, which lose nothing. */
static bool is_sink(const file_place *place)
{
    return S_ISCHR(place->mode) && major(place->special) == 1 &&
           (minor(place->special) == 3 || minor(place->special) == 7);
}

/* Reports a missing folder on the path by its name; words and devices are no paths. */
static int check_way(const named_file *file)
{
    int error;
    const size_t bytes = (file->flags & OPTION_OR_DEVICE) != 0 ? 0 : file_place_ends(file->path, &error);
    if (bytes == 0) {
        return CLI_OK;
    }
    if (error == ENOENT) {
        return cli_error(CLI_BAD_INPUT, "%s %s: there is no folder '%.*s'", file->option, file->path, (int)bytes,
                         file->path);
    }
    return cli_error(CLI_BAD_INPUT, "%s %s: %.*s: %s", file->option, file->path, (int)bytes, file->path,
                     strerror(error));
}

static int check_input(const named_file *file, const file_place *place)
{
    bool word = (file->flags & OPTION_OR_WORD) != 0 && file_kind_named(file->path) != FILE_WEIGHTS;
    bool folder = (file->flags & OPTION_FOLDER) != 0 && S_ISDIR(place->mode);
    if (place->mode == 0 || S_ISREG(place->mode) || folder || word || (file->flags & OPTION_OR_DEVICE) != 0) {
        return CLI_OK;
    }
    return cli_error(CLI_BAD_INPUT, "%s: %s", file->path,
                     S_ISDIR(place->mode) ? "Is a directory" : "not a regular file");
}

static int check_output(const named_file *file, const file_place *place)
{
    if (file_place_dangles(file->path)) {
        return cli_error(CLI_BAD_INPUT, "%s: a symbolic link to nothing", file->path);
    }
    bool folder = (file->flags & OPTION_FOLDER) != 0;
    if (place->mode == 0 || is_sink(place) || (folder ? S_ISDIR(place->mode) : S_ISREG(place->mode))) {
        return CLI_OK;
    }
    return cli_error(CLI_BAD_INPUT, "%s: not a %s", file->path, folder ? "folder" : "regular file");
}

/* Returns the input folder that holds the file, if files of that kind may be read there; NULL = none. */
static const named_file *folder_of(const char *path, file_kind found)
{
    for (uint32_t i = 0; i < guard.count; i++) {
        const named_file *file = &guard.files[i];
        if (!writes(file) && file_place_beneath(path, &guard.places[i]) &&
            ((found & READ_IN_FOLDERS) != 0 || (found == FILE_RECORDING && t3r_recording_is_folder(file->path)))) {
            return file;
        }
    }
    return NULL;
}

/* Refuses an output whose suffix promises another kind than the one that is written. */
static int check_name(const named_file *file)
{
    const file_kind named = file_kind_named(file->path), wanted = OPTION_KINDS(file->flags);
    if (named == 0 || wanted == 0 || (named & wanted) != 0 || (file->flags & OPTION_FOLDER) != 0 || guard.force) {
        return CLI_OK;
    }
    file_kind one = (file_kind)(wanted & (0u - wanted)); /* the first of them */
    return cli_error(CLI_BAD_USAGE, "%s %s: what is written is %s, and the name is that of %s; --force writes it",
                     file->option, file->path, file_kind_name(one), file_kind_name(named));
}

/* Checks an output against the regular file of kind `found` that is there. */
static int check_kind(const named_file *file, file_kind found)
{
    const named_file *folder = folder_of(file->path, found);
    if (folder != NULL) {
        return cli_error(CLI_BAD_USAGE, "%s %s lies in %s %s, which is read: it would be overwritten", file->option,
                         file->path, folder->option, folder->path);
    }
    file_kind wanted = OPTION_KINDS(file->flags);
    if (found == 0 || (found & wanted) != 0 || guard.force) {
        return CLI_OK;
    }
    file_kind one = (file_kind)(wanted & (0u - wanted)); /* the first of them */
    return cli_error(CLI_BAD_USAGE, "%s %s: what is there is %s, not %s; --force replaces it", file->option, file->path,
                     file_kind_name(found), file_kind_name(one));
}

static int check_pair(const named_file *output, const named_file *other)
{
    return cli_error(CLI_BAD_USAGE, "%s %s and %s%s%s are one file: it would be %s", output->option, output->path,
                     other->option, *other->path == 0 ? "" : " ", other->path,
                     writes(other) ? "written twice" : "overwritten");
}

static bool share(uint32_t a, uint32_t b)
{
    return file_place_same(&guard.places[a], &guard.places[b]) && !is_sink(&guard.places[a]);
}

static int check_pairs(uint32_t output)
{
    for (uint32_t i = 0; i < guard.count; i++) {
        if (i != output && share(output, i) && (!writes(&guard.files[i]) || i < output)) {
            return check_pair(&guard.files[output], &guard.files[i]);
        }
    }
    struct stat printed;
    const file_place *place = &guard.places[output];
    if (fstat(STDOUT_FILENO, &printed) == 0 && S_ISREG(printed.st_mode) && place->mode != 0 &&
        printed.st_dev == place->device && printed.st_ino == place->inode) {
        return check_pair(&guard.files[output],
                          &(named_file){.option = STANDARD_OUTPUT, .path = "", .flags = OPTION_WRITES_BIT});
    }
    return CLI_OK;
}

int file_guard_find(void)
{
    const int named_otherwise = OPTION_OR_WORD | OPTION_OR_DEVICE;
    for (uint32_t i = 0; i < guard.count; i++) {
        const named_file *file = &guard.files[i];
        const bool is_path = *file->path != '\0' && (file->flags & named_otherwise) == 0;
        struct stat there;
        if (!writes(file) && is_path && (file->flags & OPTION_LATER) == 0 && stat(file->path, &there) != 0) {
            return cli_error(CLI_BAD_INPUT, "%s: %s", file->path, strerror(errno));
        }
    }
    return CLI_OK;
}

int file_guard_begin(named_file *files, uint32_t count, bool force)
{
    guard.files = files;
    guard.force = force;
    guard.places = calloc(count + 1, sizeof *guard.places);
    if (guard.places == NULL) {
        return cli_error(CLI_BAD_INPUT, "out of memory");
    }
    for (guard.count = 0; guard.count < count; guard.count++) {
        guard.places[guard.count] = file_place_of(files[guard.count].path);
    }
    int code = CLI_OK;
    for (uint32_t i = 0; i < count && code == CLI_OK; i++) {
        code = writes(&files[i]) ? check_pairs(i) : CLI_OK;
    }
    for (uint32_t i = 0; i < count && code == CLI_OK; i++) {
        code = check_way(&files[i]);
    }
    for (uint32_t i = 0; i < count && code == CLI_OK; i++) {
        code = writes(&files[i]) ? check_name(&files[i]) : CLI_OK;
    }
    for (uint32_t i = 0; i < count && code == CLI_OK; i++) {
        code = writes(&files[i]) ? check_output(&files[i], &guard.places[i]) : check_input(&files[i], &guard.places[i]);
    }
    for (uint32_t i = 0; i < count && code == CLI_OK; i++) {
        if (writes(&files[i]) && S_ISREG(guard.places[i].mode)) {
            code = check_kind(&files[i], file_kind_of(files[i].path));
        }
    }
    return code;
}

/* Returns the output with exactly this path; NULL = the path was derived from an output. */
static const named_file *output_of(const char *path)
{
    for (uint32_t i = 0; i < guard.count; i++) {
        if (writes(&guard.files[i]) && strcmp(guard.files[i].path, path) == 0) {
            return &guard.files[i];
        }
    }
    return NULL;
}

int file_guard_write(const char *path, char *error, size_t error_bytes)
{
    file_place place = file_place_of(path);
    const named_file *named = output_of(path);
    for (uint32_t i = 0; i < guard.count && !is_sink(&place); i++) {
        const named_file *other = &guard.files[i];
        /* looked up now: a file that was missing at the start may exist by now */
        file_place now = file_place_of(other->path);
        if (other != named && file_place_same(&place, &now)) {
            return t3r_reason(error, error_bytes, "%s: is %s %s, too: it is not overwritten", path, other->option,
                              other->path);
        }
    }
    if (named != NULL || !S_ISREG(place.mode)) {
        return 0;
    }
    file_kind found = file_kind_of(path), wanted = file_kind_named(path);
    const named_file *folder = folder_of(path, found);
    if (folder != NULL) {
        return t3r_reason(error, error_bytes, "%s: lies in %s %s, which is read: it is not overwritten", path,
                          folder->option, folder->path);
    }
    if (found != 0 && wanted != 0 && found != wanted && !guard.force) {
        return t3r_reason(error, error_bytes, "%s: what is there is %s, not %s; --force replaces it", path,
                          file_kind_name(found), file_kind_name(wanted));
    }
    return 0;
}
