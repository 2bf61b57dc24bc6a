/* SPDX-License-Identifier: Apache-2.0 */
#include "import/folders/reduced_pictures.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "import/frames/rejected.h"

#define PATH_BYTES 8192

/* Returns the path without "./"; the length of its first folder, 0: it has none. */
static const char *split(const char *image, size_t *folder_bytes)
{
    while (strncmp(image, "./", 2) == 0) {
        image += 2;
    }
    const char *slash = strchr(image, '/');
    *folder_bytes = slash != NULL ? (size_t)(slash - image) : 0;
    return image;
}

/* Makes the path of the picture in FOLDER_N. */
static void rename_picture(const char *image, size_t folder_bytes, uint32_t n, char path[PATH_BYTES])
{
    snprintf(path, PATH_BYTES, "%.*s_%u%s", (int)folder_bytes, image, n, image + folder_bytes);
}

/* Returns 2, 4 or 8 of the largest reduced folder with the picture; 0: none, or the folder itself is there. */
static uint32_t find(const char *directory, const char *image)
{
    static const uint32_t factors[] = {2, 4, 8};
    char path[PATH_BYTES];
    size_t folder_bytes;
    image = split(image, &folder_bytes);
    snprintf(path, sizeof path, "%.*s", (int)folder_bytes, image);
    for (size_t i = 0; i < sizeof factors / sizeof *factors && folder_bytes > 0 && !posed_exists(directory, path);
         i++) {
        char reduced[PATH_BYTES];
        rename_picture(image, folder_bytes, factors[i], reduced);
        if (posed_exists(directory, reduced)) {
            return factors[i];
        }
    }
    return 0;
}

/* Makes the frame's intrinsics those of a grid, which are scaled to its picture. */
static void scale(posed_frame *frame)
{
    posed_intrinsics *in = &frame->intrinsics;
    if (!(in->width > 0 && in->height > 0)) {
        rejected_mark(frame, "%s: w or h is missing: the size that the intrinsics are for", frame->image);
        return;
    }
    in->grid_width = in->width;
    in->grid_height = in->height;
    in->width = in->height = NAN;
}

void reduced_pictures_take(const char *directory, posed_folder *folder)
{
    const uint32_t n =
        folder->frame_count > 0 && folder->frames[0].image != NULL ? find(directory, folder->frames[0].image) : 0;
    char path[PATH_BYTES] = "";
    for (uint32_t i = 0; i < folder->frame_count && n > 0; i++) {
        posed_frame *frame = &folder->frames[i];
        size_t folder_bytes;
        const char *image = frame->image != NULL ? split(frame->image, &folder_bytes) : NULL;
        if (image == NULL || folder_bytes == 0) {
            continue;
        }
        rename_picture(image, folder_bytes, n, path);
        char *renamed = strdup(path);
        if (renamed == NULL) {
            rejected_mark(frame, "out of memory");
            continue;
        }
        free(frame->image);
        frame->image = renamed;
        scale(frame);
    }
    if (n > 0) {
        (void)text_list_add(&folder->remarks, "%.*s is read, with intrinsics scaled to its pictures",
                            (int)strcspn(path, "/"), path);
    }
}
