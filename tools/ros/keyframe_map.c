/* SPDX-License-Identifier: Apache-2.0 */
#include "ros/keyframe_map.h"

#include <stdlib.h>

#include "cli/cli.h"
#include "host/reason.h"
#include "reconstruction/live/live_map.h"
#include "reconstruction/live/live_output.h"
#include "scene/scene_file.h"

struct keyframe_map {
    live_map map;
    live_output output;
    uint32_t frames; /* so far */
};

keyframe_map_settings keyframe_map_defaults(void)
{
    const t3r_config config = t3r_default_config(256, 256, 1, 1);
    return (keyframe_map_settings){
        .width = config.width,
        .height = config.height,
        .gaussians = LIVE_GAUSSIANS,
        .at_hand = LIVE_AT_HAND,
        .every = LIVE_EVERY,
        .half_life = config.half_life,
        .gate = config.gate,
        .remember = config.remember,
        .refine = T3R_STREAM_REFINE,
        .threads = 1,
        .head = CHOSEN_HEAD_DEFAULT,
    };
}

/* Returns NULL, or the setting that no later check would find. */
static const char *settings_error(const keyframe_map_settings *s)
{
    return s->every == 0                                             ? "every is 0"
           : s->overlap_percent > 100                                ? "overlap is more than 100"
           : s->threads == 0 || s->threads > T3R_MAX_WORKERS         ? "threads is out of range"
           : s->at_hand == 0                                         ? "at_hand is 0"
           : !(s->max_ms >= 0)                                       ? "max_ms is negative"
           : s->resume && s->state == NULL                           ? "resume needs state"
           : s->snapshot > 0 && s->scene == NULL && s->state == NULL ? "snapshot needs scene or state"
           : !chosen_head_is_one(s->head)                            ? "head names no head"
                                                                     : NULL;
}

static int open_stream(keyframe_map *map, const keyframe_map_settings *s)
{
    const live_options live = {.every = s->every,
                               .overlap_q8 = s->overlap_percent * 256 / 100,
                               .at_hand = s->at_hand,
                               .most_ms = s->max_ms,
                               .scene = s->scene,
                               .snapshot = s->snapshot,
                               .state = s->state,
                               .resume = s->resume,
                               .lines = s->lines};
    reconstruction_options options;
    live_state state = {0};
    bool resumed;
    char suffixes[SCENE_FILE_SUFFIXES_BYTES];
    reconstruction_defaults(&options);
    options.gaussians = s->gaussians;
    options.head = s->head;
    options.processor.threads = s->threads;
    options.config.width = s->width;
    options.config.height = s->height;
    options.config.half_life = s->half_life;
    options.config.gate = s->gate;
    options.config.remember = s->remember;
    options.config.refine = s->refine;
    options.config.fit_passes = 0; /* exactly as many as set */
    options.config.warm = s->warm;
    if (s->scene != NULL && !scene_file_is_written(s->scene)) {
        return cli_error(CLI_BAD_USAGE, "%s: scenes end in %s", s->scene, scene_file_suffixes(suffixes));
    }
    int code = live_map_open(&map->map, &options, &live);
    if (code != CLI_OK) {
        return code;
    }
    map->map.quiet = true;
    code = live_output_open(&map->output, &map->map, false, &state, &resumed);
    free(state.more);
    return code;
}

keyframe_map *keyframe_map_open(const keyframe_map_settings *settings, char *error, size_t error_bytes)
{
    const char *wrong = settings_error(settings);
    keyframe_map *map = wrong == NULL ? calloc(1, sizeof *map) : NULL;
    if (map == NULL) {
        t3r_reason(error, error_bytes, "%s", wrong != NULL ? wrong : "out of memory");
        return NULL;
    }
    cli_keep_errors(error, error_bytes);
    const int code = open_stream(map, settings);
    cli_keep_errors(NULL, 0);
    if (code != CLI_OK) {
        keyframe_map_close(map);
        return NULL;
    }
    return map;
}

void keyframe_map_close(keyframe_map *map)
{
    if (map != NULL) {
        live_output_close(&map->output);
        live_map_close(&map->map);
        free(map);
    }
}

size_t keyframe_map_arena_bytes(const keyframe_map *map)
{
    return map->map.r.arena_bytes;
}

t3r_status keyframe_map_frame(keyframe_map *map, int64_t stamp_ns, const t3r_frame *frame, const t3r_camera *camera,
                              keyframe_map_report *report, char *error, size_t error_bytes)
{
    const t3r_capture_frame captured = {.index = map->frames++,
                                        .stamp_ns = stamp_ns,
                                        .has_pose = true,
                                        .has_intrinsics = true,
                                        .frame = *frame,
                                        .camera = *camera};
    live_row row;
    *report = (keyframe_map_report){0};
    error[0] = '\0';
    if (!live_map_frame(&map->map, &captured, &row)) {
        return T3R_OK;
    }
    cli_keep_errors(error, error_bytes);
    if (live_output_row(&map->output, &map->map, &row) == CLI_OK) {
        (void)live_output_snapshot(&map->output, &map->map, &row, NULL, 0);
    }
    cli_keep_errors(NULL, 0);
    if (live_row_is_taken(&row)) {
        *report = (keyframe_map_report){true, row.hash, row.milliseconds, row.report};
    }
    return row.status;
}

t3r_status keyframe_map_scene(const keyframe_map *map, t3r_scene *scene)
{
    return t3r_get_scene(map->map.r.runtime, scene);
}

int keyframe_map_save(keyframe_map *map, char *error, size_t error_bytes)
{
    if (map->map.keyframes == 0) {
        return t3r_reason(error, error_bytes, "there is no scene yet");
    }
    cli_keep_errors(error, error_bytes);
    const int code = live_output_snapshot(&map->output, &map->map, NULL, NULL, 0);
    cli_keep_errors(NULL, 0);
    return code == CLI_OK ? 0 : -1;
}
