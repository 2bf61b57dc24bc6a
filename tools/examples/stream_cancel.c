/* SPDX-License-Identifier: Apache-2.0 */
/* A map that follows a recording, with a deadline for each keyframe: the hook `progress` cancels the rest of its work.
 * The map stays valid, and the next frame is taken.
 *
 *     trim3r room --frames 12 -o walk.mcap
 *     stream_cancel walk.mcap 20 */
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include "trim3r_host.h"

enum { SIDE = 128, LIVE = 4, GAUSSIANS = 1500 };

static double now_ms(void)
{
    struct timespec at;
    timespec_get(&at, TIME_UTC);
    return difftime(at.tv_sec, 0) * 1e3 + (double)at.tv_nsec * 1e-6;
}

static int is_late(void *user, t3r_stage stage, uint32_t done, uint32_t total)
{
    (void)stage, (void)done, (void)total;
    const double *deadline_ms = user;
    return now_ms() > *deadline_ms;
}

/* Takes every frame until the end. Returns the status of the last one. */
static t3r_status follow(t3r_runtime *rt, t3r_capture *source, double limit_ms, double *deadline_ms)
{
    t3r_status status = T3R_OK;
    t3r_capture_frame frame;
    while ((status == T3R_OK || status == T3R_ERR_CANCELLED) && t3r_capture_next(source, &frame) == T3R_CAPTURE_FRAME) {
        t3r_stream_report report;
        t3r_scene map = {.count = 0};
        *deadline_ms = now_ms() + limit_ms;
        status = t3r_stream_keyframe(rt, &frame.frame, &frame.camera, &report);
        (void)t3r_get_scene(rt, &map);
        const char *outcome = status == T3R_ERR_CANCELLED          ? "cancelled"
                              : status != T3R_OK                   ? t3r_error_text(status)
                              : report.refusal != T3R_REFUSAL_NONE ? t3r_refusal_name(report.refusal)
                                                                   : "taken";
        printf("frame %" PRIu32 ": %s, %" PRIu32 " Gaussians\n", frame.index, outcome, map.count);
    }
    return status == T3R_ERR_CANCELLED ? T3R_OK : status;
}

int main(int argc, char **argv)
{
    char error[512] = "usage: stream_cancel REC.mcap MILLISECONDS";
    double deadline_ms = 0;
    t3r_config config = t3r_default_config(SIDE, SIDE, LIVE, GAUSSIANS);
    const t3r_hooks hooks = {.user = &deadline_ms, .progress = is_late};
    t3r_host *host = NULL;
    t3r_capture *source = argc == 3 ? t3r_replay_open(argv[1], error, sizeof error) : NULL;
    config.stream = 1;
    t3r_status status = source != NULL ? t3r_host_open(&host, &config, 1, error, sizeof error) : T3R_ERR_ARGUMENT;
    if (status == T3R_OK) {
        (void)t3r_host_set_hooks(host, &hooks);
        status = follow(t3r_host_runtime(host), source, strtod(argv[2], NULL), &deadline_ms);
    } else {
        fprintf(stderr, "%s\n", error);
    }
    t3r_host_close(host);
    t3r_capture_close(source);
    return status == T3R_OK ? 0 : 1;
}
