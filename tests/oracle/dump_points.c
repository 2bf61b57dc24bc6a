/* SPDX-License-Identifier: Apache-2.0 */
/* The pointmap of two frames of a recording, in double, as raw float32 N x 6: xyz from the first camera over the median
 * depth, rgb over 255. Usage: dump_points REC.mcap A B OUT.f32 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "oracle/float64/oracle_analysis.h"
#include "recording/recording.h"

static int compare(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return x < y ? -1 : x > y;
}

static uint32_t depth_at(const t3r_frame *f, uint32_t x, uint32_t y)
{
    const uint8_t *p = f->depth + (size_t)y * f->depth_stride_bytes + (size_t)x * 2;
    return p[0] | (uint32_t)p[1] << 8;
}

int main(int argc, char **argv)
{
    char error[256] = "usage: dump_points REC.mcap A B OUT.f32";
    t3r_recording *recording = argc == 5 ? t3r_recording_open(argv[1], error, sizeof error) : NULL;
    FILE *out = recording == NULL ? NULL : fopen(argv[4], "wb");
    if (out == NULL) {
        fprintf(stderr, "dump_points: %s\n", error);
        return 1;
    }
    t3r_capture_frame frames[2];
    size_t most = 0, count = 0;
    for (int i = 0; i < 2; i++) {
        uint32_t index = (uint32_t)strtoul(argv[2 + i], NULL, 10);
        if (t3r_recording_frame(recording, index, &frames[i], error, sizeof error) != T3R_CAPTURE_FRAME ||
            frames[i].frame.depth == NULL || frames[i].frame.format != T3R_PIXEL_RGB24 ||
            frames[i].frame.depth_width != frames[i].frame.width) {
            fprintf(stderr, "dump_points: frame %u: RGB24 with depth of the same size is wanted %s\n", index, error);
            return 1;
        }
        most += (size_t)frames[i].frame.width * frames[i].frame.height;
    }
    double *points = malloc(most * ORACLE_DIMENSIONS * sizeof *points), *depths = malloc(most * sizeof *depths);
    if (points == NULL || depths == NULL) {
        return 1;
    }
    t3r_scene_frame origin = {{0}, 0};
    for (int k = 0; k < 3; k++) {
        origin.origin_q32[k] = frames[0].camera.position_q32[k];
    }
    for (int i = 0; i < 2; i++) {
        const t3r_frame *f = &frames[i].frame;
        oracle_camera camera = oracle_camera_from_t3r(&frames[i].camera, &origin, f->width, f->height);
        for (uint32_t y = 0; y < f->height; y++) {
            for (uint32_t x = 0; x < f->width; x++) {
                double z = depth_at(f, x, y) * ldexp((double)f->depth_unit_q40, -40);
                const uint8_t *rgb = f->planes[0] + (size_t)y * f->stride_bytes[0] + (size_t)x * 3;
                if (z > 0) {
                    oracle_unproject(&camera, x, y, z, &points[count * ORACLE_DIMENSIONS]);
                    for (size_t c = 0; c < 3; c++) {
                        points[count * ORACLE_DIMENSIONS + 3 + c] = rgb[c] / 255.0;
                    }
                    depths[count++] = z;
                }
            }
        }
    }
    qsort(depths, count, sizeof *depths, compare);
    const double median = count == 0 ? 1 : depths[count / 2];
    for (size_t i = 0; i < count * ORACLE_DIMENSIONS; i++) {
        float value = (float)(i % ORACLE_DIMENSIONS < 3 ? points[i] / median : points[i]);
        (void)fwrite(&value, sizeof value, 1, out);
    }
    free(points);
    free(depths);
    t3r_recording_close(recording);
    return fclose(out) == 0 ? 0 : 1;
}
