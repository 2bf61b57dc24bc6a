/* SPDX-License-Identifier: Apache-2.0 */
/* A recording for a page, which builds scenes from its frames as `trim3r view` does without options. */
#include "recording/recording.h"

#include <inttypes.h>
#include <stdio.h>

#include "answer.h"
#include "bundle.h"
#include "camera_path.h"
#include "cli/cli.h"
#include "cli/files/recorded_frame.h"
#include "reconstruction/context/context_choice.h"
#include "trim3r_heads.h"
#include "viewpoints.h"

#define FIRST_PART 10u                  /* of the valid points in the first scene: one in so many */
#define MOST_POINTS (UINT32_C(4) << 20) /* of all context views */

/* Frames by their number in the recording. */
typedef struct frame_list {
    const uint32_t *frames;
    uint32_t count;
} frame_list;

static viewpoints shown;
static camera_path path;
static uint32_t views, valid;

/* Chooses the context frames, unless the page names some. Returns an exit status of cli.h. */
static int choose(const t3r_recording *recording, const char *name, const frame_list *named,
                  uint32_t chosen[T3R_MAX_VIEWS])
{
    if (named->count > T3R_MAX_VIEWS) {
        return cli_error(CLI_BAD_USAGE, "a scene is built from at most %u frames", T3R_MAX_VIEWS);
    }
    views = named->count;
    for (uint32_t i = 0; i < views; i++) {
        chosen[i] = named->frames[i];
        for (uint32_t before = 0; before < i; before++) {
            if (chosen[before] == chosen[i]) {
                return cli_error(CLI_BAD_USAGE, "frame %" PRIu32 " is named twice", chosen[i]);
            }
        }
    }
    return views > 0 ? CLI_OK : context_choose(recording, name, T3R_DEPTH_SENSOR, UINT32_MAX, chosen, &views);
}

/* Takes the size of the frames, or halves it until a page has memory for all of them. Returns an exit status of cli.h.
 */
static int choose_size(const t3r_recording *recording, const char *name, uint32_t chosen, t3r_config *config)
{
    t3r_capture_frame first;
    const int code = recorded_frame_read(recording, name, chosen, &first);
    if (code != CLI_OK) {
        return code;
    }
    uint32_t width = first.frame.width, height = first.frame.height;
    while ((uint64_t)width * height * views > MOST_POINTS) {
        width /= 2;
        height /= 2;
    }
    if (width < first.frame.width) {
        char remark[160];
        snprintf(remark, sizeof remark,
                 "%" PRIu32 " frames are more than a page has memory for: they are built at %" PRIu32 "x%" PRIu32
                 " (--working)",
                 views, width, height);
        answer_remark(remark);
    }
    *config = t3r_default_config(width, height, views, 1);
    return CLI_OK;
}

/* Adds the frames that the scene is built from, then those that it is compared with. */
static int add_frames(const t3r_recording *recording, const char *name, const uint32_t *chosen,
                      const frame_list *compared, t3r_config *config)
{
    int code = choose_size(recording, name, chosen[0], config);
    for (uint32_t i = 0; i < views && code == CLI_OK; i++) {
        code = viewpoints_add(&shown, recording, name, chosen[i], config->width, config->height, true);
        if (code == CLI_OK && shown.frames[i].depth == NULL) {
            code = cli_error(CLI_BAD_INPUT, "frame %" PRIu32 " has no depth", chosen[i]);
        }
    }
    for (uint32_t i = 0; i < compared->count && code == CLI_OK; i++) {
        code = viewpoints_add(&shown, recording, name, compared->frames[i], config->width, config->height, false);
    }
    uint32_t middle;
    if (code == CLI_OK && compared->count == 0 && viewpoints_middle(chosen, views, &middle)) {
        code = viewpoints_add(&shown, recording, name, middle, config->width, config->height, false);
    }
    return code;
}

/* Counts the points as a build does. */
static uint32_t count_valid(const t3r_config *config)
{
    uint32_t points = 0;
    for (uint32_t v = 0; v < views; v++) {
        for (size_t i = 0; i < (size_t)config->width * config->height; i++) {
            points += shown.frames[v].depth[i] != 0;
        }
    }
    return points;
}

/* Configures builds as `trim3r view` does. */
static void configure(t3r_config *config)
{
    const uint32_t first = (valid + FIRST_PART / 2) / FIRST_PART;
    answer.gaussians = first > 0 ? first : 1;
    config->render_width = config->width;
    config->render_height = config->height;
    config->head = T3R_HEAD_LEARNED;
    config->head_column_bytes = t3r_head_column_bytes(t3r_head_small, t3r_head_small_bytes, config->width);
    config->keep_analysis = 1;
    config->gaussians = answer.gaussians;
    config->max_gaussians = config->width * config->height * views;
}

/* Makes the bundle, which has no scene. */
static int make_bundle(const t3r_config *config)
{
    static const scene_file none;
    const bundle data = {.config = *config,
                         .weights = t3r_head_small,
                         .weight_bytes = t3r_head_small_bytes,
                         .frames = shown.frames,
                         .frame_count = shown.count,
                         .scene = &none};
    answer.bytes = (char *)bundle_bytes(&data, &answer.count);
    return answer.bytes != NULL ? CLI_OK : cli_error(CLI_BAD_INPUT, "the frames need more memory than a page has");
}

static int read_recording(const t3r_recording *recording, const char *name, const frame_list *context,
                          const frame_list *compared)
{
    uint32_t chosen[T3R_MAX_VIEWS];
    t3r_config config;
    int code = choose(recording, name, context, chosen);
    code = code == CLI_OK ? add_frames(recording, name, chosen, compared, &config) : code;
    if (code == CLI_OK) {
        camera_path_read(recording, &path);
        valid = count_valid(&config);
        configure(&config);
        code = valid > 0 ? make_bundle(&config) : cli_error(CLI_BAD_INPUT, "the context frames hold no valid depth");
    }
    return code;
}

/* Turns a recording into a bundle from which the page builds scenes, of the context frames that are listed, or of those
 * that `--context auto` chooses. Without a list of frames to compare with, that is the one in the middle of the first
 * two. Returns 0, or -1 with the reason as text. */
EXPORT(record)
int32_t files_record(const char *name, const uint8_t *bytes, uint32_t count, const uint32_t *context,
                     uint32_t context_count, const uint32_t *compared, uint32_t compared_count)
{
    t3r_recording *recording = t3r_recording_parse(bytes, count, answer.text, sizeof answer.text);
    if (recording == NULL) {
        return -1;
    }
    if (t3r_recording_note(recording)[0] != '\0') {
        answer_remark(t3r_recording_note(recording));
    }
    const int code = t3r_recording_pairing(recording).with_depth == 0
                         ? cli_error(CLI_BAD_INPUT, "its frames have no depth, and the page does not match them")
                         : read_recording(recording, name, &(frame_list){context, context_count},
                                          &(frame_list){compared, compared_count});
    t3r_recording_close(recording);
    return code == CLI_OK ? 0 : -1;
}

/* ---- what the page shows of it ----------------------------------------------------------------------------------- */

EXPORT(views) uint32_t files_views(void)
{
    return views;
}

EXPORT(valid) uint32_t files_valid(void)
{
    return valid;
}

/* Returns the number of places to look from: the context views come first. */
EXPORT(viewpoints) uint32_t files_viewpoints(void)
{
    return shown.count;
}

EXPORT(viewpoint_name) const char *files_viewpoint_name(uint32_t index)
{
    return shown.names[index];
}

/* Returns a number of a viewpoint's camera: answer_camera(). */
EXPORT(viewpoint) double files_viewpoint(uint32_t index, uint32_t number)
{
    return answer_camera(&shown.frames[index].camera, number);
}

/* Returns the number of places along the recording. */
EXPORT(places) uint32_t files_places(void)
{
    return path.count;
}

EXPORT(place) double files_place(uint32_t index, uint32_t number)
{
    return answer_camera(&path.places[index], number);
}
