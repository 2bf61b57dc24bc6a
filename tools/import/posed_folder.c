#include "import/posed_folder.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "file_bytes.h"
#include "import/picture_folder.h"
#include "import/transforms_json.h"
#include "import/tum_rgbd.h"
#include "reader_limits.h"
#include "reason.h"

static bool exists(const char *directory, const char *name)
{
    char *path = posed_path(directory, name);
    bool found = path != NULL && access(path, F_OK) == 0;
    free(path);
    return found;
}

static int read_transforms(const char *directory, const posed_folder_options *options, posed_folder *out, char *error,
                           size_t error_bytes)
{
    char *path = posed_path(directory, "transforms.json");
    if (path == NULL) {
        return t3r_reason(error, error_bytes, "out of memory");
    }
    size_t bytes = 0;
    char reason[512];
    char *text = (char *)t3r_file_bytes(path, T3R_LIMIT_TEXT_BYTES, &bytes, error, error_bytes);
    int status = -1;
    if (text != NULL) {
        status = transforms_json_parse(text, bytes, options, out, reason, sizeof reason);
        if (status != 0) {
            t3r_reason(error, error_bytes, "%s: %s", path, reason);
        }
    }
    free(text);
    free(path);
    return status;
}

int posed_folder_open(const char *directory, const posed_folder_options *options, posed_folder *out, char *error,
                      size_t error_bytes)
{
    memset(out, 0, sizeof *out);
    if (!exists(directory, ".")) {
        return t3r_reason(error, error_bytes, "%s: %s", directory, errno == ENOTDIR ? "not a folder" : strerror(errno));
    }
    if (exists(directory, "transforms.json")) {
        if (options != NULL && options->intrinsics_count != 0) {
            return t3r_reason(error, error_bytes,
                              "%s/transforms.json: has its own intrinsics; --intrinsics is for folders without",
                              directory);
        }
        return read_transforms(directory, options, out, error, error_bytes);
    }
    if (exists(directory, "rgb.txt") || exists(directory, "groundtruth.txt")) {
        return tum_rgbd_read(directory, options, out, error, error_bytes);
    }
    if (options != NULL && options->without_poses) {
        return picture_folder_read(directory, options, out, error, error_bytes);
    }
    return t3r_reason(error, error_bytes,
                      "%s: neither transforms.json nor rgb.txt and groundtruth.txt (TUM RGB-D) is there", directory);
}
