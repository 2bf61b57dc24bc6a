/* SPDX-License-Identifier: Apache-2.0 */
/* Any bytes as a .glb (scene_bytes.h). */
#include "scene_bytes.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    return fuzz_scene("scene.glb", data, size);
}
