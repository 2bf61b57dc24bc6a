/* SPDX-License-Identifier: Apache-2.0 */
#include "capture/run.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "capture/capture_camera.h"
#include "cli/cli.h"
#include "core/hash.h"
#include "messages/pixel_layout.h"
#include "scene/scene_file.h"

#define MOST_FAILED 100u /* consecutive unreadable frames after which the source counts as unusable */
#define RETRY_NS 100000000

typedef struct run_state {
    t3r_capture *capture;
    const capture_plan *plan;
    capture_account *account;
    capture_record *record; /* NULL = none */
    live_stream stream;
    live_build build;
    bool building;         /* build is open */
    bool built_once;       /* the single build for plan->every == 0 is done */
    uint32_t next_context; /* index into build->context of the next frame to use */
    uint64_t since_build;  /* frames usable as context since the last build or kept frame */
    uint32_t failed_in_row;
    double lost_since; /* 0: not lost */
    double first_seconds, drawn;
    bool visible; /* the progress line is on the screen */
    int code;     /* status of an event that could not be recorded */
} run_state;

/* ---- helpers ---- */

static bool stopped(const capture_plan *plan)
{
    return plan->stop != NULL && *plan->stop != 0;
}

static int64_t clock_now_ns(clockid_t id)
{
    struct timespec now;
    clock_gettime(id, &now);
    return (int64_t)now.tv_sec * 1000000000 + now.tv_nsec;
}

uint64_t capture_frame_hash(uint64_t hash, const t3r_capture_frame *frame)
{
    const t3r_frame *f = &frame->frame;
    hash = t3r_hash_u64(hash, (uint64_t)frame->stamp_ns);
    hash = t3r_hash_u8(hash, (uint8_t)f->format);
    hash = t3r_hash_u32(t3r_hash_u32(hash, f->width), f->height);
    for (uint32_t p = 0; p < 2; p++) {
        for (uint32_t y = 0; y < t3r_pixel_rows(f->format, p, f->height); y++) {
            hash = t3r_hash_bytes(hash, f->planes[p] + (size_t)y * f->stride_bytes[p],
                                  t3r_pixel_row_bytes(f->format, f->width));
        }
    }
    hash = t3r_hash_u8(hash, (uint8_t)((f->depth != NULL) | frame->has_pose << 1 | frame->has_intrinsics << 2));
    if (f->depth != NULL) {
        hash = t3r_hash_u64(t3r_hash_u32(t3r_hash_u32(hash, f->depth_width), f->depth_height), f->depth_unit_q40);
        for (uint32_t y = 0; y < f->depth_height; y++) {
            hash = t3r_hash_bytes(hash, f->depth + (size_t)y * f->depth_stride_bytes, (size_t)f->depth_width * 2);
        }
    }
    const t3r_camera *c = &frame->camera;
    if (frame->has_intrinsics) {
        const int32_t numbers[4] = {c->fx_q16, c->fy_q16, c->cx_q16, c->cy_q16};
        for (int i = 0; i < 4; i++) {
            hash = t3r_hash_u32(hash, (uint32_t)numbers[i]);
        }
        hash = t3r_hash_u8(hash, (uint8_t)c->distortion);
        for (int i = 0; i < 5; i++) {
            hash = t3r_hash_u32(hash, (uint32_t)c->distortion_q24[i]);
        }
    }
    for (int i = 0; i < 3 && frame->has_pose; i++) {
        hash = t3r_hash_u64(hash, (uint64_t)c->position_q32[i]);
    }
    for (int i = 0; i < 4 && frame->has_pose; i++) {
        hash = t3r_hash_u32(hash, (uint32_t)c->rotation_q30[i]);
    }
    return hash;
}

/* ---- the progress line ---- */

static void clear_line(run_state *s)
{
    if (s->visible) {
        fputs("\r\033[K", stderr);
        s->visible = false;
    }
}

static void draw_line(run_state *s)
{
    double now = cli_now();
    if (s->plan->quiet || now - s->drawn < 0.2 || !isatty(STDERR_FILENO)) {
        return;
    }
    s->drawn = now;
    s->visible = true;
    const capture_account *a = s->account;
    t3r_capture_counts n = t3r_capture_counts_of(s->capture);
    double seconds = now - s->first_seconds;
    fprintf(stderr, "\r%" PRIu64 " frames, %.1f/s, dropped %" PRIu64 " (%" PRIu64 " slow), corrupted %" PRIu64,
            a->frames, seconds > 0 ? (double)a->frames / seconds : 0, n.dropped_driver + n.dropped_slow, n.dropped_slow,
            n.corrupted);
    if (a->late.count > 0) {
        fprintf(stderr, ", latency %.1f ms (worst %.1f)", latency_mean(&a->late), a->late.worst);
    }
    if (a->builds > 0) {
        fprintf(stderr, ", %" PRIu32 " builds", a->builds);
    }
    fputs("\033[K", stderr);
}

/* ---- events ---- */

static void hear(void *user, const t3r_capture_event *event)
{
    run_state *s = user;
    if (s->record != NULL && s->code == CLI_OK && capture_record_event(s->record, event) != 0) {
        s->code = cli_error(CLI_BAD_INPUT, "%s", s->record->error);
    }
    if (event->kind == T3R_EVENT_LOST || event->kind == T3R_EVENT_REOPENED) {
        char text[T3R_CAPTURE_EVENT_BYTES];
        clear_line(s);
        fprintf(stderr, "trim3r capture: %s\n", t3r_capture_event_text(event, text));
    }
}

/* ---- a frame ---- */

/* Completes a frame's camera by what the plan specifies, which overrides the source. */
static int complete(run_state *s, t3r_capture_frame *frame)
{
    const capture_plan *plan = s->plan;
    const char *wrong = NULL;
    const capture_account *a = s->account;
    bool resized = a->frames > 0 && (frame->frame.width != a->width || frame->frame.height != a->height);
    if (plan->intrinsics != NULL) {
        /* after a change of format they belong to another size */
        frame->has_intrinsics = !resized;
        t3r_recorded_camera camera = *plan->intrinsics;
        camera.width = frame->frame.width;
        camera.height = frame->frame.height;
        wrong = resized ? NULL : capture_camera_set_intrinsics(&camera, &frame->camera);
    }
    if (plan->poses != NULL) {
        rigid pose;
        frame->has_pose = trajectory_at_offset(plan->poses, frame->stamp_ns, plan->offset_ns, &pose);
        if (frame->has_pose) {
            t3r_recorded_camera camera = {0};
            memcpy(camera.position, pose.position, sizeof camera.position);
            memcpy(camera.rotation, pose.rotation, sizeof camera.rotation);
            wrong = wrong != NULL ? wrong : capture_camera_set_pose(&camera, &frame->camera);
        }
    }
    s->account->unposed += !frame->has_pose;
    return wrong == NULL ? CLI_OK : cli_error(CLI_BAD_INPUT, "frame %" PRIu32 ": %s", frame->index, wrong);
}

static uint32_t views_of(const capture_plan *plan)
{
    return plan->every > 0 || plan->build->context_count == 0 ? 2 : plan->build->context_count;
}

/* Returns the index of the next context frame; without --context frames 0 and 1. */
static uint32_t context_at(const capture_plan *plan, uint32_t i)
{
    return plan->build->context_count == 0 ? i : plan->build->context[i];
}

/* Opens the build with the first frame that it uses: earlier ones may lack depth, and need less room. */
static int open_build(run_state *s, const t3r_capture_frame *frame)
{
    const capture_plan *plan = s->plan;
    bool chosen =
        plan->build != NULL && plan->stream == NULL && (plan->every > 0 || frame->index == context_at(plan, 0));
    if (!chosen || s->building || live_build_lacks(frame) != NULL) {
        return CLI_OK;
    }
    int code = live_build_open(&s->build, plan->build, views_of(plan), frame);
    s->building = code == CLI_OK;
    s->account->arena_bytes = s->build.r.arena_bytes;
    return code;
}

static int write_scene(run_state *s)
{
    char error[512] = "";
    const double start = cli_now();
    if (s->plan->scene != NULL &&
        scene_file_write(s->plan->scene, &s->build.r.scene, s->plan->scene_flags, NULL, error, sizeof error) != 0) {
        return cli_error(CLI_BAD_INPUT, "%s", error);
    }
    latency_add(&s->account->writing, (cli_now() - start) * 1e3);
    return CLI_OK;
}

static int make_scene(run_state *s, const t3r_capture_frame *frame)
{
    capture_account *a = s->account;
    int code = live_build_make(&s->build, frame);
    if (code != CLI_OK) {
        return code;
    }
    const reconstruction *r = &s->build.r;
    latency_add(&a->building, (r->add_views_seconds + r->build_seconds) * 1e3);
    a->builds++;
    a->gaussians = r->scene.count;
    a->valid_points = r->valid_points;
    a->context_count = r->context_count;
    memcpy(a->context, r->context, sizeof a->context);
    a->scene_hash = reconstruction_hash(r);
    /* repeated builds write a scene only at the end, because writing allocates */
    return s->plan->every > 0 ? CLI_OK : write_scene(s);
}

static int build_chosen(run_state *s, const t3r_capture_frame *frame)
{
    uint32_t wanted = context_at(s->plan, s->next_context);
    if (s->built_once || frame->index < wanted) {
        return CLI_OK;
    }
    const char *lacks = live_build_lacks(frame);
    if (frame->index > wanted || lacks != NULL) {
        return cli_error(CLI_BAD_INPUT, "frame %" PRIu32 " of --context %s%s", wanted,
                         frame->index > wanted ? "could not be read" : "has no ", frame->index > wanted ? "" : lacks);
    }
    if (++s->next_context < views_of(s->plan)) {
        return live_build_keep(&s->build, frame);
    }
    s->built_once = true;
    return make_scene(s, frame);
}

/* Builds with every N-th frame that is usable as context. */
static int build_repeatedly(run_state *s, const t3r_capture_frame *frame)
{
    if (live_build_lacks(frame) != NULL) {
        return CLI_OK;
    }
    if (s->build.kept_count > 0 && ++s->since_build < s->plan->every) {
        return CLI_OK;
    }
    s->since_build = 0;
    int code = s->build.kept_count > 0 ? make_scene(s, frame) : CLI_OK;
    return code == CLI_OK ? live_build_keep(&s->build, frame) : code;
}

/* Offers a frame to the map that follows the camera. Frames that it refuses, or that lack something, change nothing. */
static int follow(run_state *s, const t3r_capture_frame *frame)
{
    const capture_plan *plan = s->plan;
    capture_account *a = s->account;
    live_stream *stream = &s->stream;
    live_row row;
    int code = CLI_OK;
    if (live_build_lacks(frame) != NULL) {
        return CLI_OK;
    }
    if (!stream->is_open) {
        clear_line(s);
        code = live_stream_open(stream, plan->build, plan->stream, frame, plan->prints_table);
        a->arena_bytes = stream->map.r.arena_bytes;
    }
    if (code != CLI_OK || !live_map_frame(&stream->map, frame, &row)) {
        return code;
    }
    if (live_row_is_taken(&row)) {
        latency_add(&a->building, row.milliseconds);
        a->builds++;
        a->gaussians = row.report.gaussians;
        a->scene_hash = row.hash;
    }
    clear_line(s);
    return live_stream_row(stream, &row);
}

static int take_into_scene(run_state *s, const t3r_capture_frame *frame)
{
    return s->plan->stream != NULL ? follow(s, frame)
           : s->plan->every > 0    ? build_repeatedly(s, frame)
                                   : build_chosen(s, frame);
}

static int handle(run_state *s, t3r_capture_frame *frame)
{
    const capture_plan *plan = s->plan;
    capture_account *a = s->account;
    int code = complete(s, frame);
    if (code == CLI_OK && a->frames == 0) {
        a->width = frame->frame.width;
        a->height = frame->frame.height;
        a->format = frame->frame.format;
        s->first_seconds = cli_now();
    }
    if (code == CLI_OK) {
        code = open_build(s, frame);
    }
    double start = cli_now();
    if (code == CLI_OK && s->record != NULL && capture_record_frame(s->record, frame) != 0) {
        code = cli_error(CLI_BAD_INPUT, "%s", s->record->error);
    }
    if (s->record != NULL) {
        latency_add(&a->recording, (cli_now() - start) * 1e3);
    }
    if (code == CLI_OK && plan->build != NULL) {
        code = take_into_scene(s, frame);
    }
    if (code != CLI_OK) {
        return code;
    }
    double end = cli_now();
    latency_add(&a->work, (end - start) * 1e3);
    const char *clock = t3r_capture_clock(s->capture);
    bool ours = strcmp(clock, "monotonic") == 0 || strcmp(clock, "arrival") == 0 || strcmp(clock, "boottime") == 0;
    if (ours && !t3r_capture_recorded(s->capture)) {
        int64_t now = clock_now_ns(clock[0] == 'b' ? CLOCK_BOOTTIME : CLOCK_MONOTONIC);
        double ms = (double)(now - frame->stamp_ns) * 1e-6;
        if (ms >= 0 && ms < 60000) { /* else the driver's clock is not the one that it reports */
            latency_add(&a->late, ms);
        }
    }
    if (plan->hash) {
        a->frames_hash = capture_frame_hash(a->frames_hash, frame);
    }
    a->frames++;
    a->seconds = end - s->first_seconds;
    draw_line(s);
    return CLI_OK;
}

/* ---- the loop ---- */

/* Waits for a lost device. Returns CLI_OK when it is back, or when it is time to stop. The time counts from the first
 * loss since its last frame: a device that reopens again and again without a frame is not back. */
static int reconnect(run_state *s)
{
    double now = cli_now();
    s->lost_since = s->lost_since > 0 ? s->lost_since : now;
    double until = s->lost_since + s->plan->reconnect_seconds;
    for (;;) {
        int got = now >= until && now > s->lost_since ? T3R_CAPTURE_END : t3r_capture_reopen(s->capture);
        if (got == T3R_CAPTURE_FRAME || stopped(s->plan)) {
            return CLI_OK;
        }
        now = cli_now();
        if (got == T3R_CAPTURE_END || now >= until) {
            clear_line(s);
            return cli_error(CLI_BAD_INPUT, "%s: lost, and not back within %g s: %s", s->plan->source,
                             s->plan->reconnect_seconds, t3r_capture_error(s->capture));
        }
        nanosleep(&(struct timespec){0, RETRY_NS}, NULL);
    }
}

static int loop(run_state *s)
{
    const capture_plan *plan = s->plan;
    double start = cli_now();
    int code = CLI_OK;
    while (code == CLI_OK && !stopped(plan) && (plan->frames == 0 || s->account->frames < plan->frames) &&
           !(plan->seconds > 0 && cli_now() - start >= plan->seconds)) {
        t3r_capture_frame frame;
        int got = t3r_capture_next(s->capture, &frame);
        code = s->code;
        if (code != CLI_OK || got == T3R_CAPTURE_END) {
            break;
        }
        if (got == T3R_CAPTURE_FRAME) {
            s->failed_in_row = 0;
            s->lost_since = 0;
            code = handle(s, &frame);
        } else if (got == T3R_CAPTURE_LOST) {
            code = reconnect(s);
        } else if (got == T3R_CAPTURE_FAILED) {
            s->account->failed++;
            if (s->failed_in_row++ == 0 || s->failed_in_row >= MOST_FAILED) {
                clear_line(s);
                fprintf(stderr, "trim3r capture: %s\n", t3r_capture_error(s->capture));
            }
            code = s->failed_in_row < MOST_FAILED
                       ? CLI_OK
                       : cli_error(CLI_BAD_INPUT, "%s: %u frames in a row cannot be read", plan->source, MOST_FAILED);
        }
    }
    if (code == CLI_OK && s->account->frames == 0) {
        code = cli_error(CLI_BAD_INPUT, "%s: gave no frame", plan->source);
    }
    if (code == CLI_OK && plan->build != NULL && s->account->builds == 0) {
        code = cli_error(CLI_BAD_INPUT, "%s: ended before %s: nothing was built", plan->source,
                         plan->stream != NULL ? "the first keyframe" : "all context frames were there");
    }
    return code;
}

static int begin_record(run_state *s)
{
    const capture_plan *plan = s->plan;
    if (plan->output == NULL) {
        return CLI_OK;
    }
    s->record = malloc(sizeof *s->record);
    if (s->record == NULL) {
        return cli_error(CLI_BAD_INPUT, "out of memory");
    }
    if (capture_record_begin(s->record, plan->output, plan->max_bytes, plan->sync, plan->source,
                             t3r_capture_clock(s->capture), t3r_capture_depth_unit_q40(s->capture),
                             &plan->stored) == 0) {
        return CLI_OK;
    }
    int code = cli_error(CLI_BAD_INPUT, "%s", s->record->error);
    capture_record_end(s->record);
    free(s->record);
    s->record = NULL;
    return code;
}

int capture_run(t3r_capture *capture, const capture_plan *plan, capture_account *account)
{
    run_state s = {.capture = capture, .plan = plan, .account = account};
    *account = (capture_account){.frames_hash = T3R_HASH_START};
    int code = begin_record(&s);
    if (code != CLI_OK) {
        return code;
    }
    t3r_capture_listen(capture, hear, &s);
    code = loop(&s);
    t3r_capture_listen(capture, NULL, NULL);
    clear_line(&s);
    if (s.record != NULL) {
        if (capture_record_end(s.record) != 0 && code == CLI_OK) {
            code = cli_error(CLI_BAD_INPUT, "%s", s.record->error);
        }
        account->files = s.record->files;
        account->bytes = s.record->bytes;
        free(s.record);
    }
    const double save_start = cli_now();
    const int saved = live_stream_save(&s.stream); /* also after an error of the camera */
    code = code == CLI_OK ? saved : code;
    if (s.stream.is_open) {
        latency_add(&account->writing, (cli_now() - save_start) * 1e3);
    }
    live_stream_close(&s.stream);
    if (s.building) {
        if (code == CLI_OK && plan->every > 0 && account->builds > 0) {
            code = write_scene(&s);
        }
        live_build_close(&s.build);
    }
    account->counts = t3r_capture_counts_of(capture);
    return code;
}
