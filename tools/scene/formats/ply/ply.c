/* SPDX-License-Identifier: Apache-2.0 */
#include "scene/formats/ply/ply.h"

#include "scene/scene_format.h"

const scene_format scene_format_ply = {
    .suffix = ".ply",
    .magic = "ply",
    .foreign = "byte 0: not a .ply file, nor another scene (an unpacked .sog is read once its files are zipped)",
    .degree = 3,
    .holds_origin = true,
    .holds_mip = true,
    .holds_backdrop = true,
    .parse = ply_parse,
    .write = ply_write,
};
