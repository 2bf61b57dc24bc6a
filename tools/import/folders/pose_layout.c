/* SPDX-License-Identifier: Apache-2.0 */
#include "import/folders/pose_layout.h"

#include <dirent.h>
#include <stdio.h>
#include <string.h>

#include "import/frames/posed_frame.h"

#define PATH_BYTES 1024
#define NAMES(...) ((const char *const[]){__VA_ARGS__, NULL})

/* Exports of ScanNet and similar folders. */
static const pose_layout folders = {
    .poses = NAMES("pose", "poses"),
    .colours = NAMES("color", "colour", "rgb", "image", "images"),
    .depths = NAMES("depth", "depths"),
    .pose_ending = ".txt",
    .colour_endings = NAMES(".jpg", ".png", ".jpeg"),
    .depth_endings = NAMES(".png", ".exr"),
    .colour_lenses = NAMES("intrinsic/intrinsic_color.txt", "intrinsic/intrinsic.txt", "intrinsic_color.txt",
                           "intrinsics.txt", "intrinsic.txt", "camera-intrinsics.txt"),
    .depth_lenses = NAMES("intrinsic/intrinsic_depth.txt", "intrinsic_depth.txt"),
    .lens_hint = "no intrinsic/intrinsic_color.txt; give --intrinsics " INTRINSICS_FORM,
};

/* 7-Scenes and 3DMatch: all files of a sequence in one folder. */
static const pose_layout flat = {
    .poses = NAMES("."),
    .colours = NAMES("."),
    .depths = NAMES("."),
    .pose_ending = ".pose.txt",
    .colour_endings = NAMES(".color.png", ".color.jpg"),
    .depth_endings = NAMES(".depth.png", ".depth.exr"),
    .colour_lenses = NAMES("camera-intrinsics.txt", "intrinsics.txt", "../camera-intrinsics.txt"),
    .depth_lenses = (const char *const[]){NULL},
    .no_depth = UINT16_MAX,
    .lens_hint = "no camera-intrinsics.txt; give --intrinsics fx,fy,cx,cy, which are 585,585,320,240 for 7-Scenes",
};

const char *pose_layout_first(const char *directory, const char *const *names)
{
    while (*names != NULL && !posed_exists(directory, *names)) {
        names++;
    }
    return *names;
}

char *pose_layout_find(const char *directory, const char *const *places, const char *stem, const char *const *endings)
{
    for (; *places != NULL; places++) {
        for (const char *const *ending = endings; *ending != NULL; ending++) {
            char path[PATH_BYTES];
            const bool here = strcmp(*places, ".") == 0;
            snprintf(path, sizeof path, "%s%s%s%s", here ? "" : *places, here ? "" : "/", stem, *ending);
            if (posed_exists(directory, path)) {
                return strdup(path);
            }
        }
    }
    return NULL;
}

bool pose_layout_is_pose(const pose_layout *layout, const char *name)
{
    const size_t length = strlen(name), ending = strlen(layout->pose_ending);
    return name[0] != '.' && length > ending && strcmp(name + length - ending, layout->pose_ending) == 0;
}

static bool holds_flat_poses(const char *directory)
{
    DIR *all = opendir(directory);
    struct dirent *entry;
    bool found = false;
    while (all != NULL && !found && (entry = readdir(all)) != NULL) {
        found = pose_layout_is_pose(&flat, entry->d_name);
    }
    if (all != NULL) {
        closedir(all);
    }
    return found;
}

const pose_layout *pose_layout_of(const char *directory)
{
    if (pose_layout_first(directory, folders.poses) != NULL && pose_layout_first(directory, folders.colours) != NULL) {
        return &folders;
    }
    return holds_flat_poses(directory) ? &flat : NULL;
}
