/* SPDX-License-Identifier: Apache-2.0 */
/* undistort_driver WIDTH HEIGHT KIND FX FY CX CY K1..K5: reads R, G, B planes from stdin, writes undistorted ones to
 * stdout. KIND 1 radial-tangential, 2 fisheye. For undistort_opencv.py. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "core/camera.h"
#include "image/undistort.h"

static int32_t fixed(const char *text, int bits)
{
    return (int32_t)lround(ldexp(atof(text), bits));
}

int main(int argc, char **argv)
{
    if (argc != 13) {
        return 2;
    }
    uint32_t width = (uint32_t)atoi(argv[1]), height = (uint32_t)atoi(argv[2]);
    t3r_camera camera = {width,
                         height,
                         fixed(argv[4], 16),
                         fixed(argv[5], 16),
                         fixed(argv[6], 16),
                         fixed(argv[7], 16),
                         (t3r_distortion)atoi(argv[3]),
                         {0},
                         {0},
                         {1 << 30, 0, 0, 0}};
    for (int i = 0; i < 5; i++) {
        camera.distortion_q24[i] = fixed(argv[8 + i], 24);
    }
    size_t pixels = (size_t)width * height;
    uint8_t *in = malloc(pixels * 3), *out = malloc(pixels * 3);
    int32_t *grid = malloc(T3R_GRID_VALUES(width, height) * sizeof *grid);
    int done = 0;
    if (in != NULL && out != NULL && grid != NULL && fread(in, 1, pixels * 3, stdin) == pixels * 3 &&
        t3r_camera_check(&camera, width, height) == T3R_OK &&
        t3r_undistort_grid(&camera, width, height, grid) == T3R_OK) {
        const uint8_t *const source[3] = {in, in + pixels, in + 2 * pixels};
        uint8_t *const target[3] = {out, out + pixels, out + 2 * pixels};
        t3r_undistort_colour(grid, width, height, 0, height, source, target);
        done = fwrite(out, 1, pixels * 3, stdout) == pixels * 3;
    }
    free(in);
    free(out);
    free(grid);
    return done ? 0 : 1;
}
