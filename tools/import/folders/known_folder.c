/* SPDX-License-Identifier: Apache-2.0 */
#include "import/folders/known_folder.h"

#include <glob.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#define SIGNS 2
#define PATTERN_BYTES 8192
#define HOLE "DIR" /* in a remedy, stands for the folder */
#define IMPORT ", then trim3r import OUT -o REC.mcap"
#define PICTURES(folder) "trim3r import " folder " --poses estimate --intrinsics fx,fy,cx,cy -o REC.mcap"
#define PHOTOS(folder) "trim3r scene " folder " -o SCENE.ply, or trim3r import " folder " --poses estimate -o REC.mcap"
#define FILES "trim3r render, view and convert take one of its files, "

/* All kinds, the more special ones first. A folder is of a kind if it has entries for all its signs, which are patterns
 * of glob(). OUT stands for a new folder. */
static const struct known {
    const char *name, *signs[SIGNS], *remedy;
} kinds[] = {
    {"a scan of Polycam", {"keyframes/*cameras"}, "ns-process-data polycam --data DIR --output-dir OUT" IMPORT},
    {"a scan of Stray Scanner",
     {"odometry.csv", "rgb.mp4"},
     "ffmpeg -i DIR/rgb.mp4 OUT/%06d.png, then " PICTURES("OUT") " with the matrix in camera_matrix.csv"},
    {"a packed scan of Record3D", {"*.r3d"}, "unzip DIR/NAME.r3d -d OUT" IMPORT},
    {"a recording of Spectacular AI", {"data.jsonl", "calibration.json"}, "sai-cli process DIR OUT" IMPORT},
    {"a model of 3D Gaussian Splatting",
     {"point_cloud/iteration_*"},
     "trim3r render and view take its scene, DIR/point_cloud/iteration_N/point_cloud.ply, and render --path "
     "DIR/cameras.json draws its views"},
    {"a run of nerfstudio",
     {"config.yml", "nerfstudio_models"},
     "ns-export gaussian-splat --load-config DIR/config.yml --output-dir OUT writes a scene"},
    {"a scene of Blender",
     {"transforms_train.json"},
     "ln -s transforms_train.json DIR/transforms.json, then trim3r import DIR -o REC.mcap"},
    {"a scene of LLFF", {"poses_bounds.npy"}, PICTURES("DIR/images")},
    {"a sequence of EuRoC", {"mav0/cam0"}, PICTURES("DIR/mav0/cam0/data") " with those of cam0/sensor.yaml"},
    {"a sequence of KITTI", {"calib.txt", "image_2"}, PICTURES("DIR/image_2") " with those of P2 in calib.txt"},
    {"a packed scan of ScanNet",
     {"*.sens"},
     "python reader.py --filename DIR/NAME.sens --output_path OUT --export_color_images --export_depth_images "
     "--export_poses --export_intrinsics" IMPORT},
    {"a scan of ARKitScenes", {"lowres_wide.traj"}, PICTURES("DIR/lowres_wide") " with those of its .pincam files"},
    {"a recording of Aria",
     {"*.vrs"},
     "ns-process-data aria --vrs-file DIR/NAME.vrs --mps-data-dir MPS --output-dir OUT" IMPORT},
    {"a project of OpenDroneMap",
     {"opensfm/reconstruction.json"},
     "ns-process-data odm --data DIR --output-dir OUT" IMPORT},
    {"a project of OpenSfM", {"reconstruction.json"}, "opensfm export_colmap DIR, then trim3r import DIR -o REC.mcap"},
    {"a project of Metashape",
     {"*.psx"},
     "export its cameras as CAMERAS.xml, then ns-process-data metashape --data IMAGES --xml CAMERAS.xml --output-dir "
     "OUT" IMPORT},
    {"a project of COLMAP without a model",
     {"database.db"},
     "colmap mapper --database_path DIR/database.db --image_path DIR/images --output_path DIR/sparse, then trim3r "
     "import DIR -o REC.mcap"},
    {"a folder of pointmaps", {"*.npz"}, "beside their pictures, trim3r import DIR --pointmaps NAME.npz -o REC.mcap"},
    {"a folder of scenes, as Scaniverse exports them,", {"*.spz"}, FILES "DIR/NAME.spz"},
    {"a folder of scenes", {"*.ply"}, FILES "DIR/NAME.ply"},
    {"a folder of meshes", {"*.usdz"}, "export the scan's photos, or its Gaussians as .ply or .spz"},
    {"a folder with pictures in images", {"images/*.[jp]*g"}, PHOTOS("DIR/images")},
    {"a folder with pictures in rgb", {"rgb/*.[jp]*g"}, PHOTOS("DIR/rgb")},
};

static bool has(const char *directory, const char *sign)
{
    char pattern[PATTERN_BYTES];
    size_t length = 0;
    for (const char *c = directory; *c != '\0' && length < sizeof pattern - 2; c++) {
        if (strchr("*?[\\", *c) != NULL) {
            pattern[length++] = '\\';
        }
        pattern[length++] = *c;
    }
    const int more = snprintf(pattern + length, sizeof pattern - length, "/%s", sign);
    glob_t found;
    const bool matches =
        more > 0 && (size_t)more < sizeof pattern - length && glob(pattern, GLOB_NOSORT, NULL, &found) == 0;
    if (matches) {
        globfree(&found);
    }
    return matches;
}

static bool is_one(const char *directory, const struct known *kind)
{
    bool all = true;
    for (int i = 0; i < SIGNS && all && kind->signs[i] != NULL; i++) {
        all = has(directory, kind->signs[i]);
    }
    return all;
}

/* Writes the remedy with the folder's name. */
static void fill(const char *remedy, const char *directory, char *text, size_t bytes)
{
    size_t length = 0;
    for (const char *hole; (hole = strstr(remedy, HOLE)) != NULL && length < bytes; remedy = hole + strlen(HOLE)) {
        length += (size_t)snprintf(text + length, bytes - length, "%.*s%s", (int)(hole - remedy), remedy, directory);
    }
    if (length < bytes) {
        snprintf(text + length, bytes - length, "%s", remedy);
    }
}

const char *known_folder_advice(const char *directory, char *text, size_t bytes)
{
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++) {
        if (is_one(directory, &kinds[i])) {
            const int length = snprintf(text, bytes, "%s is not read as it is: ", kinds[i].name);
            fill(kinds[i].remedy, directory, text + length, bytes - (size_t)length);
            return text;
        }
    }
    return NULL;
}
