/* SPDX-License-Identifier: Apache-2.0 */
#include <stdio.h>

#include "reason.h"
#include "trim3r_host.h"
#include "whole_file.h"

t3r_status t3r_write_whole(const char *path, const void *bytes, size_t count, char *error, size_t error_bytes)
{
    t3r_whole_file file;
    if (t3r_whole_file_begin(&file, path, NULL, error, error_bytes) != 0) {
        return T3R_HOST_ERR_FILE;
    }
    (void)fwrite(bytes, 1, count, file.stream); /* the commit checks the stream */
    if (t3r_whole_file_commit(&file, NULL, error, error_bytes) != 0) {
        return T3R_HOST_ERR_FILE;
    }
    t3r_reason(error, error_bytes, "%s", "");
    return T3R_OK;
}
