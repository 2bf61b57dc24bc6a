/* SPDX-License-Identifier: Apache-2.0 */
/* trim3r capture: from a camera to a recording, to Gaussians, or to both. */
#include "trim3r/commands/commands.h"

#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "capture/clock_offset.h"
#include "capture/options.h"
#include "capture/result.h"
#include "capture/run.h"
#include "capture/source_name.h"
#include "cli/cli.h"
#include "cli/files/part_files.h"
#include "cli/options/file_options.h"
#include "cli/text/wrapped.h"
#include "trim3r_capture.h"

#define ERROR_BYTES 512
#define LIST_INDENT 15u              /* of what an adapter reads, after its name and whether it is there */
#define MOST_MOTIONS 3000u           /* frames for estimating an offset */
#define RANGE_NS INT64_C(1000000000) /* search range about the expected offset */

static volatile sig_atomic_t stop;

/* Handles signals; a second one ends the process. */
static void on_signal(int signal_number)
{
    if (stop != 0) {
        part_files_end(signal_number);
    }
    stop = signal_number;
}

/* Without SA_RESTART: a wait for a frame ends at once. */
static void watch_signals(void)
{
    struct sigaction action = {.sa_handler = on_signal};
    sigemptyset(&action.sa_mask);
    sigaction(SIGINT, &action, NULL);
    sigaction(SIGTERM, &action, NULL);
}

static void say_device(void *user, const char *line)
{
    ++*(uint32_t *)user;
    printf("    %s\n", line);
}

static int list(void)
{
    char label[64];
    for (uint32_t i = 0; i < t3r_capture_adapter_count(); i++) {
        t3r_capture_adapter adapter = t3r_capture_adapter_of(i);
        snprintf(label, sizeof label, "%-10s %-4s", adapter.name, adapter.available ? "yes" : "no");
        wrapped_print(stdout, LIST_INDENT, label, adapter.says);
        uint32_t devices = 0;
        if (adapter.available) {
            t3r_capture_devices(adapter.name, say_device, &devices);
        }
        bool looked = strcmp(adapter.name, "v4l2") == 0 || strcmp(adapter.name, "libcamera") == 0;
        if (adapter.available && looked && devices == 0) {
            printf("    no device found\n");
        }
    }
    printf("formats    %s; depth Z16 Y16\n", t3r_capture_formats());
    return CLI_OK;
}

/* Measures the picture's motion from frame to frame; *count motions in a heap array. */
static clock_motion *motions_of(const capture_options *o, uint32_t *count, char *error)
{
    t3r_capture *capture = t3r_capture_open(o->source, &o->settings, error, ERROR_BYTES);
    if (capture == NULL) {
        return NULL;
    }
    clock_motion *motions = calloc(MOST_MOTIONS, sizeof *motions);
    clock_picture pictures[2];
    int64_t last_ns = 0;
    uint32_t frames = 0;
    *count = 0;
    for (int got = T3R_CAPTURE_FRAME;
         motions != NULL && *count < MOST_MOTIONS && got != T3R_CAPTURE_END && stop == 0;) {
        t3r_capture_frame frame;
        got = t3r_capture_next(capture, &frame);
        if (got == T3R_CAPTURE_LOST) {
            break;
        }
        if (got != T3R_CAPTURE_FRAME) {
            continue;
        }
        cli_progress("looking for the clocks' offset", frames, MOST_MOTIONS);
        clock_picture_of(&frame.frame, &pictures[frames & 1]);
        if (frames++ > 0) {
            clock_motion *motion = &motions[(*count)++];
            *motion = (clock_motion){.from_ns = last_ns, .to_ns = frame.stamp_ns};
            clock_motion_of(&pictures[frames & 1], &pictures[(frames & 1) ^ 1], motion);
        }
        last_ns = frame.stamp_ns;
    }
    cli_progress_end();
    t3r_capture_close(capture);
    if (motions == NULL) {
        snprintf(error, ERROR_BYTES, "out of memory");
    }
    return motions;
}

static int estimate_offset(const capture_options *o, const trajectory *poses, clock_offset *found)
{
    char error[ERROR_BYTES] = "";
    if (strncmp(o->source, "replay:", 7) != 0) {
        return cli_error(CLI_BAD_USAGE, "--clock-offset estimate looks at all frames first: record, then give "
                                        "--source replay:REC.mcap");
    }
    uint32_t count = 0;
    clock_motion *motions = motions_of(o, &count, error);
    if (motions == NULL) {
        return cli_error(CLI_BAD_INPUT, "%s", error);
    }
    if (stop != 0) { /* an offset from a part of the frames would pass for the whole */
        free(motions);
        return CLI_OK;
    }
    int64_t centre = o->offset_ns;
    if (!o->has_centre && count > 0) {
        int64_t first = poses->poses[0].stamp_ns, last = poses->poses[poses->count - 1].stamp_ns;
        int64_t from = motions[0].from_ns;
        /* stamps may be 2^63 apart: halves */
        if (llabs(first / 2 - from / 2) >= CAPTURE_MOST_OFFSET_S * 500000000) {
            free(motions);
            return cli_error(CLI_BAD_INPUT, "the poses' clock and the camera's are 4e9 s apart or more");
        }
        bool overlap = from < last && motions[count - 1].to_ns > first;
        centre = overlap ? 0 : first - from;
    }
    int status = clock_offset_estimate(motions, count, poses, centre, RANGE_NS, found, error, sizeof error);
    free(motions);
    return status == 0 ? CLI_OK : cli_error(CLI_BAD_INPUT, "%s", error);
}

static int run(const capture_options *o, const trajectory *poses, const clock_offset *offset)
{
    char error[ERROR_BYTES] = "";
    t3r_capture *capture = t3r_capture_open(o->source, &o->settings, error, sizeof error);
    if (capture == NULL) {
        return cli_error(CLI_BAD_INPUT, "%s", error);
    }
    if (!o->quiet && !o->json && t3r_capture_note(capture)[0] != '\0') {
        fprintf(stderr, "%s\n", t3r_capture_note(capture));
    }
    char name[T3R_SOURCE_NAME_BYTES];
    t3r_source_name(o->source, name, sizeof name);
    const capture_plan plan = {
        .source = name,
        .output = o->output,
        .max_bytes = o->max_bytes,
        .sync = o->sync,
        .stored = o->stored,
        .poses = poses,
        .offset_ns = offset->offset_ns,
        .intrinsics = o->has_intrinsics ? &o->intrinsics : NULL,
        .frames = o->frames,
        .seconds = o->seconds,
        .reconnect_seconds = o->reconnect_seconds,
        .build = o->scene != NULL ? &o->build : NULL,
        .stream = o->streams ? &o->live : NULL,
        .prints_table = !o->json && !o->quiet,
        .every = o->every,
        .scene = o->scene,
        .scene_flags = o->local ? T3R_SCENE_LOCAL : 0,
        .hash = o->hash,
        .stop = &stop,
        .quiet = o->quiet,
    };
    capture_account account;
    int code = capture_run(capture, &plan, &account);
    if (code == CLI_OK) {
        capture_result_print(o, name, capture, &account, offset);
    }
    t3r_capture_close(capture);
    return code;
}

int command_capture(int argc, char **argv)
{
    capture_options o;
    capture_options_read(argc, argv, &o);
    if (o.list) {
        return list();
    }
    watch_signals();
    trajectory poses = {0};
    clock_offset offset = {.offset_ns = o.estimate ? 0 : o.offset_ns};
    int code = CLI_OK;
    if (o.poses != NULL) {
        char error[ERROR_BYTES] = "";
        if (trajectory_read(o.poses, o.pose_topic, &poses, error, sizeof error) != 0) {
            return cli_error(CLI_BAD_INPUT, "%s", error);
        }
        o.poses_left_out = poses.losses.count;
        code = pose_losses_print(&poses.losses, o.poses, o.strict);
        code = code == CLI_OK && o.estimate ? estimate_offset(&o, &poses, &offset) : code;
    }
    if (code == CLI_OK && stop != 0) {
        code = cli_error(CLI_BAD_INPUT, "stopped before the capture began: nothing was written");
    } else if (code == CLI_OK) {
        code = run(&o, o.poses != NULL ? &poses : NULL, &offset);
    }
    trajectory_free(&poses);
    return code;
}
