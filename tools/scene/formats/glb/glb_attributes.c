/* SPDX-License-Identifier: Apache-2.0 */
#include "scene/formats/glb/glb.h"

#include <inttypes.h>

const char *glb_attribute_name(uint32_t index, char name[GLB_NAME_BYTES])
{
    static const char *const names[] = {
        [GLB_POSITION] = "POSITION",
        [GLB_ROTATION] = GLB_EXTENSION ":ROTATION",
        [GLB_SCALE] = GLB_EXTENSION ":SCALE",
        [GLB_OPACITY] = GLB_EXTENSION ":OPACITY",
        [GLB_HARMONIC] = GLB_EXTENSION ":SH_DEGREE_0_COEF_0",
    };
    if (index < GLB_REST) {
        snprintf(name, GLB_NAME_BYTES, "%s", names[index]);
        return name;
    }
    uint32_t degree = 1;
    while (harmonics_rest(degree) <= index - GLB_REST) {
        degree++;
    }
    snprintf(name, GLB_NAME_BYTES, GLB_EXTENSION ":SH_DEGREE_%" PRIu32 "_COEF_%" PRIu32, degree,
             index - GLB_REST - harmonics_rest(degree - 1));
    return name;
}

uint32_t glb_components(uint32_t index)
{
    return index == GLB_ROTATION ? 4 : index == GLB_OPACITY ? 1 : 3;
}
