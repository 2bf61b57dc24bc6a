/* SPDX-License-Identifier: Apache-2.0 */
/* trim3r info: describes recordings and folders, or scenes. */
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
#define FILES_MOST 256u

typedef struct options {
    const char *files[FILES_MOST]; /* recordings and folders */
    uint32_t file_count;
    const char *scenes[SCENE_INFO_MOST];
    uint32_t scene_count;
    const char *svg;
    uint32_t view;
    int flags; /* for scene_file_read() */
    bool has_view, json;
} options;

/* A summary over all frames; `mixed` once two differ in size or format. */
typedef struct frame_summary {
    uint32_t width, height, depth_width, depth_height; /* 0: no frame could be read; as they are stored */
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
    const bool scene = scene_file_is_one(argument);
    if (!scene && o->file_count == FILES_MOST) {
        argp_error(state, "%s: at most %u files are shown at once", argument, FILES_MOST);
    } else if (!scene) {
        o->files[o->file_count++] = argument;
    } else if (o->scene_count == SCENE_INFO_MOST) {
        argp_error(state, "%s: at most %u scenes are shown at once", argument, SCENE_INFO_MOST);
    } else {
        o->scenes[o->scene_count++] = argument;
    }
}

static void check_options(struct argp_state *state, const options *o)
{
    if (o->scene_count == 0 && o->file_count == 0) {
        argp_error(state, "REC.mcap, DIR or SCENE.ply is missing");
    }
    if (o->scene_count == 0 && (o->svg != NULL || o->has_view)) {
        argp_error(state, "--svg and --view belong to scenes");
    }
    if (o->scene_count > 0 && o->file_count != o->has_view) {
        argp_error(state, "with scenes, one REC.mcap and --view belong together");
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
    {"svg", OPTION_TO(options, svg), "FILE", OPTION_WRITES(FILE_SVG) | OPTION_PIPE,
     "picture to write: histograms of the scenes' scales", 0},
    {"json", OPTION_TO(options, json), NULL, 0, "print one JSON object on stdout", 0},
    {0},
};

static const struct argp_child children[] = {{.argp = &scene_input_argp}, {0}};
static const struct argp parser = {
    .options = argp_options,
    .parser = parse_option,
    .args_doc = "REC.mcap|DIR...\nSCENE.ply... [REC.mcap --view N]",
    .doc = "Show the contents of recordings or bags: frames, streams, clock, pairing, triplets. Or of folders, as "
           "import would read them: kind, frames, camera, poses, depth. Or of scenes: Gaussians, bounds, and the "
           "widths of the Gaussians.\v"
           "The scale of a Gaussian is the root of the product of its two "
           "largest standard deviations, in world units. With --view also in pixels of that frame, at the median "
           "depth of the first scene's Gaussians within its picture. JSON: scale_edges are a quarter of an octave "
           "apart, scale_counts the Gaussians between them; the first and the last include everything beyond. "
           "Of several recordings or folders, files is the list of their objects.\n"
           "\n"
           "Examples:\n"
           "  trim3r info room.mcap\n"
           "  trim3r info --json room.mcap\n"
           "  trim3r info rgbd_dataset_freiburg1_desk\n"
           "  trim3r info one.mcap other.mcap\n"
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

static void summarise(const t3r_recording *recording, bag_pictures *pictures, frame_summary *out)
{
    char error[ERROR_BYTES];
    *out = (frame_summary){0};
    const uint32_t count = t3r_recording_frame_count(recording), enough = frames_to_see(recording);
    uint32_t seen = 0;
    for (uint32_t i = 0; i < count && seen < enough; i++) {
        t3r_capture_frame f;
        pictures->whole_width = 0;
        if (t3r_recording_frame(recording, i, &f, error, ERROR_BYTES) != T3R_CAPTURE_FRAME) {
            if (out->unreadable++ == 0) {
                t3r_reason(out->reason, sizeof out->reason, "%s", error);
            }
            continue;
        }
        const bool decoded = pictures->whole_width != 0;
        const uint32_t width = decoded ? pictures->whole_width : f.frame.width;
        const uint32_t height = decoded ? pictures->whole_height : f.frame.height;
        if (seen++ == 0) {
            out->width = width;
            out->height = height;
            out->format = f.frame.format;
            out->straightened = f.straightened;
            out->distortion = f.has_intrinsics ? f.camera.distortion : T3R_DISTORTION_NONE;
        }
        out->mixed = out->mixed || width != out->width || height != out->height || f.frame.format != out->format;
        if (f.frame.depth != NULL && out->depth_width == 0) {
            out->depth_width = f.frame.depth_width;
            out->depth_height = f.frame.depth_height;
            out->depth_unit = (double)f.frame.depth_unit_q40 * 0x1p-40;
        }
        out->mixed = out->mixed || (f.frame.depth != NULL && (f.frame.depth_width != out->depth_width ||
                                                              f.frame.depth_height != out->depth_height));
    }
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

static void add_json(cJSON *json, const t3r_recording *recording, const frame_summary *s)
{
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
}

static void print_streams(const t3r_recording *recording)
{
    printf("streams:\n");
    for (uint32_t i = 0; i < t3r_recording_stream_count(recording); i++) {
        t3r_stream_info info = t3r_recording_stream(recording, i);
        printf("  %s %s\n    %llu messages", info.topic, info.schema, (unsigned long long)info.messages);
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
    if (s->width > 0) {
        printf(", %ux%u %s%s, lens distortion %s", s->width, s->height, t3r_pixel_format_name(s->format),
               s->mixed ? " (sizes differ between frames)" : "", distortion_name(s));
    }
    putchar('\n');
    if (s->width > T3R_MAX_SIDE || s->height > T3R_MAX_SIDE) {
        printf("size:     a side is above %u: import needs --size WxH\n", T3R_MAX_SIDE);
    }
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
    printf("pairing:  depth %u, pose %u, intrinsics %u of %u\n", p.with_depth, p.with_pose, p.with_intrinsics,
           p.frames);
    printf("gaps:     depth %.3f ms, pose %.3f ms at most\n", (double)p.worst_depth_gap_ns * 1e-6,
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

/* Prints what a recording holds, or adds it to `json`. */
static int recording_info(const char *path, cJSON *json)
{
    t3r_recording *recording = import_source_open(path);
    if (recording == NULL) {
        return CLI_BAD_INPUT;
    }
    bag_pictures pictures = {.large = true};
    t3r_recording_set_decoder(recording, bag_pictures_decoder(&pictures));
    frame_summary summary;
    summarise(recording, &pictures, &summary);
    int status = CLI_OK;
    if (summary.unreadable > 0 && summary.width == 0) {
        status = cli_error(CLI_BAD_INPUT, "%s: %s", path, summary.reason);
    } else if (json != NULL) {
        add_json(json, recording, &summary);
    } else {
        print_text(recording, &summary, path);
    }
    t3r_recording_close(recording);
    bag_pictures_free(&pictures);
    return status;
}

static int scenes_info(const options *o)
{
    const char *path = o->file_count > 0 ? o->files[0] : NULL;
    t3r_recording *recording = path != NULL ? import_source_open(path) : NULL;
    if (path != NULL && recording == NULL) {
        return CLI_BAD_INPUT;
    }
    const int status = scene_info(&(scene_info_request){.scenes = o->scenes,
                                                        .scene_count = o->scene_count,
                                                        .recording = recording,
                                                        .recording_path = path,
                                                        .view = o->view,
                                                        .svg = o->svg,
                                                        .flags = o->flags,
                                                        .json = o->json});
    t3r_recording_close(recording);
    return status;
}

/* Prints what a recording or a folder holds, or adds it to `json`. */
static int file_info(const char *path, cJSON *json)
{
    const char *advice;
    switch (import_source_of(path, &advice)) {
    case IMPORT_FOLDER:
        return folder_info(path, json);
    case IMPORT_FOREIGN:
        return cli_error(CLI_BAD_INPUT, "%s: %s", path, advice);
    case IMPORT_RECORDING:
    default:
        return recording_info(path, json);
    }
}

/* Describes all files, also after one that cannot be read. Returns the status of the first that fails. */
static int files_info(const options *o)
{
    int status = CLI_OK;
    cJSON *root = o->json ? cJSON_CreateObject() : NULL;
    cJSON *list = o->json && o->file_count > 1 ? cJSON_AddArrayToObject(root, "files") : NULL;
    for (uint32_t i = 0; i < o->file_count; i++) {
        cJSON *json = root;
        if (list != NULL) {
            json = cJSON_CreateObject();
            cJSON_AddStringToObject(json, "file", o->files[i]);
            cJSON_AddItemToArray(list, json);
        } else if (json == NULL && i > 0) {
            putchar('\n');
        }
        const int code = file_info(o->files[i], json);
        status = status == CLI_OK ? code : status;
    }
    if (root != NULL && root->child != NULL) {
        json_print(root);
    } else {
        cJSON_Delete(root);
    }
    return status;
}

int command_info(int argc, char **argv)
{
    options o = {0};
    file_options_parse(&parser, argc, argv, &o);
    return o.scene_count > 0 ? scenes_info(&o) : files_info(&o);
}
