/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/files/foreign_scene.h"

#include <stddef.h>
#include <string.h>
#include <strings.h>

#define KSPLAT ".ksplat is not read; npx @playcanvas/splat-transform IN.ksplat OUT.ply makes .ply of it"
#define LCC ".lcc is not read; npx @playcanvas/splat-transform IN.lcc OUT.ply makes .ply of it"
#define GLTF ".gltf is not read; npx @gltf-transform/cli copy IN.gltf OUT.glb makes .glb of it"
#define CHECKPOINT                                                                                                     \
    "a checkpoint is not read; its trainer exports .ply, as nerfstudio does: "                                         \
    "ns-export gaussian-splat --load-config CONFIG.yml --output-dir FOLDER"
#define POINTS "a point cloud is not read, as it has no Gaussians; trim3r import and build make them of its pictures"
#define MESH "a mesh is not read, as it has no Gaussians; trim3r import and build make them of pictures of it"

static const struct {
    const char *suffix, *advice;
} kinds[] = {
    {".ksplat", KSPLAT}, {".lcc", LCC},        {".gltf", GLTF},  {".ckpt", CHECKPOINT},
    {".pt", CHECKPOINT}, {".pth", CHECKPOINT}, {".las", POINTS}, {".laz", POINTS},
    {".pcd", POINTS},    {".e57", POINTS},     {".xyz", POINTS}, {".obj", MESH},
    {".fbx", MESH},      {".stl", MESH},       {".usdz", MESH},  {".usd", MESH},
};

const char *foreign_scene_of_name(const char *path)
{
    const char *dot = strrchr(path, '.');
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds && dot != NULL; i++) {
        if (strcasecmp(dot, kinds[i].suffix) == 0) {
            return kinds[i].advice;
        }
    }
    return NULL;
}
