/* SPDX-License-Identifier: Apache-2.0 */
#include "import/bags/recording_import.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "cli/cli.h"
#include "cli/files/whole_file.h"
#include "cli/tables/json_output.h"
#include "cli/text/wrapped.h"
#include "host/reason.h"
#include "import/bags/bag_border.h"
#include "import/bags/bag_pictures.h"
#include "import/bags/bag_size.h"
#include "import/estimation/poses_output.h"
#include "import/estimation/recording_poses.h"
#include "import/folders/posed_recording.h"
#include "messages/ros_messages.h"

#define ERROR_BYTES 1024
#define TOPIC_INDENT 21 /* columns */

/* Estimated poses: frames[] of them, and the account of each. */
typedef struct estimation {
    uint32_t *frames, *place; /* place: a frame's number in frames[] */
    uint32_t count;
    pose_account *accounts; /* NULL: poses were not estimated */
} estimation;

typedef struct made_frames {
    bag_pictures *pictures;
    bag_frames *frames;
    const estimation *estimated;
    picture_inner inner;
    bag_size size;
    bool given;     /* the intrinsics are those of the command line */
    uint32_t of[2]; /* width and height that they are for: those of the first frame; 0: none yet */
} made_frames;

/* Checks the frame's size against intrinsics that state none. */
static int check_given(made_frames *made, const t3r_capture_frame *frame, char *error, size_t error_bytes)
{
    const uint32_t width = frame->frame.width, height = frame->frame.height;
    if (made->of[0] == 0) {
        made->of[0] = width;
        made->of[1] = height;
    }
    if (made->of[0] != width || made->of[1] != height) {
        return t3r_reason(error, error_bytes, "%ux%u pixels, but --intrinsics are of the first frame's size, %ux%u",
                          width, height, made->of[0], made->of[1]);
    }
    return t3r_fixed_centre_is_within(&frame->camera, width, height)
               ? 0
               : t3r_reason(error, error_bytes, "the principal point of --intrinsics is outside its %ux%u pixels",
                            width, height);
}

/* Makes the frame to write, with its estimated pose if poses were estimated. */
static int make(void *user, uint32_t index, t3r_capture_frame *frame, char *error, size_t error_bytes)
{
    made_frames *made = user;
    const estimation *e = made->estimated;
    int status = made->given ? check_given(made, frame, error, error_bytes) : 0;
    if (status == 0) {
        status = bag_frames_make(made->frames, index, frame, error, error_bytes);
    }
    if (status == 0 && bag_pictures_hide(made->pictures, &frame->frame, frame->straightened) != 0) {
        status = t3r_reason(error, error_bytes, "out of memory");
    }
    if (status == 0) {
        status = bag_border_cut(&made->inner, frame, error, error_bytes);
    }
    if (status == 0) {
        status = bag_size_apply(&made->size, frame, error, error_bytes);
    }
    if (e->accounts != NULL && e->accounts[e->place[index]].why[0] != '\0') {
        frame->has_pose = false; /* a recorded pose would be in another world than the estimated ones */
    }
    return status;
}

/* Writes the file once. Returns 0, POSED_RECORDING_AGAIN or -1. */
static int write_once(const recording_import_request *r, const t3r_recording *recording, made_frames *frames,
                      posed_recording_losses *losses, posed_recording_totals *totals, char *error)
{
    t3r_whole_file file;
    char reason[ERROR_BYTES / 2] = "";
    bag_frames_count_anew(frames->frames);
    if (whole_file_begin(&file, r->output, error, ERROR_BYTES) != 0) {
        return -1;
    }
    int status = posed_recording_write(recording, r->source, r->stored, &(posed_recording_change){make, frames},
                                       file.stream, losses, totals, reason, sizeof reason);
    if (status == 0) {
        return t3r_whole_file_commit(&file, &totals->bytes, error, ERROR_BYTES);
    }
    t3r_whole_file_abandon(&file);
    if (status < 0) {
        t3r_reason(error, ERROR_BYTES, "%.400s: %s", r->input, reason);
    }
    return status;
}

static int write_new(const recording_import_request *r, const t3r_recording *recording, made_frames *frames,
                     posed_recording_losses *losses, posed_recording_totals *totals)
{
    char error[ERROR_BYTES] = "";
    int status;
    do {
        status = write_once(r, recording, frames, losses, totals, error);
    } while (status == POSED_RECORDING_AGAIN);
    cli_progress_end();
    return status == 0 ? CLI_OK : cli_error(CLI_BAD_INPUT, "%s", error);
}

/* Estimates the poses of all frames that can be read. */
static int estimate_all(t3r_recording *recording, const recording_import_request *r, posed_recording_losses *losses,
                        estimation *e)
{
    const uint32_t count = t3r_recording_frame_count(recording);
    *e = (estimation){.frames = malloc(((size_t)count + 1) * sizeof *e->frames),
                      .place = calloc((size_t)count + 1, sizeof *e->place),
                      .accounts = calloc((size_t)count + 1, sizeof *e->accounts)};
    if (e->frames == NULL || e->place == NULL || e->accounts == NULL) {
        return cli_error(CLI_BAD_INPUT, "out of memory");
    }
    for (uint32_t i = 0; i < count; i++) {
        t3r_capture_frame frame;
        char why[400] = "", lost[400], error[ERROR_BYTES / 2];
        e->place[i] = e->count;
        if (t3r_recording_frame_readable(recording, i, &frame, lost, sizeof lost, why, sizeof why) ==
            T3R_CAPTURE_FRAME) {
            e->frames[e->count++] = i;
        } else if (posed_recording_lose(losses, i, why, error, sizeof error) != 0) {
            return cli_error(CLI_BAD_INPUT, "%s: %s", r->input, error);
        }
    }
    return e->count == 0 ? cli_error(CLI_BAD_INPUT, "%s: %s", r->input, losses->frames.lines[0])
                         : recording_estimate_poses(recording, r->input, e->frames, e->count, r->poses, e->accounts);
}

/* Describes what was lost by a cut; "" without one. */
static void say_lost(const t3r_recording *recording, char *text, size_t bytes)
{
    const t3r_recording_cut cut = t3r_recording_cut_of(recording);
    const char *file = cut.file[0] != '\0' ? cut.file : "the file";
    if (!cut.cut) {
        text[0] = '\0';
    } else if (cut.offset == cut.file_bytes) {
        snprintf(text, bytes,
                 "only the end and its index: %s stops at byte %" PRIu64 ", after %" PRIu64 " complete messages", file,
                 cut.offset, cut.messages);
    } else {
        snprintf(text, bytes,
                 "everything after %" PRIu64 " complete messages: %s is cut or damaged from byte %" PRIu64
                 " of %" PRIu64 " on",
                 cut.messages, file, cut.offset, cut.file_bytes);
    }
}

/* Returns a stream's use. Transforms are also used if a pose topic's frames are not the requested ones. */
static t3r_stream_use use_of(const t3r_stream_info *info, const bag_frames *frames)
{
    bool transforms = t3r_ros_is_named(T3R_ROS_TF, t3r_text_of(info->schema));
    return transforms && frames->composed > 0 ? T3R_USE_TRANSFORMS : info->use;
}

static cJSON *topics_json(const t3r_recording *recording, const bag_frames *frames, bool used)
{
    cJSON *list = cJSON_CreateArray();
    for (uint32_t i = 0; i < t3r_recording_stream_count(recording); i++) {
        t3r_stream_info info = t3r_recording_stream(recording, i);
        t3r_stream_use use = use_of(&info, frames);
        if ((use != T3R_USE_NONE) == used) {
            cJSON *item = cJSON_CreateObject();
            cJSON_AddStringToObject(item, "topic", info.topic);
            cJSON_AddStringToObject(item, "schema", info.schema);
            json_add_integer(item, "messages", (int64_t)info.messages);
            cJSON_AddStringToObject(item, used ? "use" : "unused", used ? t3r_stream_use_names[use] : info.unused);
            cJSON_AddItemToArray(list, item);
        }
    }
    return list;
}

/* Contents of a report. */
typedef struct report {
    const t3r_recording *recording;
    const bag_frames *frames;
    const posed_recording_totals *totals;
    const posed_recording_losses *losses;
    const estimation *estimated;
    const picture_inner *inner;
} report;

/* Lists the topics of which messages, or transforms, cannot be read. */
static cJSON *unreadable_json(const t3r_recording *recording)
{
    cJSON *list = cJSON_CreateArray();
    for (uint32_t i = 0; i < t3r_recording_stream_count(recording); i++) {
        const t3r_stream_info info = t3r_recording_stream(recording, i);
        if (info.left_out > 0) {
            cJSON *item = cJSON_CreateObject();
            cJSON_AddStringToObject(item, "topic", info.topic);
            json_add_integer(item, "left_out", (int64_t)info.left_out);
            cJSON_AddStringToObject(item, "first", info.fault);
            cJSON_AddItemToArray(list, item);
        }
    }
    return list;
}

/* Returns the number of frames without a message of the chosen depth near in time. */
static uint32_t unpaired(const t3r_recording *recording)
{
    const t3r_pairing_info pairing = t3r_recording_pairing(recording);
    return t3r_recording_stream_for(recording, T3R_USE_DEPTH) != T3R_NO_STREAM ? pairing.frames - pairing.with_depth
                                                                               : 0;
}

static void print_json(const report *r)
{
    const t3r_recording *recording = r->recording;
    const bag_frames *frames = r->frames;
    const posed_recording_totals *totals = r->totals;
    char lost[300];
    say_lost(recording, lost, sizeof lost);
    cJSON *json = cJSON_CreateObject();
    cJSON_AddNumberToObject(json, "frames", totals->frames);
    cJSON_AddNumberToObject(json, "depth_frames", totals->depth_frames);
    cJSON_AddNumberToObject(json, "posed_frames", totals->posed_frames);
    cJSON_AddNumberToObject(json, "triplets", totals->triplets);
    json_add_integer(json, "bytes", (int64_t)totals->bytes);
    cJSON_AddNumberToObject(json, "interpolated", frames->interpolated);
    cJSON_AddNumberToObject(json, "composed", frames->composed);
    cJSON_AddNumberToObject(json, "registered", frames->registered);
    cJSON_AddNumberToObject(json, "unregistered", frames->unregistered);
    cJSON_AddNumberToObject(json, "straightened", frames->straightened);
    json_add_integer(json, "transforms_left_out", (int64_t)frames->tree.refused);
    cJSON_AddNumberToObject(json, "depth_unpaired", unpaired(recording));
    json_add_integer(json, "depth_beyond", (int64_t)t3r_recording_depth_beyond(recording));
    cJSON_AddStringToObject(json, "remark", frames->remark);
    picture_border_add_json(r->inner, json);
    cJSON_AddStringToObject(json, "lost", lost);
    cJSON_AddStringToObject(json, "note", t3r_recording_note(recording));
    cJSON_AddNumberToObject(json, "frames_left_out", r->losses->gone_count);
    text_list_add_json(&r->losses->frames, json, "left_out");
    cJSON_AddNumberToObject(json, "parts_left_out", r->losses->part_count);
    text_list_add_json(&r->losses->parts, json, "left_out_parts");
    cJSON_AddItemToObject(json, "unreadable", unreadable_json(recording));
    cJSON_AddItemToObject(json, "topics", topics_json(recording, frames, true));
    cJSON_AddItemToObject(json, "unused", topics_json(recording, frames, false));
    const estimation *e = r->estimated;
    cJSON *poses = e->accounts != NULL ? cJSON_AddArrayToObject(json, "poses") : NULL;
    for (uint32_t i = 0; poses != NULL && i < e->count; i++) {
        cJSON_AddItemToArray(poses, pose_account_json(e->frames, i, e->accounts));
    }
    json_print(json);
}

static void print_topics(const t3r_recording *recording, const bag_frames *frames)
{
    for (uint32_t i = 0; i < t3r_recording_stream_count(recording); i++) {
        t3r_stream_info info = t3r_recording_stream(recording, i);
        t3r_stream_use use = use_of(&info, frames);
        if (use != T3R_USE_NONE) {
            wrapped_printf(TOPIC_INDENT, t3r_stream_use_names[use], "%s", info.topic);
        }
    }
    for (uint32_t i = 0; i < t3r_recording_stream_count(recording); i++) {
        t3r_stream_info info = t3r_recording_stream(recording, i);
        if (use_of(&info, frames) == T3R_USE_NONE) {
            wrapped_printf(TOPIC_INDENT, "not used", "%s (%s, %" PRIu64 " messages): %s", info.topic, info.schema,
                           info.messages, info.unused);
        }
    }
}

static void print_losses(const report *r)
{
    const posed_recording_losses *losses = r->losses;
    for (uint32_t i = 0; i < t3r_recording_stream_count(r->recording); i++) {
        const t3r_stream_info info = t3r_recording_stream(r->recording, i);
        if (info.left_out > 0) {
            printf("left out: %" PRIu64 " of the %s of %s, the first %s\n", info.left_out,
                   t3r_ros_is_named(T3R_ROS_TF, t3r_text_of(info.schema)) ? "transforms" : "messages", info.topic,
                   info.fault);
        }
    }
    if (losses->gone_count > 0) {
        printf("left out: %u of %u frames\n", losses->gone_count, t3r_recording_frame_count(r->recording));
        text_list_print(&losses->frames, "left out");
    }
    if (losses->part_count > 0) {
        printf("left out: depth or pose of %u of %u frames\n", losses->part_count, r->totals->frames);
        text_list_print(&losses->parts, "left out");
    }
}

/* Prints the transforms that contradict the tree. */
static void print_refused(const transform_tree *tree)
{
    if (tree->refused > 0) {
        const transform_frame *frame = &tree->frames[tree->refused_frame];
        char name[64], parent[64], other[64];
        t3r_text_copy(name, sizeof name, t3r_text_of(frame->name));
        t3r_text_copy(parent, sizeof parent, t3r_text_of(tree->frames[frame->parent].name));
        t3r_text_copy(other, sizeof other, t3r_text_of(tree->frames[tree->refused_parent].name));
        printf("left out: %" PRIu64 " transforms of frames with another parent, the first of '%s' in '%s', as it is in "
               "'%s'\n",
               tree->refused, name, other, parent);
    }
}

static void print_text(const char *output, const report *r)
{
    char lost[300];
    const bag_frames *frames = r->frames;
    const posed_recording_totals *totals = r->totals;
    say_lost(r->recording, lost, sizeof lost);
    wrapped_printf(2, output, ": %u frames (%u with depth, %u with a pose), %u triplets, %" PRIu64 " bytes",
                   totals->frames, totals->depth_frames, totals->posed_frames, totals->triplets, totals->bytes);
    if (lost[0] != '\0') {
        printf("lost: %s\n", lost);
    }
    print_losses(r);
    print_refused(&frames->tree);
    print_topics(r->recording, frames);
    if (t3r_recording_pairing(r->recording).by_log) {
        printf("stamps: they go back or repeat, so log times are used\n");
    }
    if (frames->interpolated > 0 || frames->composed > 0) {
        printf("poses: %u between two of their topic, %u composed of transforms\n", frames->interpolated,
               frames->composed);
    }
    if (frames->registered > 0 || frames->unregistered > 0) {
        printf("depth: %u registered to colour, %u left out\n", frames->registered, frames->unregistered);
    }
    if (frames->straightened > 0) {
        printf("lens: colour of %u frames redrawn as a pinhole's: no recording holds its coefficients\n",
               frames->straightened);
    }
    if (unpaired(r->recording) > 0) {
        printf("depth: %u of %u frames have no message of it near in time (--pair)\n", unpaired(r->recording),
               t3r_recording_frame_count(r->recording));
    }
    const uint64_t beyond = t3r_recording_depth_beyond(r->recording);
    if (beyond > 0) {
        const double unit = ldexp((double)t3r_recording_depth_unit_q40(r->recording), -40);
        printf("depth: %" PRIu64 " samples beyond %g have none; --depth-unit %g doubles the range\n", beyond,
               unit * UINT16_MAX, 2 * unit);
    }
    picture_border_print(r->inner);
    if (frames->remark[0] != '\0') {
        printf("remark: %s\n", frames->remark);
    }
    if (r->estimated->accounts != NULL) {
        poses_print(r->estimated->frames, r->estimated->count, r->estimated->accounts);
    }
}

/* Says why there are no frames: the reasons of topics that could hold them, else the note. */
static int no_frames(const recording_import_request *r, const t3r_recording *recording)
{
    for (uint32_t i = 0; i < t3r_recording_stream_count(recording); i++) {
        const t3r_stream_info info = t3r_recording_stream(recording, i);
        if (t3r_ros_is_named(T3R_ROS_IMAGE, t3r_text_of(info.schema)) ||
            t3r_ros_is_named(T3R_ROS_COMPRESSED_IMAGE, t3r_text_of(info.schema))) {
            return cli_error(CLI_BAD_INPUT, "%s: no frames: %s: %s; %s", r->input, info.topic, info.unused,
                             t3r_recording_note(recording));
        }
    }
    return cli_error(CLI_BAD_INPUT, "%s: no frames: %s", r->input, t3r_recording_note(recording));
}

static int import_opened(const recording_import_request *r, t3r_recording *recording, bag_pictures *pictures)
{
    uint32_t count = t3r_recording_frame_count(recording);
    if (t3r_recording_asks(recording)[0] != '\0') {
        return cli_error(CLI_BAD_INPUT, "%s: %s", r->input, t3r_recording_asks(recording));
    }
    if (count == 0) {
        return no_frames(r, recording);
    }
    bag_frames frames;
    bag_frames_options how = r->bag->frames;
    how.keep_poses = r->poses != POSES_GIVEN;
    posed_recording_totals totals = {0};
    posed_recording_losses losses;
    estimation estimated = {0};
    char error[ERROR_BYTES / 2] = "";
    int code = posed_recording_losses_open(&losses, count, r->bag->topics.strict) == 0
                   ? CLI_OK
                   : cli_error(CLI_BAD_INPUT, "out of memory");
    if (bag_frames_open(&frames, recording, &how, error, sizeof error) != 0) {
        code = cli_error(CLI_BAD_INPUT, "%s: %s", r->input, error);
    }
    if (code == CLI_OK && r->poses != POSES_GIVEN) {
        code = estimate_all(recording, r, &losses, &estimated);
    }
    made_frames makes = {.pictures = pictures,
                         .frames = &frames,
                         .estimated = &estimated,
                         .size = {.width = r->width, .height = r->height},
                         .given = r->intrinsics != NULL};
    const char *wrong = code == CLI_OK && !r->keeps_border ? bag_border_find(recording, &makes.inner) : NULL;
    if (wrong != NULL) {
        code = cli_error(CLI_BAD_INPUT, "%s: %s", r->input, wrong);
    }
    code = code == CLI_OK ? write_new(r, recording, &makes, &losses, &totals) : code;
    bag_size_free(&makes.size);
    const report made = {recording, &frames, &totals, &losses, &estimated, &makes.inner};
    if (code == CLI_OK && r->json) {
        print_json(&made);
    } else if (code == CLI_OK && !r->quiet) {
        print_text(r->output, &made);
    }
    bag_frames_close(&frames);
    posed_recording_losses_close(&losses);
    free(estimated.frames);
    free(estimated.place);
    free(estimated.accounts);
    return code;
}

int recording_import(const recording_import_request *request)
{
    char error[ERROR_BYTES] = "";
    bag_pictures pictures = {.large = request->width != 0};
    t3r_recording_choice choice = request->bag->topics;
    choice.intrinsics = request->intrinsics;
    choice.depth_unit_q40 = request->depth_unit_q40;
    t3r_recording *recording = t3r_recording_open_chosen(request->input, &choice, error, sizeof error);
    if (recording == NULL) {
        return cli_error(CLI_BAD_INPUT, "%s", error);
    }
    t3r_recording_set_decoder(recording, bag_pictures_decoder(&pictures));
    int code = import_opened(request, recording, &pictures);
    t3r_recording_close(recording);
    bag_pictures_free(&pictures);
    return code;
}
