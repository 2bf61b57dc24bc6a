/* SPDX-License-Identifier: Apache-2.0 */
/* Any bytes as a picture of a live camera: decoded, or a reason; the decoder goes on after either. */
#include <stdlib.h>

#include "capture/mjpeg.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    enum { SIDE = 16 };
    static t3r_mjpeg *decoder;
    uint8_t *rgb = malloc(SIDE * SIDE * 3);
    decoder = decoder != NULL ? decoder : t3r_mjpeg_open();
    const char *wrong = t3r_mjpeg_decode(decoder, data, size, SIDE, SIDE, rgb);
    if (wrong != NULL && wrong[0] == '\0') {
        abort();
    }
    free(rgb);
    return 0;
}
