/* SPDX-License-Identifier: Apache-2.0 */
#include "scene/formats/glb/glb.h"

#include "scene/scene_format.h"

const scene_format scene_format_glb = {.suffix = ".glb",
                                       .magic = GLB_MAGIC,
                                       .axes = SCENE_AXES_LUF,
                                       .degree = 3,
                                       .holds_origin = true,
                                       .parse = glb_parse,
                                       .write = glb_write};
