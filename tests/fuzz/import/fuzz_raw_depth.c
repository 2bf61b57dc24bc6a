/* SPDX-License-Identifier: Apache-2.0 */
/* Any bytes as a file of float32 depth: an error, or samples of as many bytes as there are. */
#include <stdint.h>
#include <stdlib.h>

#include "import/depth/raw_depth.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    for (int kind = RAW_DEPTH_PLAIN; kind <= RAW_DEPTH_COLMAP; kind++) {
        const raw_depth raw = {.kind = (raw_depth_kind)kind, .width = 3, .height = 2, .unit = 0.001};
        picture depth = {0};
        char error[128] = "";
        if (raw_depth_parse(data, size, &raw, &depth, error, sizeof error) != 0) {
            if (error[0] == '\0' || depth.samples != NULL) {
                abort();
            }
            continue;
        }
        if ((size_t)depth.width * depth.height * 4 > size) {
            abort();
        }
        picture_free(&depth);
    }
    return 0;
}
