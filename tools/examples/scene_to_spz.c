/* SPDX-License-Identifier: Apache-2.0 */
/* The shortest way from frames to a file: the first two frames of a recording with depth become Gaussians, which the
 * viewers of .spz show. The suffix decides the format: .ply, .splat and .glb work the same way.
 *
 *     trim3r room --frames 2 -o room.mcap
 *     scene_to_spz room.mcap room.spz */
#include <inttypes.h>
#include <stdio.h>

#include "trim3r_heads.h"
#include "trim3r_host.h"

enum { SIDE = 256, VIEWS = 2, GAUSSIANS = 6000 };

static t3r_status build(t3r_runtime *rt, t3r_capture *source, t3r_scene *scene, char *error, size_t error_bytes)
{
    t3r_capture_frame frame;
    (void)t3r_bind_head(rt, t3r_head_small, t3r_head_small_bytes);
    for (int v = 0; v < VIEWS; v++) {
        if (t3r_capture_next(source, &frame) != T3R_CAPTURE_FRAME || !frame.has_pose) {
            snprintf(error, error_bytes, "there is no frame %d with a pose", v);
            return T3R_ERR_CAMERA;
        }
        const t3r_status status = t3r_add_view(rt, &frame.frame, &frame.camera);
        if (status != T3R_OK) {
            (void)t3r_add_view_error(status, rt, &frame.frame, &frame.camera, error, error_bytes);
            return status;
        }
    }
    const t3r_status status = t3r_reconstruct(rt, NULL, scene);
    (void)t3r_reconstruct_error(status, rt, NULL, scene, error, error_bytes);
    return status;
}

int main(int argc, char **argv)
{
    char error[512] = "usage: scene_to_spz REC.mcap SCENE.spz";
    t3r_capture *source = argc == 3 ? t3r_replay_open(argv[1], error, sizeof error) : NULL;
    if (source == NULL) {
        fprintf(stderr, "%s\n", error);
        return 1;
    }
    t3r_config config = t3r_default_config(SIDE, SIDE, VIEWS, GAUSSIANS);
    config.head = T3R_HEAD_LEARNED;
    t3r_host *host;
    t3r_scene scene;
    t3r_status status = t3r_host_open(&host, &config, 0, error, sizeof error); /* 0: a thread per processor */
    if (status == T3R_OK) {
        status = build(t3r_host_runtime(host), source, &scene, error, sizeof error);
    }
    if (status == T3R_OK) {
        status = t3r_scene_write(argv[2], &scene, 0, error, sizeof error);
    }
    if (status == T3R_OK) {
        printf("%s: %" PRIu32 " Gaussians\n", argv[2], scene.count);
    } else {
        fprintf(stderr, "%s\n", error);
    }
    t3r_host_close(host);
    t3r_capture_close(source);
    return status == T3R_OK ? 0 : 1;
}
