/* SPDX-License-Identifier: Apache-2.0 */
#include "procedural_scene.h"

#include <stdlib.h>
#include <string.h>

bool poster_draw(poster *made, const atlas *shared, uint64_t seed)
{
    size_t texels = (size_t)POSTER_SIDE * POSTER_SIDE;
    made->rgb = malloc(2 * texels * 3 * sizeof *made->rgb);
    uint8_t *image = malloc(texels * 3);
    float *depth = malloc(texels * sizeof *depth);
    bool good =
        made->rgb && image && depth && procedural_leaves(shared, seed, POSTER_SIDE, POSTER_SIDE, image, depth) == 0;
    if (good) {
        for (size_t i = 0; i < 3 * texels; i++) {
            float x = (float)image[i] * (1.0f / 255.0f);
            made->rgb[i] = 0.01f + 0.8f * x * x;
        }
        const float *from = made->rgb;
        float *to = made->rgb + 3 * texels;
        for (int side = POSTER_SIDE / 2; side >= 5; side /= 2) {
            for (int y = 0; y < side; y++) {
                for (int i = 0; i < 3 * side; i++) {
                    const float *p = from + (2 * y) * 6 * side + 6 * (i / 3) + i % 3;
                    to[y * 3 * side + i] = 0.25f * (p[0] + p[3] + p[6 * side] + p[6 * side + 3]);
                }
            }
            from = to;
            to += 3 * side * side;
        }
    }
    free(image);
    free(depth);
    return good;
}

/* Samples the poster; u and v in 0..1, footprint in poster widths */
void poster_at(const poster *p, float u, float v, float footprint, float rgb[3])
{
    int side = POSTER_SIDE;
    const float *level = p->rgb;
    for (float texels = footprint * POSTER_SIDE; texels > 1.5f && side > 5; texels *= 0.5f) {
        level += 3 * side * side;
        side /= 2;
    }
    float x = clampf(u * (float)side - 0.5f, 0.0f, (float)side - 1.001f);
    float y = clampf(v * (float)side - 0.5f, 0.0f, (float)side - 1.001f);
    int x0 = (int)x, y0 = (int)y;
    float s = x - (float)x0, t = y - (float)y0;
    level += 3 * (y0 * side + x0);
    for (int c = 0; c < 3; c++) {
        float a = level[c] + s * (level[c + 3] - level[c]);
        float b = level[3 * side + c] + s * (level[3 * side + c + 3] - level[3 * side + c]);
        rgb[c] = a + t * (b - a);
    }
}
