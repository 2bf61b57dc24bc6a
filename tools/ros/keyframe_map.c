/* SPDX-License-Identifier: Apache-2.0 */
#include "ros/keyframe_map.h"

#include <stdlib.h>

#include "cli/cli.h"
#include "host/reason.h"
#include "reconstruction/reconstruction.h"
#include "scene/scene_file.h"

struct keyframe_map {
    reconstruction r;
    uint32_t every, overlap_q8;
    uint32_t since; /* frames since the last keyframe, which counts as 0 */
    bool begun;
};

keyframe_map_settings keyframe_map_defaults(void)
{
    const t3r_config config = t3r_default_config(256, 256, 1, 1);
    return (keyframe_map_settings){
        .width = config.width,
        .height = config.height,
        .gaussians = 10000,
        .at_hand = 4,
        .every = 3,
        .half_life = config.half_life,
        .remember = config.remember,
        .refine = T3R_STREAM_REFINE,
        .threads = 1,
        .head = CHOSEN_HEAD_DEFAULT,
    };
}

/* Returns NULL, or the setting that no later check would find. */
static const char *settings_error(const keyframe_map_settings *s)
{
    return s->every == 0                                     ? "every is 0"
           : s->overlap_percent > 100                        ? "overlap is more than 100"
           : s->threads == 0 || s->threads > T3R_MAX_WORKERS ? "threads is out of range"
           : s->at_hand == 0                                 ? "at_hand is 0"
           : !chosen_head_is_one(s->head)                    ? "head names no head"
                                                             : NULL;
}

static int open_stream(keyframe_map *map, const keyframe_map_settings *settings)
{
    reconstruction_options options;
    reconstruction_defaults(&options);
    options.gaussians = settings->gaussians;
    options.head = settings->head;
    options.processor.threads = settings->threads;
    options.config.half_life = settings->half_life;
    options.config.remember = settings->remember;
    options.config.refine = settings->refine;
    options.config.fit_passes = 0; /* exactly as many as set */
    options.config.warm = settings->warm;
    int code = reconstruction_live_stream(&map->r, settings->width, settings->height, &options, settings->at_hand);
    if (code == CLI_OK) {
        const t3r_hooks silent = reconstruction_hooks(&map->r, &options);
        (void)t3r_set_hooks(map->r.runtime, &silent);
    }
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
    map->every = settings->every;
    map->overlap_q8 = settings->overlap_percent * 256 / 100;
    cli_keep_errors(error, error_bytes);
    const int code = open_stream(map, settings);
    cli_keep_errors(NULL, 0);
    if (code != CLI_OK) {
        free(map);
        return NULL;
    }
    return map;
}

void keyframe_map_close(keyframe_map *map)
{
    if (map != NULL) {
        reconstruction_close(&map->r);
        free(map);
    }
}

size_t keyframe_map_arena_bytes(const keyframe_map *map)
{
    return map->r.arena_bytes;
}

/* Whether a keyframe is due: at the interval, and when the overlap with the last keyframe is small. */
static t3r_status is_due(const keyframe_map *map, const t3r_frame *frame, const t3r_camera *camera, bool *due)
{
    *due = !map->begun || map->since >= map->every;
    if (*due || map->overlap_q8 == 0) {
        return T3R_OK;
    }
    uint32_t overlap_q8;
    const t3r_status status = t3r_stream_overlap(map->r.runtime, camera, frame->width, frame->height, &overlap_q8);
    *due = status == T3R_OK && overlap_q8 < map->overlap_q8;
    return status;
}

t3r_status keyframe_map_frame(keyframe_map *map, const t3r_frame *frame, const t3r_camera *camera,
                              keyframe_map_report *report)
{
    *report = (keyframe_map_report){0};
    map->since++;
    bool due;
    t3r_status status = is_due(map, frame, camera, &due);
    if (status != T3R_OK || !due) {
        return status;
    }
    t3r_stream_report taken;
    const double start = cli_now();
    status = t3r_stream_keyframe(map->r.runtime, frame, camera, &taken);
    if (status != T3R_OK) {
        return status;
    }
    const bool keyframe = taken.refusal == T3R_REFUSAL_NONE;
    *report = (keyframe_map_report){keyframe, reconstruction_hash(&map->r), (cli_now() - start) * 1000, taken};
    if (!keyframe) {
        return T3R_OK;
    }
    map->begun = true;
    map->since = 0;
    return T3R_OK;
}

t3r_status keyframe_map_scene(const keyframe_map *map, t3r_scene *scene)
{
    return t3r_get_scene(map->r.runtime, scene);
}

int keyframe_map_save(const keyframe_map *map, const char *path, char *error, size_t error_bytes)
{
    t3r_scene scene;
    const t3r_status status = keyframe_map_scene(map, &scene);
    if (status != T3R_OK) {
        return t3r_reason(error, error_bytes, "there is no scene yet: %s", t3r_error_text(status));
    }
    if (!scene_file_is_written(path)) {
        char suffixes[SCENE_FILE_SUFFIXES_BYTES];
        return t3r_reason(error, error_bytes, "%s: scenes end in %s", path, scene_file_suffixes(suffixes));
    }
    return scene_file_write(path, &scene, 0, NULL, error, error_bytes);
}
