/* SPDX-License-Identifier: Apache-2.0 */
#include "procedural_scene.h"

#include <stdlib.h>
#include <string.h>

int procedural_room(const atlas *shared, uint64_t seed, int width, int height, int views, uint8_t *images,
                    float *depths, float *intrinsics, float *poses)
{
    if (width < 16 || width > 2048 || height < 16 || height > 2048 || views < 1 || views > MAX_VIEWS) {
        return -1;
    }
    size_t pixels = (size_t)width * height, rays = pixels * SUBSAMPLES * SUBSAMPLES;
    room *r = calloc(1, sizeof *r);
    float *near = malloc(rays * sizeof *near), *linear = malloc(pixels * 3 * sizeof *linear);
    float *scratch = malloc(pixels * 3 * sizeof *scratch);
    uint16_t *owner = malloc(rays * sizeof *owner);
    bool good = r && near && linear && scratch && owner;
    generator g = {seed};
    if (good) {
        r->shared = shared;
        r->luxels = malloc((MAX_LUXELS + 4 * 6 * MAX_BODIES) * sizeof *r->luxels);
        good = r->luxels != NULL;
    }
    for (int i = 0; good && i < POSTERS; i++) {
        good = poster_draw(&r->posters[i], shared, draw_bits(&g));
    }
    if (good) {
        viewpoint path[MAX_VIEWS];
        camera_look look;
        look_draw(&look, &g);
        look.vignette *= 0.5f;
        furnish(r, &g);
        path_draw(r, &g, width, height, views, path);
        store_light(r);
        for (int i = 0; i < views; i++) {
            const viewpoint *v = &path[i];
            see_room(r, v, width, height, near, owner, linear, depths + i * pixels);
            if (i == 0) {
                look.exposure = look_exposure(linear, width, height, draw_in(&g, 0.1f, 0.22f));
            }
            develop(&look, &g, width, height, linear, scratch, images + i * pixels * 3);
            const float k[4] = {v->fx, v->fy, v->cx, v->cy};
            const float pose[16] = {v->x.x, v->y.x, v->z.x, v->at.x, v->x.y, v->y.y, v->z.y, v->at.y,
                                    v->x.z, v->y.z, v->z.z, v->at.z, 0.0f,   0.0f,   0.0f,   1.0f};
            memcpy(intrinsics + 4 * i, k, sizeof k);
            memcpy(poses + 16 * i, pose, sizeof pose);
        }
    }
    for (int i = 0; r && i < POSTERS; i++) {
        free(r->posters[i].rgb);
    }
    if (r) {
        free(r->luxels);
    }
    free(r);
    free(near);
    free(linear);
    free(scratch);
    free(owner);
    return good ? 0 : -1;
}
