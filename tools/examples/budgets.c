/* SPDX-License-Identifier: Apache-2.0 */
/* Several scenes of one analysis: each budget is a rebuild of the same two frames, and the last one is the smallest
 * that draws them well enough. Each is a file.
 *
 *     trim3r room --frames 2 -o room.mcap
 *     budgets room.mcap scene */
#include <inttypes.h>
#include <stdio.h>

#include "trim3r_host.h"

enum { SIDE = 128, VIEWS = 2, MOST = 4000, LEAST_DECIBEL = 26 };

static char error[512];

static t3r_status save(const char *name, const t3r_scene *scene)
{
    char path[256];
    snprintf(path, sizeof path, "%s-%" PRIu32 ".ply", name, scene->count);
    const t3r_status status = t3r_scene_write(path, scene, 0, error, sizeof error);
    if (status == T3R_OK) {
        printf("%s\n", path);
    }
    return status;
}

static t3r_status build(t3r_runtime *rt, t3r_capture *source, const char *name)
{
    static const uint32_t budgets[] = {2000, 1000, 500};
    static uint8_t picture[SIDE * SIDE * 3];
    const t3r_target target = {.width = SIDE, .height = SIDE, .rgb = picture, .rgb_stride_bytes = SIDE * 3};
    t3r_capture_frame frame;
    t3r_scene scene;
    t3r_least found;
    t3r_status status = T3R_OK;
    for (int v = 0; v < VIEWS && status == T3R_OK && t3r_capture_next(source, &frame) == T3R_CAPTURE_FRAME; v++) {
        status = t3r_add_view(rt, &frame.frame, &frame.camera);
        (void)t3r_add_view_error(status, rt, &frame.frame, &frame.camera, error, sizeof error);
    }
    if (status == T3R_OK) { /* the configured budget */
        status = t3r_reconstruct(rt, NULL, &scene);
        (void)t3r_reconstruct_error(status, rt, NULL, &scene, error, sizeof error);
    }
    for (size_t i = 0; i < sizeof budgets / sizeof budgets[0] && status == T3R_OK; i++) {
        const t3r_request request = {.gaussians = budgets[i]};
        status = t3r_rebuild(rt, &request, &scene);
        (void)t3r_rebuild_error(status, rt, &request, &scene, error, sizeof error);
        status = status == T3R_OK ? save(name, &scene) : status;
    }
    if (status == T3R_OK) {
        status = t3r_rebuild_least(rt, NULL, LEAST_DECIBEL << 8, &target, &scene, &found);
        (void)t3r_rebuild_least_error(status, rt, NULL, LEAST_DECIBEL << 8, &target, &scene, &found, error,
                                      sizeof error);
        printf("%.2f dB after %" PRIu32 " builds: ", found.psnr_q8 / 256.0, found.builds);
    }
    return status == T3R_OK ? save(name, &scene) : status;
}

int main(int argc, char **argv)
{
    t3r_config config = t3r_default_config(SIDE, SIDE, VIEWS, MOST);
    t3r_host *host = NULL;
    snprintf(error, sizeof error, "usage: budgets REC.mcap NAME");
    t3r_capture *source = argc == 3 ? t3r_replay_open(argv[1], error, sizeof error) : NULL;
    config.keep_analysis = 1; /* for t3r_rebuild() */
    t3r_status status = source != NULL ? t3r_host_open(&host, &config, 0, error, sizeof error) : T3R_ERR_ARGUMENT;
    status = status == T3R_OK ? build(t3r_host_runtime(host), source, argv[2]) : status;
    if (status != T3R_OK) {
        fprintf(stderr, "%s\n", error);
    }
    t3r_host_close(host);
    t3r_capture_close(source);
    return status == T3R_OK ? 0 : 1;
}
