/* SPDX-License-Identifier: Apache-2.0 */
#include "import/folders/posed_folder.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "host/file_bytes.h"
#include "host/reason.h"
#include "import/colmap/colmap_folder.h"
#include "import/depth/exr_depth.h"
#include "import/folders/known_folder.h"
#include "import/folders/pose_files.h"
#include "import/folders/record3d.h"
#include "import/folders/reduced_pictures.h"
#include "import/folders/transforms_json.h"
#include "import/folders/tum_rgbd.h"
#include "import/frames/picture_folder.h"
#include "import/frames/rejected.h"
#include "mcap/reader_limits.h"

#define ERROR_BYTES 1024

static bool has_transforms(const char *directory)
{
    return posed_exists(directory, "transforms.json");
}

static bool has_tum_lists(const char *directory)
{
    return posed_exists(directory, "rgb.txt") || posed_exists(directory, "groundtruth.txt");
}

static int read_transforms(const char *directory, const posed_folder_options *options, posed_folder *out, char *error,
                           size_t error_bytes)
{
    if (options != NULL && options->intrinsics != NULL) {
        return t3r_reason(error, error_bytes,
                          "%s/transforms.json: has its own intrinsics; --intrinsics is for folders without", directory);
    }
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

/* All kinds of folder, in the order in which they are tried. */
static const struct folder_kind {
    const char *name;
    bool lens_given; /* its lens may come from the command line */
    bool (*is)(const char *directory);
    int (*read)(const char *directory, const posed_folder_options *options, posed_folder *out, char *error,
                size_t error_bytes);
} kinds[] = {
    {"transforms.json", false, has_transforms, read_transforms}, {"TUM RGB-D", true, has_tum_lists, tum_rgbd_read},
    {"COLMAP", false, colmap_folder_is, colmap_folder_read},     {"Record3D", false, record3d_is, record3d_read},
    {"pose files", true, pose_files_are_there, pose_files_read},
};

/* Marks depth that is OpenEXR, which folders of any kind may name. */
static void mark_exr(posed_folder *folder)
{
    const double length = folder->exr_length != 0 ? folder->exr_length : 1;
    for (uint32_t i = 0; i < folder->frame_count; i++) {
        posed_frame *frame = &folder->frames[i];
        if (frame->depth != NULL && exr_depth_is(frame->depth)) {
            frame->depth_raw = (raw_depth){.kind = RAW_DEPTH_EXR, .unit = folder->depth_unit / length};
            frame->no_depth = 0; /* floats have their own markers of missing depth */
        }
    }
}

/* Remarks on folders of masks and confidence, which only the fields of transforms.json name. */
static void tell_unread(const char *directory, posed_folder *folder)
{
    static const char *const names[] = {"mask", "masks", "confidence", "conf"};
    bool named = false;
    for (uint32_t i = 0; i < folder->frame_count && !named; i++) {
        named = folder->frames[i].mask != NULL || folder->frames[i].confidence != NULL;
    }
    for (size_t i = 0; i < sizeof names / sizeof *names && !named; i++) {
        if (posed_exists(directory, names[i])) {
            (void)text_list_add(&folder->remarks, "%s: this folder is not read%s", names[i],
                                names[i][0] == 'm' ? "; mask_path of a frame in transforms.json is" : "");
        }
    }
}

static int drop_rejected(const char *directory, posed_folder *folder, char *error, size_t error_bytes)
{
    char reason[ERROR_BYTES];
    return rejected_drop(folder, reason, sizeof reason) == 0
               ? 0
               : t3r_reason(error, error_bytes, "%s: %s: %s", directory, folder->kind, reason);
}

static const struct folder_kind *kind_of(const char *directory)
{
    const struct folder_kind *kind = NULL;
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds && kind == NULL; i++) {
        kind = kinds[i].is(directory) ? &kinds[i] : NULL;
    }
    return kind;
}

posed_folder_options posed_folder_look(const char *directory)
{
    const struct folder_kind *kind = kind_of(directory);
    return (posed_folder_options){.without_poses = kind == NULL,
                                  .without_intrinsics = kind == NULL || kind->lens_given};
}

/* Writes what a folder without pictures holds, and what makes a recording of that. False: nothing that is known. */
static bool name_what_is_there(const char *directory, char *error, size_t error_bytes)
{
    char advice[ERROR_BYTES];
    if (known_folder_advice(directory, advice, sizeof advice) != NULL) {
        (void)t3r_reason(error, error_bytes, "%s: %s", directory, advice);
        return true;
    }
    char *below = picture_folder_below(directory);
    if (below == NULL) {
        return false;
    }
    (void)t3r_reason(error, error_bytes, "%s: no pictures, but %s has some: name that folder", directory, below);
    free(below);
    return true;
}

int posed_folder_open(const char *directory, const posed_folder_options *options, posed_folder *out, char *error,
                      size_t error_bytes)
{
    memset(out, 0, sizeof *out);
    if (!posed_exists(directory, ".")) {
        return t3r_reason(error, error_bytes, "%s: %s", directory, errno == ENOTDIR ? "not a folder" : strerror(errno));
    }
    const struct folder_kind *kind = kind_of(directory);
    if (kind != NULL) {
        const int status = kind->read(directory, options, out, error, error_bytes);
        out->kind = kind->name;
        mark_exr(out);
        tell_unread(directory, out);
        reduced_pictures_take(directory, out);
        return status == 0 ? drop_rejected(directory, out, error, error_bytes) : status;
    }
    char *bag = picture_folder_bag(directory);
    if (bag != NULL) {
        (void)t3r_reason(
            error, error_bytes,
            "%s: holds bags, such as %s, but no metadata.yaml: name one of them; ros2 bag reindex %s writes "
            "that list",
            directory, bag, directory);
        free(bag);
        return -1;
    }
    if (posed_exists(directory, "meta.json")) {
        return t3r_reason(error, error_bytes, "%s: an unpacked .sog; it is a scene once its files are zipped",
                          directory);
    }
    if (!picture_folder_is(directory) && name_what_is_there(directory, error, error_bytes)) {
        return -1;
    }
    if (options != NULL && options->without_poses) {
        return picture_folder_read(directory, options, out, error, error_bytes);
    }
    if (picture_folder_is(directory)) {
        return t3r_reason(error, error_bytes,
                          "%s: pictures without poses: --poses estimate finds them, or trim3r scene makes a scene at "
                          "once: trim3r scene %s -o scene.ply",
                          directory, directory);
    }
    if (picture_folder_foreign(directory, &out->left_out) == 0 && out->left_out.frames.count > 0) {
        return t3r_reason(error, error_bytes, "%s: no poses, and %s", directory, out->left_out.frames.lines[0]);
    }
    return t3r_reason(
        error, error_bytes,
        "%s: neither transforms.json nor rgb.txt and groundtruth.txt (TUM RGB-D) nor a model of COLMAP nor poses as "
        "texts (ScanNet, 7-Scenes) are there",
        directory);
}
