/* SPDX-License-Identifier: Apache-2.0 */
/* .glb for a page, which reads it and does not write it. */
#include "scene/formats/glb/glb.h"
#include "scene/scene_format.h"

const scene_format scene_format_glb_bare = {.suffix = ".glb", .magic = GLB_MAGIC, .parse = glb_parse};
