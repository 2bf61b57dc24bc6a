/* SPDX-License-Identifier: Apache-2.0 */
/* wavelet_driver WIDTH HEIGHT LEVELS: reads R, G, B planes from stdin, writes db2's periodized texture (uint16, host
 * order) to stdout. For wavelet_pywavelets.py. */
#include <stdio.h>
#include <stdlib.h>

#include "wavelet_planes.h"

int main(int argc, char **argv)
{
    if (argc != 4) {
        return 2;
    }
    uint32_t width = (uint32_t)atoi(argv[1]), height = (uint32_t)atoi(argv[2]), levels = (uint32_t)atoi(argv[3]);
    size_t pixels = (size_t)width * height;
    uint8_t *colour = malloc(pixels * 3);
    uint16_t *texture = malloc(pixels * sizeof *texture);
    int done = 0;
    if (colour != NULL && texture != NULL && fread(colour, 1, pixels * 3, stdin) == pixels * 3) {
        const uint8_t *const planes[3] = {colour, colour + pixels, colour + 2 * pixels};
        wavelet_texture_wrapped(planes, width, height, levels, T3R_WAVELET_DB2, texture);
        done = fwrite(texture, sizeof *texture, pixels, stdout) == pixels;
    }
    free(colour);
    free(texture);
    return done ? 0 : 1;
}
