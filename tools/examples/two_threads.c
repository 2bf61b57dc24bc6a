/* SPDX-License-Identifier: Apache-2.0 */
/* One build by one thread and one by two: the second takes less time where two processors are free, and every stage has
 * the same bits.
 *
 *     trim3r room --frames 2 -o room.mcap
 *     two_threads room.mcap */
#include <inttypes.h>
#include <stdio.h>
#include <time.h>

#include "trim3r_host.h"

enum { SIDE = 256, VIEWS = 2, GAUSSIANS = 6000 };

static void fold(void *user, t3r_stage stage, uint64_t hash)
{
    uint64_t *folded = user;
    *folded = (*folded ^ hash ^ stage) * UINT64_C(1099511628211);
}

/* Builds a scene of a recording's first frames. Returns 0 and the hash of all stages, or 1 after a message. */
static int build(const char *path, uint32_t threads, uint64_t *hash)
{
    char error[512] = "";
    const t3r_config config = t3r_default_config(SIDE, SIDE, VIEWS, GAUSSIANS);
    const t3r_hooks hooks = {.user = hash, .stage_hash = fold};
    struct timespec begun, ended;
    t3r_capture_frame frame;
    t3r_scene scene;
    t3r_host *host;
    t3r_status status = t3r_host_open(&host, &config, threads, error, sizeof error);
    t3r_capture *source = status == T3R_OK ? t3r_replay_open(path, error, sizeof error) : NULL;
    if (source != NULL) {
        t3r_runtime *rt = t3r_host_runtime(host);
        timespec_get(&begun, TIME_UTC);
        status = t3r_host_set_hooks(host, &hooks); /* not t3r_set_hooks(): the threads are a hook, too */
        for (int v = 0; v < VIEWS && status == T3R_OK && t3r_capture_next(source, &frame) == T3R_CAPTURE_FRAME; v++) {
            status = t3r_add_view(rt, &frame.frame, &frame.camera);
        }
        status = status == T3R_OK ? t3r_reconstruct(rt, NULL, &scene) : status;
        timespec_get(&ended, TIME_UTC);
        const double seconds = difftime(ended.tv_sec, begun.tv_sec) + (double)(ended.tv_nsec - begun.tv_nsec) * 1e-9;
        printf("%" PRIu32 " threads: %.3f s, %016" PRIx64 ", %s\n", threads, seconds, *hash, t3r_error_text(status));
        t3r_capture_close(source);
    } else {
        fprintf(stderr, "%s\n", error);
    }
    t3r_host_close(host);
    return source != NULL && status == T3R_OK ? 0 : 1;
}

int main(int argc, char **argv)
{
    uint64_t hash[2] = {0};
    if (argc != 2) {
        fprintf(stderr, "usage: two_threads REC.mcap\n");
        return 1;
    }
    return build(argv[1], 1, &hash[0]) != 0 || build(argv[1], 2, &hash[1]) != 0 || hash[0] != hash[1];
}
