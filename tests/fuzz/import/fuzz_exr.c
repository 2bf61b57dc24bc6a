/* SPDX-License-Identifier: Apache-2.0 */
/* Any bytes as OpenEXR depth: an error, or samples of the size in the header. */
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "import/depth/exr_depth.h"
#include "trim3r.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char error[512] = "";
    picture depth = {0};
    const int status = exr_depth_parse(data, size, 0.001, &depth, error, sizeof error);
    if ((status != 0) != (error[0] != '\0') || (status != 0) != (depth.samples == NULL)) {
        abort();
    }
    if (status == 0) {
        const size_t bytes = (size_t)depth.width * depth.height * sizeof(uint16_t);
        if (depth.width > T3R_MAX_SIDE || depth.height > T3R_MAX_SIDE) {
            abort();
        }
        void *copy = malloc(bytes);
        memcpy(copy, depth.samples, bytes); /* all of them are readable */
        free(copy);
    }
    picture_free(&depth);
    return 0;
}
