/* SPDX-License-Identifier: Apache-2.0 */
#include "import/import_source.h"

#include <stddef.h>
#include <stdio.h>
#include <sys/stat.h>

#include "host/file_bytes.h"
#include "pictures/foreign_file.h"
#include "recording/recording_folder.h"

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
    return *advice == NULL ? IMPORT_RECORDING : IMPORT_FOREIGN;
}
