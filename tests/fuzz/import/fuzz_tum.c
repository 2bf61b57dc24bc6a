/* SPDX-License-Identifier: Apache-2.0 */
/* rgb.txt, groundtruth.txt and depth.txt of a TUM RGB-D folder, separated by zero bytes: an error, or frames whose
 * poses are within the limits. No picture is opened. */
#define _GNU_SOURCE /* memfd_create() */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "fuzz/memory_file.h"
#include "import/folders/tum_rgbd.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static const char *const names[] = {"rgb.txt", "groundtruth.txt", "depth.txt"};
enum { LISTS = sizeof names / sizeof names[0] };

/* Makes lists as links in a folder of this process. */
static void make_folder(char folder[64], const uint8_t *data, size_t size, int descriptors[LISTS])
{
    snprintf(folder, 64, "%s/fuzz_tum.XXXXXX", P_tmpdir);
    if (mkdtemp(folder) == NULL) {
        abort();
    }
    for (int i = 0; i < LISTS; i++) {
        char target[MEMORY_FILE_PATH_BYTES], link[96];
        const uint8_t *end = i + 1 < LISTS && size > 0 ? memchr(data, 0, size) : NULL;
        size_t count = end != NULL ? (size_t)(end - data) : size;
        descriptors[i] = memory_file(data, count, target);
        snprintf(link, sizeof link, "%s/%s", folder, names[i]);
        if (symlink(target, link) != 0) {
            abort();
        }
        data += end != NULL ? count + 1 : count;
        size -= end != NULL ? count + 1 : count;
    }
}

static void remove_folder(const char *folder, const int descriptors[LISTS])
{
    for (int i = 0; i < LISTS; i++) {
        char link[96];
        snprintf(link, sizeof link, "%s/%s", folder, names[i]);
        unlink(link);
        close(descriptors[i]);
    }
    rmdir(folder);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static const double intrinsics[INTRINSICS_NUMBERS] = {40, 40, 8, 8};
    static const posed_folder_options with = {.intrinsics = intrinsics};
    char path[64], error[512] = "";
    int descriptors[LISTS];
    make_folder(path, data, size, descriptors);
    posed_folder folder;
    int status = tum_rgbd_read(path, &with, &folder, error, sizeof error);
    if ((status != 0) != (error[0] != '\0')) {
        abort();
    }
    for (uint32_t i = 0; status == 0 && i < folder.frame_count; i++) {
        const posed_frame *frame = &folder.frames[i];
        if (frame->image == NULL || !(fabs(frame->pose.position[0]) <= 1 << 30) || !isfinite(frame->pose.rotation[3])) {
            abort();
        }
    }
    posed_folder_close(&folder);
    remove_folder(path, descriptors);
    return 0;
}
