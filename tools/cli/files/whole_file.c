/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/files/whole_file.h"

#include "cli/files/part_files.h"
#include "cli/options/file_guard.h"

int whole_file_begin(t3r_whole_file *file, const char *path, char *error, size_t error_bytes)
{
    static const t3r_part_list parts = {part_files_add, part_files_forget};
    return file_guard_write(path, error, error_bytes) == 0
               ? t3r_whole_file_begin(file, path, &parts, error, error_bytes)
               : -1;
}
