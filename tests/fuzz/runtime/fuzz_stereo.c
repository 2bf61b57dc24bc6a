/* SPDX-License-Identifier: Apache-2.0 */
/* Turns bytes into two cameras, settings and pictures: cameras that pass the check get a result, within the memory
 * that the macros state, and depths within their range. Plain C and the processor's variants agree. */
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "arguments.h"
#include "core/camera.h"
#include "stereo/planes/plane_fill.h"
#include "stereo/stereo.h"

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t count);

/* The first bytes; the remaining ones are repeated for pictures. */
typedef struct header {
    uint8_t width, height, disparities, paths;
    uint8_t plain; /* bits: cameras with plausible intrinsics, and whether they are near each other */
    t3r_camera cameras[2];
} header;

static void tame(header *h)
{
    for (int i = 0; i < 2; i++) {
        t3r_camera *c = &h->cameras[i];
        c->width = c->height = 0;
        c->distortion = T3R_DISTORTION_NONE;
        if (h->plain >> i & 1) {
            c->fx_q16 = (int32_t)(20u << 16 | ((uint32_t)c->fx_q16 & 0x3fffff));
            c->fy_q16 = (int32_t)(20u << 16 | ((uint32_t)c->fy_q16 & 0x3fffff));
            c->cx_q16 &= 0x3fffff;
            c->cy_q16 &= 0x3fffff;
            c->rotation_q30[0] = 1 << 30;
            for (int k = 1; k < 4; k++) {
                c->rotation_q30[k] %= 1 << 29;
            }
        }
        for (int k = 0; k < 3 && h->plain & 4; k++) {
            c->position_q32[k] %= INT64_C(1) << 33;
        }
    }
}

static uint32_t features(void)
{
#if defined(__x86_64__)
    const bool wide = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
                      __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl");
    return (__builtin_cpu_supports("avx2") ? T3R_CPU_AVX2 : 0) | (wide ? T3R_CPU_AVX512 : 0);
#else
    return 0;
#endif
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t count)
{
    header h;
    if (count < sizeof h) {
        return 0;
    }
    memcpy(&h, bytes, sizeof h);
    tame(&h);
    const uint32_t width = 8 + h.width % 48u, height = 8 + h.height % 48u;
    if (t3r_camera_check(&h.cameras[0], width, height) != T3R_OK ||
        t3r_camera_check(&h.cameras[1], width, height) != T3R_OK) {
        return 0;
    }
    const t3r_stereo_settings settings = {
        &t3r_kernels_c, 16 * (1 + h.disparities % 16u), h.paths % 2 == 0 ? 4 : 8, h.paths >> 1 & 1, {NULL, 1}};
    const size_t pixels = (size_t)width * height;
    const size_t of_pair = T3R_STEREO_WORK_BYTES(width, height, settings.disparities, settings.paths);
    const size_t bytes_of_work = T3R_MAX_(of_pair, T3R_PLANE_FILL_BYTES(width, height));
    void *work = aligned_alloc(64, bytes_of_work);
    uint8_t *planes = malloc(pixels * 8);
    uint16_t *depth = malloc(pixels * 4);
    REQUIRE(work != NULL && planes != NULL && depth != NULL);
    memset(work, h.plain, bytes_of_work);
    const size_t rest = count - sizeof h;
    for (size_t i = 0; i < pixels * 8; i++) {
        planes[i] = rest == 0 ? (uint8_t)(i * 2654435761u >> 13) : bytes[sizeof h + i * (1 + h.plain / 8) % rest];
    }
    t3r_view views[2];
    for (int i = 0; i < 2; i++) {
        uint8_t *at = planes + 4 * pixels * (size_t)i;
        views[i] = (t3r_view){.width = width,
                              .height = height,
                              .colour = {at, at + pixels, at + 2 * pixels},
                              .depth = depth + pixels * (size_t)i,
                              .match_confidence = at + 3 * pixels};
    }
    uint64_t unit = 0;
    const t3r_pair pair = t3r_stereo_depth(&settings, h.cameras, views, work, &unit);
    REQUIRE((uint32_t)pair < T3R_PAIR_COUNT);
    t3r_kernels variants;
    t3r_kernels_choose(&variants, features());
    t3r_stereo_settings chosen = settings;
    chosen.kernels = &variants;
    t3r_view again[2] = {views[0], views[1]};
    uint16_t *other_depth = malloc(pixels * 4);
    uint8_t *other_confidence = malloc(pixels * 2);
    REQUIRE(other_depth != NULL && other_confidence != NULL);
    for (size_t i = 0; i < 2; i++) {
        again[i].depth = other_depth + pixels * i;
        again[i].match_confidence = other_confidence + pixels * i;
    }
    uint64_t other_unit = 0;
    REQUIRE(t3r_stereo_depth(&chosen, h.cameras, again, work, &other_unit) == pair);
    for (size_t i = 0; i < 2 && pair == T3R_PAIR_OK; i++) {
        REQUIRE(other_unit == unit);
        REQUIRE(memcmp(again[i].depth, views[i].depth, pixels * 2) == 0);
        REQUIRE(memcmp(again[i].match_confidence, views[i].match_confidence, pixels) == 0);
    }
    for (size_t i = 0; i < 2 && pair == T3R_PAIR_OK && width >= T3R_STEREO_LEAST_SIDE; i++) {
        if (height >= T3R_STEREO_LEAST_SIDE) {
            views[i].depth_unit_q40 = unit;
            const t3r_plane_pair both = {settings.kernels, &views[i], &views[1 - i], &h.cameras[i], &h.cameras[1 - i]};
            t3r_plane_fill(&both, work);
        }
    }
    free(other_depth);
    free(other_confidence);
    for (size_t i = 0; i < 2 && pair == T3R_PAIR_OK; i++) {
        REQUIRE(unit >= 1 && unit < UINT64_C(1) << 47);
        for (size_t n = 0; n < pixels; n++) {
            REQUIRE((views[i].depth[n] == 0) == (views[i].match_confidence[n] == T3R_STEREO_NONE));
        }
    }
    free(work);
    free(planes);
    free(depth);
    return 0;
}
