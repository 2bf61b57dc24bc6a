/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/files/whole_file.h"

#include <errno.h>
#include <string.h>

#include "cli/files/part_files.h"
#include "cli/options/file_guard.h"
#include "cli/options/standard_output.h"
#include "host/reason.h"

#define NAME "standard output"

int whole_file_begin(t3r_whole_file *file, const char *path, char *error, size_t error_bytes)
{
    static const t3r_part_list parts = {part_files_add, part_files_forget};
    if (standard_output_is(path)) {
        *file = (t3r_whole_file){.path = NAME, .stream = standard_output_open()};
        return file->stream != NULL ? 0 : t3r_reason(error, error_bytes, NAME ": %s", strerror(errno));
    }
    return file_guard_write(path, error, error_bytes) == 0
               ? t3r_whole_file_begin(file, path, &parts, error, error_bytes)
               : -1;
}
