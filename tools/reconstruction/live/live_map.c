/* SPDX-License-Identifier: Apache-2.0 */
#include "reconstruction/live/live_map.h"

#include <math.h>

#include "cli/cli.h"
#include "core/config.h"
#include "reconstruction/reconstruction_error.h"

/* ---- opening ----------------------------------------------------------------------------------------------------- */

static int watch(void *user, t3r_stage stage, uint32_t done, uint32_t total)
{
    live_map *map = user;
    if (!map->quiet) {
        cli_progress(t3r_stage_name(stage), done, total);
    }
    return stage == T3R_STAGE_REFINE && !pass_budget_goes_on(&map->budget, done, total);
}

static t3r_status set_hooks(live_map *map)
{
    t3r_hooks hooks = reconstruction_hooks(&map->r, &map->settings);
    hooks.progress = watch;
    return t3r_set_hooks(map->r.runtime, &hooks);
}

static void begin(live_map *map, const reconstruction_options *settings, const live_options *options)
{
    *map = (live_map){.settings = *settings, .options = *options, .budget = {.most = options->most_ms / 1000}};
    map->options.every = options->every > 0 ? options->every : LIVE_EVERY;
    map->options.at_hand = options->at_hand > 0 ? options->at_hand : LIVE_AT_HAND;
}

/* Completes a map whose arena is open. */
static int complete(live_map *map)
{
    (void)set_hooks(map);
    const t3r_config *c = &map->r.config;
    const int code = map->options.lines != NULL ? drawn_frame_open(&map->before, c->width, c->height) : CLI_OK;
    if (code != CLI_OK) {
        live_map_close(map);
    }
    return code;
}

int live_map_open_recorded(live_map *map, const t3r_recording *recording, const char *path,
                           const reconstruction_options *settings, const live_options *options)
{
    begin(map, settings, options);
    map->settings.context_count = t3r_recording_frame_count(recording) > map->options.every ? 2 : 1;
    map->settings.context[0] = 0;
    map->settings.context[1] = map->options.every;
    const int code = reconstruction_stream(&map->r, recording, path, &map->settings, map->options.at_hand);
    return code == CLI_OK ? complete(map) : code;
}

int live_map_open(live_map *map, const reconstruction_options *settings, const live_options *options)
{
    begin(map, settings, options);
    const int code = reconstruction_live_stream(&map->r, settings->config.width, settings->config.height,
                                                &map->settings, map->options.at_hand);
    return code == CLI_OK ? complete(map) : code;
}

int live_map_attach(live_map *map)
{
    const int code = reconstruction_attach(&map->r, &map->settings);
    (void)set_hooks(map);
    return code;
}

void live_map_close(live_map *map)
{
    drawn_frame_close(&map->before);
    reconstruction_close(&map->r);
}

/* ---- frames ------------------------------------------------------------------------------------------------------ */

/* Whether a keyframe is due: at the interval, and when the overlap with the last keyframe is small. */
static t3r_status is_due(const live_map *map, const t3r_capture_frame *frame, bool *due)
{
    *due = map->keyframes == 0 || map->since >= map->options.every;
    if (*due || map->options.overlap_q8 == 0) {
        return T3R_OK;
    }
    uint32_t overlap_q8;
    const t3r_status status =
        t3r_stream_overlap(map->r.runtime, &frame->camera, frame->frame.width, frame->frame.height, &overlap_q8);
    *due = status != T3R_OK || overlap_q8 < map->options.overlap_q8;
    return status;
}

static double score_before(live_map *map, const t3r_capture_frame *frame)
{
    drawn_frame *d = &map->before;
    map->r.uncounted = true; /* the hashes do not depend on whether lines are written */
    const bool drawn = d->runtime != NULL && map->keyframes > 0 && frame->frame.depth != NULL &&
                       drawn_frame_draw(d, &map->r, frame, DRAWN_WITH_ALPHA) == T3R_OK;
    map->r.uncounted = false;
    return drawn ? drawn_frame_psnr(d) : NAN;
}

static void describe(const t3r_capture_frame *frame, live_row *row)
{
    *row = (live_row){.frame = frame->index, .stamp_ns = frame->stamp_ns};
    for (int i = 0; i < 3; i++) {
        row->position[i] = (double)frame->camera.position_q32[i] / 0x1p32;
    }
    for (int i = 0; i < 4; i++) {
        row->rotation[i] = frame->camera.rotation_q30[i] / 0x1p30;
    }
}

static void take(live_map *map, const t3r_capture_frame *frame, live_row *row)
{
    const t3r_config *config = &map->r.config;
    row->psnr_before = score_before(map, frame);
    stage_times_begin(&map->r.stages, config->workers);
    const double start = cli_now();
    pass_budget_begin(&map->budget, t3r_keyframe_passes_of(config, config->warm && map->keyframes > 0));
    row->status = t3r_stream_keyframe(map->r.runtime, &frame->frame, &frame->camera, &row->report);
    row->milliseconds = (cli_now() - start) * 1000;
    row->passes = row->passes_planned = map->budget.planned;
    if (row->status == T3R_ERR_CANCELLED &&
        row->report.keyframes > 0) { /* taken, without the passes that are missing */
        row->passes = map->budget.pass;
        row->status = T3R_OK;
    }
    if (!live_row_is_taken(row)) {
        row->passes = row->passes_planned = 0;
        return;
    }
    row->stages = map->r.stages;
    row->hash = map->settings.hash && map->options.most_ms <= 0 ? reconstruction_hash(&map->r) : 0;
    map->keyframes = row->report.keyframes;
    map->since = 0;
}

bool live_map_frame(live_map *map, const t3r_capture_frame *frame, live_row *row)
{
    bool due;
    map->since++;
    describe(frame, row);
    row->psnr_before = NAN;
    row->status = is_due(map, frame, &due);
    if (due && row->status == T3R_OK) {
        take(map, frame, row);
        cli_progress_end();
    }
    return due;
}
