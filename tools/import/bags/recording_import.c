/* SPDX-License-Identifier: Apache-2.0 */
#include "import/bags/recording_import.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>

#include "cli/cli.h"
#include "cli/files/whole_file.h"
#include "cli/tables/json_output.h"
#include "host/reason.h"
#include "import/bags/bag_pictures.h"
#include "import/estimation/poses_output.h"
#include "import/estimation/recording_poses.h"
#include "import/folders/posed_recording.h"
#include "messages/ros_messages.h"

#define ERROR_BYTES 1024

typedef struct made_frames {
    bag_frames *frames;
    const pose_account *accounts; /* NULL: poses were not estimated */
} made_frames;

/* Makes the frame to write, with its estimated pose if poses were estimated. */
static int make(void *user, uint32_t index, t3r_capture_frame *frame, char *error, size_t error_bytes)
{
    const made_frames *made = user;
    int status = bag_frames_make(made->frames, index, frame, error, error_bytes);
    if (made->accounts != NULL && made->accounts[index].why[0] != '\0') {
        frame->has_pose = false; /* a recorded pose would be in another world than the estimated ones */
    }
    return status;
}

static int write_new(const recording_import_request *r, const t3r_recording *recording, made_frames *frames,
                     posed_recording_totals *totals)
{
    whole_file file;
    char error[ERROR_BYTES] = "", reason[ERROR_BYTES / 2] = "";
    int status = whole_file_begin(&file, r->output, error, sizeof error);
    if (status == 0) {
        status = posed_recording_write(recording, r->source, r->stored, &(posed_recording_change){make, frames},
                                       file.stream, totals, reason, sizeof reason);
        if (status == 0) {
            status = whole_file_commit(&file, &totals->bytes, error, sizeof error);
        } else {
            whole_file_abandon(&file);
            t3r_reason(error, sizeof error, "%.400s: %s", r->input, reason);
        }
    }
    cli_progress_end();
    return status == 0 ? CLI_OK : cli_error(CLI_BAD_INPUT, "%s", error);
}

static int estimate_all(t3r_recording *recording, const recording_import_request *r, uint32_t count,
                        pose_account *accounts)
{
    uint32_t *frames = malloc((count + 1) * sizeof *frames);
    if (frames == NULL) {
        return cli_error(CLI_BAD_INPUT, "out of memory");
    }
    for (uint32_t i = 0; i < count; i++) {
        frames[i] = i;
    }
    int code = recording_estimate_poses(recording, r->input, frames, count, r->poses, accounts);
    free(frames);
    return code;
}

/* Describes what was lost by a cut; "" without one. */
static void say_lost(const t3r_recording *recording, char *text, size_t bytes)
{
    t3r_recording_cut cut = t3r_recording_cut_of(recording);
    if (!cut.cut) {
        text[0] = '\0';
    } else if (cut.offset == cut.file_bytes) {
        snprintf(text, bytes,
                 "the end and its index alone: the file stops at byte %" PRIu64 ", after %" PRIu64 " whole messages",
                 cut.offset, cut.messages);
    } else {
        snprintf(text, bytes,
                 "everything after %" PRIu64 " whole messages: the file is cut or damaged from byte %" PRIu64
                 " of %" PRIu64 " on",
                 cut.messages, cut.offset, cut.file_bytes);
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

static void print_json(const t3r_recording *recording, const bag_frames *frames, const posed_recording_totals *totals,
                       const pose_account *accounts)
{
    char lost[200];
    say_lost(recording, lost, sizeof lost);
    cJSON *json = cJSON_CreateObject();
    cJSON_AddNumberToObject(json, "frames", totals->frames);
    cJSON_AddNumberToObject(json, "depth_frames", totals->depth_frames);
    cJSON_AddNumberToObject(json, "posed_frames", totals->posed_frames);
    cJSON_AddNumberToObject(json, "triplets", t3r_recording_triplet_count(recording));
    json_add_integer(json, "bytes", (int64_t)totals->bytes);
    cJSON_AddNumberToObject(json, "interpolated", frames->interpolated);
    cJSON_AddNumberToObject(json, "composed", frames->composed);
    cJSON_AddNumberToObject(json, "registered", frames->registered);
    cJSON_AddNumberToObject(json, "unregistered", frames->unregistered);
    cJSON_AddStringToObject(json, "remark", frames->remark);
    cJSON_AddStringToObject(json, "lost", lost);
    cJSON_AddItemToObject(json, "topics", topics_json(recording, frames, true));
    cJSON_AddItemToObject(json, "unused", topics_json(recording, frames, false));
    cJSON *poses = accounts != NULL ? cJSON_AddArrayToObject(json, "poses") : NULL;
    for (uint32_t i = 0; poses != NULL && i < totals->frames; i++) {
        cJSON_AddItemToArray(poses, pose_account_json(NULL, i, accounts));
    }
    json_print(json);
}

static void print_topics(const t3r_recording *recording, const bag_frames *frames)
{
    for (uint32_t i = 0; i < t3r_recording_stream_count(recording); i++) {
        t3r_stream_info info = t3r_recording_stream(recording, i);
        t3r_stream_use use = use_of(&info, frames);
        if (use != T3R_USE_NONE) {
            printf("%-20s %s\n", t3r_stream_use_names[use], info.topic);
        }
    }
    for (uint32_t i = 0; i < t3r_recording_stream_count(recording); i++) {
        t3r_stream_info info = t3r_recording_stream(recording, i);
        if (use_of(&info, frames) == T3R_USE_NONE) {
            printf("%-20s %s (%s, %" PRIu64 " messages): %s\n", "not used", info.topic, info.schema, info.messages,
                   info.unused);
        }
    }
}

static void print_text(const recording_import_request *r, const t3r_recording *recording, const bag_frames *frames,
                       const posed_recording_totals *totals, const pose_account *accounts)
{
    char lost[200];
    say_lost(recording, lost, sizeof lost);
    printf("%s: %u frames (%u with depth, %u with a pose), %u triplets, %" PRIu64 " bytes\n", r->output, totals->frames,
           totals->depth_frames, totals->posed_frames, t3r_recording_triplet_count(recording), totals->bytes);
    if (lost[0] != '\0') {
        printf("lost: %s\n", lost);
    }
    print_topics(recording, frames);
    if (frames->interpolated > 0 || frames->composed > 0) {
        printf("poses: %u between two of their topic, %u composed of transforms\n", frames->interpolated,
               frames->composed);
    }
    if (frames->registered > 0 || frames->unregistered > 0) {
        printf("depth: %u registered to colour, %u left out\n", frames->registered, frames->unregistered);
    }
    if (frames->remark[0] != '\0') {
        printf("remark: %s\n", frames->remark);
    }
    if (accounts != NULL) {
        poses_print(NULL, totals->frames, accounts);
    }
}

static int import_opened(const recording_import_request *r, t3r_recording *recording)
{
    uint32_t count = t3r_recording_frame_count(recording);
    if (count == 0) {
        return cli_error(CLI_BAD_INPUT, "%s: no frames: %s", r->input, t3r_recording_note(recording));
    }
    pose_account *accounts = r->poses == POSES_GIVEN ? NULL : calloc(count, sizeof *accounts);
    bag_frames frames;
    bag_frames_options how = r->bag->frames;
    how.keep_poses = r->poses != POSES_GIVEN;
    posed_recording_totals totals = {0};
    char error[ERROR_BYTES / 2] = "";
    int code = CLI_OK;
    if (bag_frames_open(&frames, recording, &how, error, sizeof error) != 0) {
        code = cli_error(CLI_BAD_INPUT, "%s: %s", r->input, error);
    } else if (r->poses != POSES_GIVEN) {
        code =
            accounts == NULL ? cli_error(CLI_BAD_INPUT, "out of memory") : estimate_all(recording, r, count, accounts);
    }
    code = code == CLI_OK ? write_new(r, recording, &(made_frames){&frames, accounts}, &totals) : code;
    if (code == CLI_OK && r->json) {
        print_json(recording, &frames, &totals, accounts);
    } else if (code == CLI_OK) {
        print_text(r, recording, &frames, &totals, accounts);
    }
    bag_frames_close(&frames);
    free(accounts);
    return code;
}

int recording_import(const recording_import_request *request)
{
    char error[ERROR_BYTES] = "";
    bag_pictures pictures = {0};
    t3r_recording *recording = t3r_recording_open_chosen(request->input, &request->bag->topics, error, sizeof error);
    if (recording == NULL) {
        return cli_error(CLI_BAD_INPUT, "%s", error);
    }
    t3r_recording_set_decoder(recording, bag_pictures_decoder(&pictures));
    int code = import_opened(request, recording);
    t3r_recording_close(recording);
    bag_pictures_free(&pictures);
    return code;
}
