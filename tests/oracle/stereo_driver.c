/* SPDX-License-Identifier: Apache-2.0 */
/* stereo_driver match W H DISPARITIES PATHS: two luma planes on stdin, W x H and W + DISPARITIES - 1 x H (match.h); on
 * stdout the first plane's disparities, 16 bits each, and their confidences.
 *
 * stereo_driver pair W H DISPARITIES PATHS, then twice FX FY CX CY X Y Z QW QX QY QZ: two views' RGB planes on stdin;
 * on stdout a line with the kind of pair, its depth unit and the first view's rectified kind and size, then depth, 16
 * bits each, and confidence of both views.
 *
 * stereo_driver bench W H DISPARITIES PATHS ROUNDS: like match; prints the fastest round's processor time in ms without
 * and with filling. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "core/camera.h"
#include "host/cpu.h"
#include "kernels/kernels.h"
#include "stereo/match_clean.h"
#include "stereo/stereo.h"

static void *allocate(size_t bytes)
{
    void *memory = aligned_alloc(64, (bytes + 63) / 64 * 64);
    if (memory == NULL) {
        exit(1);
    }
    return memory;
}

static void get(void *to, size_t bytes)
{
    if (fread(to, 1, bytes, stdin) != bytes) {
        exit(1);
    }
}

static double milliseconds(void)
{
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return 1e3 * (double)t.tv_sec + 1e-6 * (double)t.tv_nsec;
}

static int match(uint32_t width, uint32_t height, uint32_t disparities, uint32_t paths, int rounds)
{
    t3r_kernels kernels;
    t3r_kernels_choose(&kernels, t3r_cpu_features());
    const size_t left = (size_t)width * height, right = T3R_MATCH_RIGHT(width, disparities) * height;
    uint8_t *luma[2] = {allocate(left), allocate(right)};
    const t3r_match m = {
        .width = width,
        .height = height,
        .disparities = disparities,
        .kernels = &kernels,
        .paths = paths,
        .p1 = T3R_STEREO_P1,
        .p2 = T3R_STEREO_P2,
        .p2_min = T3R_STEREO_P2_MIN,
        .luma = {luma[0], luma[1]},
        .disparity = {allocate(2 * left), allocate(2 * right)},
        .confidence = {allocate(left), allocate(right)},
        .work = allocate(T3R_MATCH_WORK_BYTES(width, height, disparities, paths)),
    };
    get(luma[0], left);
    get(luma[1], right);
    if (rounds > 0) {
        double best[2] = {1e9, 1e9};
        for (int i = 0; i < rounds; i++) {
            const double start = milliseconds();
            t3r_match_pair(&m);
            t3r_match_agree(&m);
            for (uint32_t side = 0; side < 2; side++) {
                (void)t3r_match_speckles(&m, side);
                t3r_match_smooth(&m, side);
            }
            const double matched = milliseconds();
            t3r_match_fill(&m, 0);
            t3r_match_fill(&m, 1);
            const double filled = milliseconds();
            best[0] = fmin(best[0], matched - start);
            best[1] = fmin(best[1], filled - start);
        }
        printf("%.3f %.3f\n", best[0], best[1]);
        return 0;
    }
    t3r_match_all(&m, true);
    fwrite(m.disparity[0], 2, left, stdout);
    fwrite(m.confidence[0], 1, left, stdout);
    return 0;
}

static int32_t fixed(const char *text, int bits)
{
    return (int32_t)lround(ldexp(atof(text), bits));
}

static int pair(uint32_t width, uint32_t height, const t3r_stereo_settings *settings, char **numbers)
{
    const size_t pixels = (size_t)width * height;
    t3r_camera cameras[2];
    t3r_view views[2] = {0};
    for (int i = 0; i < 2; i++) {
        char **n = numbers + 11 * i;
        cameras[i] = (t3r_camera){
            .fx_q16 = fixed(n[0], 16), .fy_q16 = fixed(n[1], 16), .cx_q16 = fixed(n[2], 16), .cy_q16 = fixed(n[3], 16)};
        for (int k = 0; k < 3; k++) {
            cameras[i].position_q32[k] = llround(ldexp(atof(n[4 + k]), 32));
        }
        for (int k = 0; k < 4; k++) {
            cameras[i].rotation_q30[k] = fixed(n[7 + k], 30);
        }
        if (t3r_camera_check(&cameras[i], width, height) != T3R_OK) {
            return 1;
        }
        views[i].width = width;
        views[i].height = height;
        for (int c = 0; c < 3; c++) {
            views[i].colour[c] = allocate(pixels);
            get(views[i].colour[c], pixels);
        }
        views[i].depth = allocate(2 * pixels);
        views[i].match_confidence = allocate(pixels);
    }
    uint64_t unit = 0;
    t3r_rectification rect = {0};
    void *work = allocate(T3R_STEREO_WORK_BYTES(width, height, settings->disparities, settings->paths));
    const double start = milliseconds();
    const t3r_pair found = t3r_stereo_depth(settings, cameras, views, work, &unit);
    const double took = milliseconds() - start;
    (void)t3r_rectify(&cameras[0], &cameras[1], width, height, settings->disparities, &rect);
    printf("%d %llu %s %u %u %.2f ms; %s\n", (int)found, (unsigned long long)unit, rect.polar ? "polar" : "planar",
           rect.width, rect.height, took, t3r_pair_text(found));
    for (int i = 0; i < 2 && found == T3R_PAIR_OK; i++) {
        fwrite(views[i].depth, 2, pixels, stdout);
        fwrite(views[i].match_confidence, 1, pixels, stdout);
    }
    return 0;
}

int main(int argc, char **argv)
{
    if (argc < 6) {
        return 2;
    }
    const uint32_t width = (uint32_t)atoi(argv[2]), height = (uint32_t)atoi(argv[3]);
    const t3r_stereo_settings settings = {
        &t3r_kernels_c, (uint32_t)atoi(argv[4]), (uint32_t)atoi(argv[5]), 1, {NULL, 1}};
    if (strcmp(argv[1], "match") == 0) {
        return match(width, height, settings.disparities, settings.paths, 0);
    }
    if (strcmp(argv[1], "bench") == 0 && argc == 7) {
        return match(width, height, settings.disparities, settings.paths, atoi(argv[6]));
    }
    return strcmp(argv[1], "pair") == 0 && argc == 6 + 22 ? pair(width, height, &settings, argv + 6) : 2;
}
