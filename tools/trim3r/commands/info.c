/* SPDX-License-Identifier: Apache-2.0 */
/* trim3r info: describes a recording, a folder or scenes. */
#include "trim3r/commands/commands.h"

#include <argp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/cli.h"
#include "cli/options/file_options.h"
#include "cli/options/option_values.h"
#include "cli/tables/json_output.h"
#include "host/reason.h"
#include "import/bags/bag_pictures.h"
#include "import/folders/folder_info.h"
#include "import/import_source.h"
#include "recording/recording.h"
#include "scene/scene_file.h"
#include "scene/scene_options.h"
#include "scene/summary/scene_info.h"

#define ERROR_BYTES 512

typedef struct options {
    const char *recording;
    const char *scenes[SCENE_INFO_MOST];
    uint32_t scene_count;
    const char *svg;
    uint32_t view;
    int flags; /* for scene_file_read() */
    bool has_view, json;
} options;

/* A summary over all frames; `mixed` once two differ in size or format. */
typedef struct frame_summary {
    uint32_t width, height, depth_width, depth_height;
    t3r_pixel_format format;
    double depth_unit; /* world units a step; 0 = no depth */
    t3r_distortion distortion;
    bool straightened; /* of a lens that only import reads */
    bool mixed;
    uint32_t unreadable;      /* frames */
    char reason[ERROR_BYTES]; /* of the first of them */
} frame_summary;

enum { KEY_VIEW = 0x100 };

static void take_argument(struct argp_state *state, options *o, const char *argument)
{
    if (!scene_file_is_one(argument)) {
        option_argument(state, argument, (const char **[]){&o->recording}, 1);
    } else if (o->scene_count == SCENE_INFO_MOST) {
        argp_error(state, "%s: at most %u scenes are shown at once", argument, SCENE_INFO_MOST);
    } else {
        o->scenes[o->scene_count++] = argument;
    }
}

static void check_options(struct argp_state *state, const options *o)
{
    if (o->scene_count == 0 && o->recording == NULL) {
        argp_error(state, "REC.mcap, DIR or SCENE.ply is missing");
    }
    if (o->scene_count == 0 && (o->svg != NULL || o->has_view)) {
        argp_error(state, "--svg and --view belong to scenes");
    }
    if (o->scene_count > 0 && o->has_view != (o->recording != NULL)) {
        argp_error(state, "with scenes, REC.mcap and --view belong together");
    }
}

static error_t parse_option(int key, char *argument, struct argp_state *state)
{
    options *o = state->input;
    switch (key) {
    case ARGP_KEY_INIT:
        state->child_inputs[0] = &o->flags;
        return 0;
    case KEY_VIEW:
        o->view = option_number(state, "view", argument, 0, UINT32_MAX);
        o->has_view = true;
        return 0;
    case ARGP_KEY_ARG:
        take_argument(state, o, argument);
        return 0;
    case ARGP_KEY_END:
        check_options(state, o);
        return 0;
    default:
        return option_field(key, argument, state);
    }
}

static const struct argp_option argp_options[] = {
    OPTION_ARGUMENTS("REC.mcap", OPTION_READS | OPTION_FOLDER),
    {"view", KEY_VIEW, "N", 0, "frame of REC.mcap whose pixels are a second unit of the scales", 0},
    {"svg", OPTION_TO(options, svg), "FILE", OPTION_WRITES(FILE_SVG),
     "picture to write: histograms of the scenes' scales", 0},
    {"json", OPTION_TO(options, json), NULL, 0, "print one JSON object on stdout", 0},
    {0},
};

static const struct argp_child children[] = {{.argp = &scene_input_argp}, {0}};
static const struct argp parser = {
    .options = argp_options,
    .parser = parse_option,
    .args_doc = "REC.mcap\nDIR\nSCENE.ply... [REC.mcap --view N]",
    .doc = "Show the contents of a recording or a bag: frames, streams, clock, pairing, triplets. Or of a folder, as "
           "import would read it: its kind, frames, camera, poses, depth. Or of scenes: Gaussians, bounds, and the "
           "widths of the Gaussians.\v"
           "The scale of a Gaussian is the root of the product of its two "
           "largest standard deviations, in world units. With --view also in pixels of that frame, at the median "
           "depth of the first scene's Gaussians within its picture. JSON: scale_edges are a quarter of an octave "
           "apart, scale_counts the Gaussians between them; the first and the last include everything beyond.\n"
           "\n"
           "Examples:\n"
           "  trim3r info room.mcap\n"
           "  trim3r info --json room.mcap\n"
           "  trim3r info rgbd_dataset_freiburg1_desk\n"
           "  trim3r info all.ply pruned.ply room.mcap --view 1 --svg scales.svg",
    .children = children,
};

static const char *distortion_name(const frame_summary *s)
{
    return s->straightened                          ? "rational"
           : s->distortion == T3R_DISTORTION_NONE   ? "none"
           : s->distortion == T3R_DISTORTION_RADTAN ? "radtan"
                                                    : "fisheye";
}

/* Returns the number of frames to read: of images to decode only the first that can be read, as a sample. */
static uint32_t frames_to_see(const t3r_recording *recording)
{
    uint32_t count = t3r_recording_frame_count(recording);
    for (uint32_t i = 0; i < t3r_recording_stream_count(recording); i++) {
        t3r_stream_info info = t3r_recording_stream(recording, i);
        count = info.compressed && info.use != T3R_USE_NONE && count > 1 ? 1 : count;
    }
    return count;
}

static int summarise(const t3r_recording *recording, frame_summary *out, char *error)
{
    *out = (frame_summary){0};
    const uint32_t count = t3r_recording_frame_count(recording), enough = frames_to_see(recording);
    uint32_t seen = 0;
    for (uint32_t i = 0; i < count && seen < enough; i++) {
        t3r_capture_frame f;
        if (t3r_recording_frame(recording, i, &f, error, ERROR_BYTES) != T3R_CAPTURE_FRAME) {
            if (out->unreadable++ == 0) {
                t3r_reason(out->reason, sizeof out->reason, "%s", error);
            }
            continue;
        }
        if (seen++ == 0) {
            out->width = f.frame.width;
            out->height = f.frame.height;
            out->format = f.frame.format;
            out->straightened = f.straightened;
            out->distortion = f.has_intrinsics ? f.camera.distortion : T3R_DISTORTION_NONE;
        }
        out->mixed =
            out->mixed || f.frame.width != out->width || f.frame.height != out->height || f.frame.format != out->format;
        if (f.frame.depth != NULL && out->depth_width == 0) {
            out->depth_width = f.frame.depth_width;
            out->depth_height = f.frame.depth_height;
            out->depth_unit = (double)f.frame.depth_unit_q40 * 0x1p-40;
        }
        out->mixed = out->mixed || (f.frame.depth != NULL && (f.frame.depth_width != out->depth_width ||
                                                              f.frame.depth_height != out->depth_height));
    }
    return count > 0 && seen == 0 ? t3r_reason(error, ERROR_BYTES, "%s", out->reason) : 0;
}

static cJSON *streams_json(const t3r_recording *recording)
{
    cJSON *list = cJSON_CreateArray();
    for (uint32_t i = 0; i < t3r_recording_stream_count(recording); i++) {
        t3r_stream_info info = t3r_recording_stream(recording, i);
        cJSON *item = cJSON_CreateObject();
        cJSON_AddStringToObject(item, "topic", info.topic);
        cJSON_AddStringToObject(item, "schema", info.schema);
        json_add_integer(item, "messages", (int64_t)info.messages);
        json_add_integer(item, "first_ns", info.first_ns);
        json_add_integer(item, "last_ns", info.last_ns);
        cJSON_AddStringToObject(item, "use", t3r_stream_use_names[info.use]);
        cJSON_AddStringToObject(item, "unused", info.unused);
        cJSON_AddItemToArray(list, item);
    }
    return list;
}

static cJSON *triplets_json(const t3r_recording *recording)
{
    cJSON *list = cJSON_CreateArray();
    for (uint32_t i = 0; i < t3r_recording_triplet_count(recording); i++) {
        t3r_triplet t = t3r_recording_triplet(recording, i);
        cJSON *item = cJSON_CreateObject();
        json_add_integers(item, "context", t.context, 2);
        cJSON_AddNumberToObject(item, "target", t.target);
        cJSON_AddItemToArray(list, item);
    }
    return list;
}

static cJSON *pairing_json(const t3r_recording *recording)
{
    t3r_pairing_info pairing = t3r_recording_pairing(recording);
    cJSON *item = cJSON_CreateObject();
    cJSON_AddNumberToObject(item, "with_depth", pairing.with_depth);
    cJSON_AddNumberToObject(item, "with_pose", pairing.with_pose);
    cJSON_AddNumberToObject(item, "with_intrinsics", pairing.with_intrinsics);
    json_add_integer(item, "worst_depth_gap_ns", pairing.worst_depth_gap_ns);
    json_add_integer(item, "worst_pose_gap_ns", pairing.worst_pose_gap_ns);
    return item;
}

static void print_json(const t3r_recording *recording, const frame_summary *s)
{
    cJSON *json = cJSON_CreateObject();
    cJSON_AddNumberToObject(json, "frames", t3r_recording_frame_count(recording));
    cJSON_AddNumberToObject(json, "depth_frames", t3r_recording_pairing(recording).with_depth);
    cJSON_AddNumberToObject(json, "width", s->width);
    cJSON_AddNumberToObject(json, "height", s->height);
    cJSON_AddStringToObject(json, "format", t3r_pixel_format_name(s->format));
    cJSON_AddNumberToObject(json, "depth_width", s->depth_width);
    cJSON_AddNumberToObject(json, "depth_height", s->depth_height);
    cJSON_AddNumberToObject(json, "depth_unit", s->depth_unit);
    cJSON_AddStringToObject(json, "distortion", distortion_name(s));
    cJSON_AddBoolToObject(json, "mixed_sizes", s->mixed);
    cJSON_AddNumberToObject(json, "unreadable_frames", s->unreadable);
    cJSON_AddStringToObject(json, "clock", t3r_recording_clock(recording));
    cJSON_AddNumberToObject(json, "bits_epoch", t3r_recording_bits_epoch(recording));
    cJSON_AddStringToObject(json, "note", t3r_recording_note(recording));
    cJSON_AddItemToObject(json, "pairing", pairing_json(recording));
    cJSON_AddItemToObject(json, "streams", streams_json(recording));
    cJSON_AddItemToObject(json, "triplets", triplets_json(recording));
    json_print(json);
}

static void print_streams(const t3r_recording *recording)
{
    printf("streams:\n");
    for (uint32_t i = 0; i < t3r_recording_stream_count(recording); i++) {
        t3r_stream_info info = t3r_recording_stream(recording, i);
        printf("  %-28s %-36s %6llu messages", info.topic, info.schema, (unsigned long long)info.messages);
        if (info.messages > 0) {
            printf(", %.3f s to %.3f s", (double)info.first_ns * 1e-9, (double)info.last_ns * 1e-9);
        }
        if (info.use != T3R_USE_NONE) {
            printf("; %s\n", t3r_stream_use_names[info.use]);
        } else {
            printf("; not used: %s\n", info.unused);
        }
    }
}

static void print_text(const t3r_recording *recording, const frame_summary *s, const char *path)
{
    uint32_t frames = t3r_recording_frame_count(recording);
    t3r_pairing_info p = t3r_recording_pairing(recording);
    printf("%s: %u frames", path, frames);
    if (frames > 0) {
        printf(", %ux%u %s%s, lens distortion %s", s->width, s->height, t3r_pixel_format_name(s->format),
               s->mixed ? " (sizes differ between frames)" : "", distortion_name(s));
    }
    putchar('\n');
    if (s->depth_width != 0) {
        printf("depth:    %ux%u, %.9g world units a step\n", s->depth_width, s->depth_height, s->depth_unit);
    }
    if (s->unreadable > 0) {
        printf("unreadable: %u frames, the first: %s\n", s->unreadable, s->reason);
    }
    printf("clock:    %s\n", t3r_recording_clock(recording));
    uint32_t epoch = t3r_recording_bits_epoch(recording);
    if (epoch != 0) {
        printf("epoch:    bits epoch %u\n", epoch);
    } else {
        printf("epoch:    not written by trim3r\n");
    }
    printf("pairing:  depth %u, pose %u, intrinsics %u of %u; widest gap: depth %.3f ms, pose %.3f ms\n", p.with_depth,
           p.with_pose, p.with_intrinsics, p.frames, (double)p.worst_depth_gap_ns * 1e-6,
           (double)p.worst_pose_gap_ns * 1e-6);
    print_streams(recording);
    printf("triplets: %u\n", t3r_recording_triplet_count(recording));
    for (uint32_t i = 0; i < t3r_recording_triplet_count(recording); i++) {
        t3r_triplet t = t3r_recording_triplet(recording, i);
        printf("  --context %u,%u --target %u\n", t.context[0], t.context[1], t.target);
    }
    if (t3r_recording_note(recording)[0] != '\0') {
        printf("note:     %s\n", t3r_recording_note(recording));
    }
}

static int recording_info(const options *o)
{
    char error[ERROR_BYTES];
    t3r_recording *recording = import_source_open(o->recording);
    if (recording == NULL) {
        return CLI_BAD_INPUT;
    }
    bag_pictures pictures = {0};
    t3r_recording_set_decoder(recording, bag_pictures_decoder(&pictures));
    frame_summary summary;
    int status = CLI_OK;
    if (summarise(recording, &summary, error) != 0) {
        status = cli_error(CLI_BAD_INPUT, "%s: %s", o->recording, error);
    } else if (o->json) {
        print_json(recording, &summary);
    } else {
        print_text(recording, &summary, o->recording);
    }
    t3r_recording_close(recording);
    bag_pictures_free(&pictures);
    return status;
}

static int scenes_info(const options *o)
{
    t3r_recording *recording = o->recording != NULL ? import_source_open(o->recording) : NULL;
    if (o->recording != NULL && recording == NULL) {
        return CLI_BAD_INPUT;
    }
    const int status = scene_info(&(scene_info_request){.scenes = o->scenes,
                                                        .scene_count = o->scene_count,
                                                        .recording = recording,
                                                        .recording_path = o->recording,
                                                        .view = o->view,
                                                        .svg = o->svg,
                                                        .flags = o->flags,
                                                        .json = o->json});
    t3r_recording_close(recording);
    return status;
}

int command_info(int argc, char **argv)
{
    options o = {0};
    file_options_parse(&parser, argc, argv, &o);
    if (o.scene_count > 0) {
        return scenes_info(&o);
    }
    const char *advice;
    switch (import_source_of(o.recording, &advice)) {
    case IMPORT_FOLDER:
        return folder_info(o.recording, o.json);
    case IMPORT_FOREIGN:
        return cli_error(CLI_BAD_INPUT, "%s: %s", o.recording, advice);
    case IMPORT_RECORDING:
    default:
        return recording_info(&o);
    }
}
