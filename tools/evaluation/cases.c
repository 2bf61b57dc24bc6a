/* SPDX-License-Identifier: Apache-2.0 */
#include "evaluation/cases.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/cli.h"
#include "cli/files/recorded_frame.h"
#include "host/text.h"
#include "import/estimation/recording_poses.h"
#include "import/folders/planar_recording.h"
#include "import/import_source.h"
#include "reconstruction/context/context_frames.h"
#include "reconstruction/context/nearest_views.h"
#include "reconstruction/context_points.h"

/* ---- names ------------------------------------------------------------------------------------------------------ */

/* "room" of "recordings/room.mcap", or "recordings-room" with two parts of the path; at most `bytes` - 1 characters. */
static void scene_name(const char *path, uint32_t parts, char *name, size_t bytes)
{
    const char *start = path + strlen(path);
    for (uint32_t seen = 0; start > path; start--) {
        if (start[-1] == '/' && start[0] != '/' && start[0] != '\0' && ++seen == parts) {
            break;
        }
    }
    t3r_text_copy(name, bytes, t3r_text_of(start)); /* cut between characters, or no table could be read */
    char *dot = strrchr(name, '.');
    if (dot != NULL && dot != name && strchr(dot, '/') == NULL) {
        *dot = '\0';
    }
    for (char *c = name; *c != '\0'; c++) {
        if (*c == '/') {
            *c = '-';
        }
    }
}

/* Finds the first pair of inputs that would share a name; false = all differ. */
static bool share_name(char *const *inputs, uint32_t count, uint32_t parts, uint32_t pair[2])
{
    char name[EVALUATION_NAME_BYTES], other[EVALUATION_NAME_BYTES];
    for (uint32_t i = 1; i < count; i++) {
        scene_name(inputs[i], parts, name, sizeof name);
        for (uint32_t earlier = 0; earlier < i; earlier++) {
            scene_name(inputs[earlier], parts, other, sizeof other);
            if (strcmp(name, other) == 0) {
                pair[0] = earlier;
                pair[1] = i;
                return true;
            }
        }
    }
    return false;
}

uint32_t evaluation_name_parts(char *const *inputs, uint32_t count, uint32_t pair[2])
{
    for (uint32_t parts = 1; parts <= EVALUATION_NAME_PARTS_MOST; parts++) {
        if (!share_name(inputs, count, parts, pair)) {
            return parts;
        }
    }
    return 0;
}

/* ---- the list --------------------------------------------------------------------------------------------------- */

static int begin(evaluation_cases *cases, char **inputs, uint32_t count)
{
    *cases = (evaluation_cases){.inputs = inputs, .input_count = count};
    cases->names = calloc(count, sizeof *cases->names);
    cases->recordings = calloc(count, sizeof(t3r_recording *));
    if (cases->names == NULL || cases->recordings == NULL) {
        return cli_error(CLI_BAD_INPUT, "out of memory");
    }
    uint32_t pair[2], parts = evaluation_name_parts(inputs, count, pair);
    for (uint32_t i = 0; i < count; i++) {
        scene_name(inputs[i], parts, cases->names[i], EVALUATION_NAME_BYTES);
    }
    return CLI_OK;
}

static int open_recordings(evaluation_cases *cases)
{
    for (uint32_t i = 0; i < cases->input_count; i++) {
        cases->recordings[i] = import_source_open(cases->inputs[i]);
        if (cases->recordings[i] == NULL) {
            return CLI_BAD_INPUT;
        }
        const int code = recorded_frames_check(cases->recordings[i], cases->inputs[i]);
        if (code != CLI_OK) {
            return code;
        }
    }
    return CLI_OK;
}

/* A triplet of a stereo pair names its one context view twice. */
static void set_context(evaluation_case *what, const uint32_t *frames, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        bool known = false;
        for (uint32_t v = 0; v < what->context_count; v++) {
            known = known || what->context[v] == frames[i];
        }
        if (!known) {
            what->context[what->context_count++] = frames[i];
        }
    }
}

static int list_triplets(evaluation_cases *cases)
{
    uint32_t total = 0;
    for (uint32_t i = 0; i < cases->input_count; i++) {
        uint32_t triplets = t3r_recording_triplet_count(cases->recordings[i]);
        total += triplets;
        if (triplets == 0) {
            return cli_error(CLI_BAD_INPUT, "%s: the recording carries no triplets; give --context and --target",
                             cases->inputs[i]);
        }
    }
    cases->list = calloc(total, sizeof *cases->list);
    if (cases->list == NULL) {
        return cli_error(CLI_BAD_INPUT, "out of memory");
    }
    for (uint32_t i = 0; i < cases->input_count; i++) {
        for (uint32_t t = 0; t < t3r_recording_triplet_count(cases->recordings[i]); t++) {
            t3r_triplet triplet = t3r_recording_triplet(cases->recordings[i], t);
            evaluation_case *what = &cases->list[cases->count++];
            *what = (evaluation_case){.recording = cases->recordings[i],
                                      .path = cases->inputs[i],
                                      .scene = cases->names[i],
                                      .target = triplet.target};
            set_context(what, triplet.context, 2);
        }
    }
    return CLI_OK;
}

static int list_given(evaluation_cases *cases, const reconstruction_options *settings, uint32_t target)
{
    cases->list = calloc(cases->input_count, sizeof *cases->list);
    if (cases->list == NULL) {
        return cli_error(CLI_BAD_INPUT, "out of memory");
    }
    for (; cases->count < cases->input_count; cases->count++) {
        uint32_t context[T3R_MAX_VIEWS], count;
        evaluation_case *what = &cases->list[cases->count];
        const int code = context_frames(cases->recordings[cases->count], cases->inputs[cases->count], settings, target,
                                        context, &count);
        if (code != CLI_OK) {
            return code;
        }
        *what = (evaluation_case){.recording = cases->recordings[cases->count],
                                  .path = cases->inputs[cases->count],
                                  .scene = cases->names[cases->count],
                                  .target = target};
        set_context(what, context, count);
    }
    return CLI_OK;
}

/* ---- more views ------------------------------------------------------------------------------------------------- */

static int find_places(const t3r_recording *recording, const char *path, view_place *places, uint32_t count,
                       t3r_depth depth)
{
    char error[512] = "";
    for (uint32_t i = 0; i < count; i++) {
        t3r_capture_frame frame;
        if (t3r_recording_frame(recording, i, &frame, error, sizeof error) != T3R_CAPTURE_FRAME) {
            return cli_error(CLI_BAD_INPUT, "%s: frame %" PRIu32 ": %s", path, i, error);
        }
        places[i] = (view_place){.usable = false};
        if (frame.has_pose && frame.has_intrinsics) {
            places[i] = view_place_of(&frame.camera);
            places[i].usable = depth == T3R_DEPTH_STEREO || frame.frame.depth != NULL;
        }
    }
    return CLI_OK;
}

/* Finds the median depth: from the first frame's measurements, or by stereo of the case's own frames. */
static int find_depth(const evaluation_case *what, const t3r_capture_frame *first,
                      const reconstruction_options *settings, double *depth)
{
    *depth = first->frame.depth == NULL ? 0 : view_median_depth(&first->frame);
    if (*depth > 0) {
        return CLI_OK;
    }
    if (settings->config.depth == T3R_DEPTH_STEREO) {
        reconstruction_options options = *settings;
        reconstruction_points points;
        options.context_count = what->context_count;
        memcpy(options.context, what->context, sizeof options.context);
        int code = reconstruction_count(&points, what->recording, what->path, &options);
        *depth = code == CLI_OK ? points.depth : 0;
        return code;
    }
    return cli_error(CLI_BAD_INPUT, "%s: frame %" PRIu32 " has no depth to measure the distance of views by",
                     what->path, what->context[0]);
}

/* Fills a case's context. Of several cases, one without a known depth is left unchanged: it will be refused later, for
 * the same reason. */
static int fill_context(evaluation_case *what, const view_place *places, uint32_t count,
                        const reconstruction_options *settings, bool alone)
{
    const uint32_t views = settings->context_views;
    double depth;
    t3r_capture_frame first, target;
    int code = recorded_frame_read(what->recording, what->path, what->context[0], &first);
    code = code == CLI_OK ? recorded_frame_read(what->recording, what->path, what->target, &target) : code;
    if (code != CLI_OK) {
        return code;
    }
    char dropped[1];
    cli_keep_errors(alone ? NULL : dropped, sizeof dropped);
    code = find_depth(what, &first, settings, &depth);
    cli_keep_errors(NULL, 0);
    if (code != CLI_OK) {
        return alone ? code : CLI_OK;
    }
    uint32_t own = what->context_count;
    what->context_count = nearest_views(places, count, what->target, depth, views, what->context, own);
    if (what->context_count < views) {
        return cli_error(CLI_BAD_INPUT,
                         "%s: --views %" PRIu32 " is too much: beside target %" PRIu32 " there are %" PRIu32
                         " frames with %spose and intrinsics",
                         what->path, views, what->target, what->context_count,
                         settings->config.depth == T3R_DEPTH_STEREO ? "" : "depth, ");
    }
    return CLI_OK;
}

static int fill_contexts(evaluation_cases *cases, const reconstruction_options *settings)
{
    view_place *places = NULL;
    const t3r_recording *known = NULL;
    int code = CLI_OK;
    for (uint32_t i = 0; i < cases->count && code == CLI_OK; i++) {
        evaluation_case *what = &cases->list[i];
        uint32_t count = t3r_recording_frame_count(what->recording);
        if (what->recording != known) { /* the cases of a recording are consecutive */
            free(places);
            places = calloc(count + 1, sizeof *places);
            known = what->recording;
            code = places == NULL ? cli_error(CLI_BAD_INPUT, "out of memory")
                                  : find_places(known, what->path, places, count, settings->config.depth);
        }
        code = code == CLI_OK ? fill_context(what, places, count, settings, cases->count == 1) : code;
    }
    free(places);
    return code;
}

int evaluation_cases_of_recordings(evaluation_cases *cases, char **inputs, uint32_t count,
                                   const reconstruction_options *settings, uint32_t target)
{
    int code = begin(cases, inputs, count);
    cases->poses = settings->poses;
    code = code == CLI_OK ? open_recordings(cases) : code;
    if (code == CLI_OK) {
        code = reconstruction_names_context(settings) ? list_given(cases, settings, target) : list_triplets(cases);
    }
    return code == CLI_OK && settings->context_views > 2 ? fill_contexts(cases, settings) : code;
}

int evaluation_cases_of_images(evaluation_cases *cases, char **inputs, uint32_t count, uint32_t width, uint32_t height)
{
    int code = begin(cases, inputs, count);
    cases->planar = true;
    cases->width = width;
    cases->height = height;
    cases->list = calloc(count, sizeof *cases->list);
    if (code == CLI_OK && cases->list == NULL) {
        code = cli_error(CLI_BAD_INPUT, "out of memory");
    }
    for (uint32_t i = 0; i < count && code == CLI_OK; i++) {
        cases->list[cases->count++] =
            (evaluation_case){.path = inputs[i], .scene = cases->names[i], .context_count = 1, .planar = true};
    }
    return code;
}

void evaluation_cases_close(evaluation_cases *cases)
{
    for (uint32_t i = 0; i < cases->input_count && cases->recordings != NULL; i++) {
        if (cases->recordings[i] != NULL) {
            t3r_recording_close(cases->recordings[i]);
        }
    }
    free(cases->recordings);
    free(cases->names);
    free(cases->list);
    *cases = (evaluation_cases){0};
}

/* Opens the case's recording again, because its frames are targets of other cases; NULL after a message. */
static t3r_recording *posed_anew(const evaluation_case *what, poses_source source)
{
    pose_account accounts[T3R_MAX_VIEWS];
    t3r_recording *recording = import_source_open(what->path);
    if (recording != NULL &&
        recording_pose_views(recording, what->path, what->context, what->context_count, source, accounts) != CLI_OK) {
        t3r_recording_close(recording);
        recording = NULL;
    }
    return recording;
}

int evaluation_case_enter(evaluation_entered *entered, const evaluation_cases *cases, uint32_t index)
{
    *entered = (evaluation_entered){.what = cases->list[index]};
    if (cases->planar) {
        entered->own = planar_recording(cases->inputs[index], cases->width, cases->height, &entered->bytes);
    } else if (cases->poses != POSES_GIVEN) {
        entered->what.recorded = entered->what.recording;
        entered->own = posed_anew(&entered->what, cases->poses);
    } else {
        return CLI_OK;
    }
    entered->what.recording = entered->own;
    return entered->own != NULL ? CLI_OK : CLI_BAD_INPUT;
}

void evaluation_case_leave(evaluation_entered *entered)
{
    if (entered->own != NULL) {
        t3r_recording_close(entered->own);
    }
    free(entered->bytes);
    *entered = (evaluation_entered){0};
}
