/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/files/foreign_scene.h"

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

#include "host/file_bytes.h"

#define START_BYTES 12u /* bytes that distinguish the kinds */

#define KSPLAT ".ksplat is not read; npx @playcanvas/splat-transform IN.ksplat OUT.ply makes .ply of it"
#define LCC ".lcc is not read; npx @playcanvas/splat-transform IN.lcc OUT.ply makes .ply of it"
#define GLTF ".gltf is not read; npx @gltf-transform/cli copy IN.gltf OUT.glb makes .glb of it"
#define CHECKPOINT                                                                                                     \
    "a checkpoint is not read; its trainer exports .ply, as nerfstudio does: "                                         \
    "ns-export gaussian-splat --load-config CONFIG.yml --output-dir FOLDER"
#define POINTS "a point cloud is not read, as it has no Gaussians; trim3r import and build make them of its pictures"
#define POINTMAPS                                                                                                      \
    "pointmaps, not a scene or a recording: trim3r import PHOTOS --pointmaps FILE.npz -o REC.mcap reads them with "    \
    "their pictures"
#define MESH "a mesh is not read, as it has no Gaussians; trim3r import and build make them of pictures of it"

static const struct {
    const char *suffix, *advice;
} kinds[] = {
    {".ksplat", KSPLAT},  {".lcc", LCC},       {".gltf", GLTF},  {".ckpt", CHECKPOINT}, {".pt", CHECKPOINT},
    {".pth", CHECKPOINT}, {".las", POINTS},    {".laz", POINTS}, {".pcd", POINTS},      {".e57", POINTS},
    {".xyz", POINTS},     {".obj", MESH},      {".fbx", MESH},   {".stl", MESH},        {".usdz", MESH},
    {".usd", MESH},       {".npz", POINTMAPS},
};

#define PHOTO "picture, not a scene: trim3r scene FOLDER -o SCENE.ply makes a scene of a folder of photos"
#define VIDEO "a video, not a scene: ffmpeg -i IN -vf fps=5 FOLDER/%05d.png, then trim3r scene FOLDER -o SCENE.ply"

/* Kinds by the bytes at a place, the more special ones first. */
static const struct {
    size_t at, bytes;
    const char *start, *advice;
} starts[] = {
    {0, 3, "\xff\xd8\xff", "a JPEG " PHOTO},
    {0, 4, "\x89PNG", "a PNG " PHOTO},
    {8, 4, "WEBP", "a WebP " PHOTO},
    {4, 7, "ftyphei", "a HEIC " PHOTO},
    {4, 8, "ftypmif1", "a HEIC " PHOTO},
    {4, 8, "ftypavif", "an AVIF " PHOTO},
    {4, 4, "ftyp", VIDEO},
    {0, 4, "\x1a\x45\xdf\xa3", VIDEO},
    {0, 8, "\x89MCAP0\r\n", "a recording, not a scene: trim3r scene REC.mcap -o SCENE.ply makes a scene of it"},
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

const char *foreign_scene_of_start(const char *path)
{
    uint8_t first[START_BYTES];
    FILE *file = t3r_file_open(path, NULL, 0);
    const size_t count = file != NULL ? fread(first, 1, sizeof first, file) : 0;
    if (file != NULL) {
        fclose(file);
    }
    for (size_t i = 0; i < sizeof starts / sizeof *starts; i++) {
        const size_t at = starts[i].at, bytes = starts[i].bytes;
        if (count >= at + bytes && memcmp(first + at, starts[i].start, bytes) == 0) {
            return starts[i].advice;
        }
    }
    return NULL;
}
