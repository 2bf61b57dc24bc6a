/* SPDX-License-Identifier: Apache-2.0 */
/* A product's own regression test: frames that were recorded once must always give the same bits, on its processor,
 * with its compiler, with its next release. Every stage of every build and of every view is hashed:
 *
 *     replay_test room.mcap >room.txt        current results, a line a stage, to keep with the recording
 *     replay_test room.mcap room.txt         exit status 1 with the first line that differs, if a bit changes */
#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#include "trim3r_host.h"

enum { SIDE = 128, VIEWS = 2, GAUSSIANS = 2000 };

static _Alignas(T3R_ARENA_ALIGN) uint8_t arena[T3R_ARENA_BYTES(SIDE, SIDE, VIEWS, GAUSSIANS)];
static uint8_t view[SIDE][SIDE][3];
static const t3r_target picture = {SIDE, SIDE, .rgb = &view[0][0][0], .rgb_stride_bytes = sizeof view[0]};

typedef struct test {
    FILE *expected; /* NULL: lines are printed */
    uint32_t frame; /* last frame of a build */
    uint32_t lines;
    bool failed;
} test;

static void hear(void *user, t3r_stage stage, uint64_t hash)
{
    test *t = user;
    char now[128], then[128] = "nothing\n";
    snprintf(now, sizeof now, "frame %" PRIu32 " %s %016" PRIx64 "\n", t->frame, t3r_stage_name(stage), hash);
    t->lines++;
    if (t->expected == NULL) {
        fputs(now, stdout);
    } else if (!t->failed && (fgets(then, sizeof then, t->expected) == NULL || strcmp(now, then) != 0)) {
        printf("line %" PRIu32 ": %sexpected: %s", t->lines, now, then);
        t->failed = true; /* later lines differ as well */
    }
}

/* Builds the scene of the added frames, and draws a view of it from the last frame. */
static t3r_status build(t3r_runtime *rt, t3r_camera camera)
{
    camera.width = camera.height = SIDE;
    camera.fx_q16 = camera.fy_q16 = SIDE << 16;
    camera.cx_q16 = camera.cy_q16 = (SIDE - 1) << 15;
    camera.distortion = T3R_DISTORTION_NONE;
    t3r_scene scene;
    t3r_status status = t3r_reconstruct(rt, NULL, &scene);
    status = status == T3R_OK ? t3r_render(rt, &camera, &picture) : status;
    return status == T3R_OK ? t3r_reset(rt) : status;
}

static t3r_status replay(t3r_runtime *rt, t3r_capture *source, test *t)
{
    t3r_capture_frame frame;
    t3r_status status = T3R_OK;
    uint32_t views = 0;
    while (status == T3R_OK && t3r_capture_next(source, &frame) == T3R_CAPTURE_FRAME) {
        t->frame = frame.index;
        status = t3r_add_view(rt, &frame.frame, &frame.camera);
        if (status == T3R_OK && ++views % VIEWS == 0) {
            status = build(rt, frame.camera);
        }
    }
    return status == T3R_OK && views % VIEWS != 0 ? build(rt, frame.camera) : status; /* a remainder of frames */
}

int main(int argc, char **argv)
{
    test t = {.expected = argc == 3 ? fopen(argv[2], "r") : NULL};
    char error[512] = "usage: replay_test REC.mcap [EXPECTED]";
    t3r_capture *source = argc == 2 || t.expected != NULL ? t3r_replay_open(argv[1], error, sizeof error) : NULL;
    if (source == NULL) {
        fprintf(stderr, "%s\n", argc == 3 && t.expected == NULL ? "no such file" : error);
        return 2;
    }
    const t3r_hooks hooks = {.user = &t, .stage_hash = hear};
    const t3r_config config = t3r_default_config(SIDE, SIDE, VIEWS, GAUSSIANS);
    t3r_runtime *rt;
    t3r_status status = t3r_init(&rt, arena, sizeof arena, &config);
    status = status == T3R_OK ? t3r_set_cpu(rt, t3r_cpu_features()) : status;
    status = status == T3R_OK ? t3r_set_hooks(rt, &hooks) : status;
    status = status == T3R_OK ? replay(rt, source, &t) : status;
    if (status != T3R_OK || t3r_capture_error(source)[0] != '\0') {
        printf("frame %" PRIu32 ": %s\n", t.frame,
               status != T3R_OK ? t3r_error_text(status) : t3r_capture_error(source));
        t.failed = true;
    }
    if (t.lines == 0 || (t.expected != NULL && !t.failed && fgetc(t.expected) != EOF)) {
        printf("the recording ends too soon\n");
        t.failed = true;
    }
    t3r_capture_close(source);
    return t.failed ? 1 : 0;
}
