/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/files/csv_file.h"

#include <errno.h>
#include <string.h>
#include <sys/stat.h>

#include "cli/cli.h"
#include "cli/options/standard_output.h"

#define ERROR_BYTES 512

static bool has_rows(const char *path)
{
    struct stat about;
    return stat(path, &about) == 0 && S_ISREG(about.st_mode) && about.st_size > 0;
}

int csv_file_open(csv_file *file, const char *path, bool more, bool *is_new)
{
    *file = (csv_file){.path = path};
    const bool stands = has_rows(path);
    *is_new = !more || !stands;
    if ((stands && !more) || standard_output_is(path)) {
        char error[ERROR_BYTES] = "";
        if (whole_file_begin(&file->beside, path, error, sizeof error) != 0) {
            return cli_error(CLI_BAD_INPUT, "%s", error);
        }
        file->table.file = file->beside.stream;
        return CLI_OK;
    }
    file->table.file = fopen(path, more ? "a" : "w");
    return file->table.file != NULL ? CLI_OK : cli_error(CLI_BAD_INPUT, "%s: %s", path, strerror(errno));
}

int csv_file_close(csv_file *file, bool keep)
{
    FILE *stream = file->table.file;
    file->table.file = NULL;
    if (stream == NULL) {
        return CLI_OK;
    }
    if (file->beside.stream == NULL) {
        const bool failed = ferror(stream) != 0;
        return fclose(stream) != 0 || failed ? cli_error(CLI_BAD_INPUT, "%s: %s", file->path, strerror(errno)) : CLI_OK;
    }
    char error[ERROR_BYTES] = "";
    if (!keep) {
        t3r_whole_file_abandon(&file->beside);
        return CLI_OK;
    }
    return t3r_whole_file_commit(&file->beside, NULL, error, sizeof error) == 0 ? CLI_OK
                                                                                : cli_error(CLI_BAD_INPUT, "%s", error);
}
