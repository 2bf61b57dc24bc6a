/* SPDX-License-Identifier: Apache-2.0 */
#include "capture/options.h"

#include <argp.h>
#include <string.h>

#include "cli/options/file_options.h"
#include "cli/options/option_values.h"
#include "import/poses/intrinsics.h"
#include "import/poses/pose_losses.h"
#include "reconstruction/options/settings.h"
#include "scene/scene_options.h"

enum {
    KEY_DEPTH_SOURCE = 0x1000,
    KEY_DEPTH_SIZE,
    KEY_DEPTH_UNIT,
    KEY_SIZE,
    KEY_RATE,
    KEY_FORMAT,
    KEY_BACKEND,
    KEY_BUFFERS,
    KEY_STALL,
    KEY_PAIR,
    KEY_REPEAT,
    KEY_INTRINSICS,
    KEY_OFFSET,
    KEY_MAX_BYTES,
    KEY_FRAMES,
    KEY_SECONDS,
    KEY_RECONNECT,
    KEY_EVERY
};

static const struct argp_option options[] = {
    {"source", OPTION_TO(capture_options, source), "SOURCE", OPTION_READS | OPTION_FOLDER | OPTION_OR_DEVICE,
     "camera: v4l2:/dev/video0, libcamera:0, opencv:URL or replay:REC.mcap (needed)", 0},
    {"list", OPTION_TO(capture_options, list), NULL, 0,
     "list the adapters of this build, those that it lacks, and the devices found", 0},
    {"size", KEY_SIZE, "WxH", 0, "size of colour; the nearest that the device has (640x480)", 0},
    {"rate", KEY_RATE, "FPS", 0, "frames a second (the device's)", 0},
    {"format", KEY_FORMAT, "FOURCC", 0,
     "pixel format: YUYV, UYVY, NV12, RGB3, BGR3, MJPG or GREY (the first that fits)", 0},
    {"backend", KEY_BACKEND, "NAME", 0, "backend of OpenCV: FFMPEG, V4L2, CV_IMAGES, CV_MJPEG, GSTREAMER (its choice)",
     0},
    {"buffers", KEY_BUFFERS, "N", 0, "buffers of a stream, 2..32 (4); more bridge longer builds", 0},
    {"repeat", KEY_REPEAT, "N", 0, "number of times to play a recording (1)", 0},
    {"depth-source", KEY_DEPTH_SOURCE, "DEVICE", OPTION_READS | OPTION_FOLDER | OPTION_OR_DEVICE,
     "second device of the same adapter, for depth: /dev/video2 with Z16 or Y16; for OpenCV pictures with 16 bits", 0},
    {"depth-size", KEY_DEPTH_SIZE, "WxH", 0, "size of depth (that of colour)", 0},
    {"depth-unit", KEY_DEPTH_UNIT, "METRES", 0, "length of one step of depth (0.001)", 0},
    {"pair", KEY_PAIR, "MS", 0, "most milliseconds between colour and depth of one instant, 1..1000 (20)", 0},
    {"stall", KEY_STALL, "MS", 0, "milliseconds without a frame after which a device counts as lost, 1..3600000 (3000)",
     0},
    {"reconnect", KEY_RECONNECT, "SECONDS", 0, "seconds to wait for a lost device (10)", 0},
    {NULL, 0, NULL, 0, "The camera:", 2},
    {"intrinsics", KEY_INTRINSICS, "LIST", 0,
     "fx,fy,cx,cy[,k1,k2,p1,p2[,k3]] in pixels of the captured size, (0, 0) being the centre of the top-left pixel", 0},
    {"fisheye", OPTION_TO(capture_options, fisheye), NULL, 0,
     "read the intrinsics as those of a fisheye lens, with k1,k2,k3,k4 at the end", 0},
    {"poses", OPTION_TO(capture_options, poses), "FILE", OPTION_READS | OPTION_FOLDER,
     "poses over time, camera to world, to interpolate: lines of TUM, a table of EuRoC, or a ROS 2 bag (MCAP) with "
     "PoseStamped or TransformStamped",
     0},
    {"pose-topic", OPTION_TO(capture_options, pose_topic), "TOPIC", 0, "topic of the bag (the only one with poses)", 0},
    {"strict", OPTION_TO(capture_options, strict), NULL, 0, POSE_LOSSES_STRICT_HELP, 0},
    {"clock-offset", KEY_OFFSET, "S|estimate[:S]", 0,
     "seconds that the poses' clock is ahead of the camera's (0), or estimate: from the motion of the picture, "
     "within a second of S; S is 0 if the times overlap, else the difference of their starts",
     0},
    {NULL, 0, NULL, 0, "What is written:", 4},
    {"output", 'o', "REC.mcap", OPTION_WRITES(FILE_RECORDING),
     "recording to write; an existing file is overwritten, unless it is being read", 0},
    {"max-bytes", KEY_MAX_BYTES, "BYTES[K|M|G]", 0, "most bytes of a file; the next one is REC-1.mcap and so on", 0},
    {"sync", OPTION_TO(capture_options, sync), NULL, 0,
     "write every message to the disk at once: a power loss then costs one message at most", 0},
    {"frames", KEY_FRAMES, "N", 0, "stop after N frames", 0},
    {"seconds", KEY_SECONDS, "S", 0, "stop after S seconds", 0},
    {"build", OPTION_TO(capture_options, scene), "SCENE.ply", OPTION_WRITES(FILE_SCENE),
     "scene to write: Gaussians of the context frames (--context, in their order of arrival, 0 and 1) as soon as they "
     "are there",
     0},
    {"every", KEY_EVERY, "N", 0,
     "distance in frames of further builds, each of a frame and the Nth before it, SCENE.ply being the last one's; "
     "with "
     "--stream that of keyframes (3)",
     0},
    {"local", OPTION_TO(capture_options, local), NULL, 0, "write positions from the first context camera's centre", 0},
    {"hash", OPTION_TO(capture_options, hash), NULL, 0,
     "print the hash of all frames: a replay of the recording has the same", 0},
    {"quiet", OPTION_TO(capture_options, quiet), NULL, 0, "show no progress line", 0},
    {"json", OPTION_TO(capture_options, json), NULL, 0, "print one JSON object on stdout", 0},
    {NULL, 0, NULL, 0, "A map that follows the camera:", 5},
    {"stream", OPTION_TO(capture_options, streams), NULL, 0,
     "write one map of at most --gaussians (10000) into SCENE.ply, which keyframes extend as they come; print a row "
     "for "
     "each",
     0},
    {0},
};

/* ---- options ---- */

/* Parses seconds below CAPTURE_MOST_OFFSET_S with up to nine decimal places, exactly. */
static bool signed_seconds(const char *text, int64_t *ns)
{
    bool negative = *text == '-';
    text += *text == '-' || *text == '+';
    int64_t seconds = 0, fraction = 0, unit = 100000000;
    size_t digits = 0;
    for (; *text >= '0' && *text <= '9'; text++, digits++) {
        seconds = seconds * 10 + (*text - '0');
        if (seconds >= CAPTURE_MOST_OFFSET_S) {
            return false;
        }
    }
    if (*text == '.') {
        for (text++; *text >= '0' && *text <= '9'; text++, digits++, unit /= 10) {
            fraction += (*text - '0') * unit;
        }
    }
    *ns = (seconds * 1000000000 + fraction) * (negative ? -1 : 1);
    return digits > 0 && *text == '\0';
}

static void parse_offset(struct argp_state *state, const char *text, capture_options *o)
{
    const char *number = text;
    o->has_offset = true;
    if (strncmp(text, "estimate", 8) == 0) {
        o->estimate = true;
        number = text[8] == ':' ? text + 9 : NULL;
        o->has_centre = number != NULL;
        if (text[8] == '\0') {
            return;
        }
    }
    if (number == NULL || !signed_seconds(number, &o->offset_ns)) {
        argp_error(state, "--clock-offset takes seconds, estimate or estimate:SECONDS, not '%s'", text);
    }
}

static void parse_intrinsics(struct argp_state *state, const char *text, capture_options *o)
{
    double numbers[INTRINSICS_NUMBERS];
    const uint32_t count = intrinsics_of_text(text, numbers);
    if (count == 0) {
        argp_error(state, "--intrinsics %s: not fx,fy,cx,cy[,k1,k2,p1,p2[,k3]]", text);
    } else if (count == INTRINSICS_NUMBERS) {
        argp_error(
            state,
            "--intrinsics: no recording holds k4,k5,k6: trim3r import of the pictures' folder redraws the pictures");
    }
    o->intrinsics.fx = numbers[0];
    o->intrinsics.fy = numbers[1];
    o->intrinsics.cx = numbers[2];
    o->intrinsics.cy = numbers[3];
    memcpy(o->intrinsics.coefficients, numbers + 4, sizeof o->intrinsics.coefficients);
    o->intrinsics.distortion = count > 4 ? T3R_DISTORTION_RADTAN : T3R_DISTORTION_NONE;
    o->has_intrinsics = true;
}

static const char *name_of(int key)
{
    const struct argp_option *o = options;
    while (o->key != key) {
        o++;
    }
    return o->name;
}

/* The adapters that use a camera option, and what the option requires. */
static const struct {
    int key;
    const char *adapters;
    bool of_depth; /* belongs to --depth-source */
} uses[] = {
    {KEY_SIZE, "v4l2 libcamera opencv", false},   {KEY_RATE, "v4l2 libcamera opencv", false},
    {KEY_FORMAT, "v4l2 libcamera opencv", false}, {KEY_BACKEND, "opencv", false},
    {KEY_BUFFERS, "v4l2 libcamera", false},       {KEY_REPEAT, "replay", false},
    {KEY_DEPTH_SOURCE, "v4l2 opencv", false},     {KEY_DEPTH_SIZE, "v4l2 opencv", true},
    {KEY_DEPTH_UNIT, "v4l2 opencv", true},        {KEY_PAIR, "v4l2", true},
    {KEY_STALL, "v4l2 libcamera opencv", false},  {KEY_RECONNECT, "v4l2 libcamera opencv", false},
};

/* Whether the word is in `words`, which are separated by spaces. */
static bool is_among(const char *word, size_t length, const char *words)
{
    for (const char *at = words; *at != '\0'; at += strspn(at, " ")) {
        size_t here = strcspn(at, " ");
        if (here == length && strncmp(at, word, length) == 0) {
            return true;
        }
        at += here;
    }
    return false;
}

/* Refuses options that the source's adapter would ignore. */
static void check_uses(struct argp_state *state, const capture_options *o)
{
    size_t length = strcspn(o->source, ":");
    for (size_t i = 0; i < sizeof uses / sizeof uses[0]; i++) {
        if ((o->given >> (uses[i].key - KEY_DEPTH_SOURCE) & 1) == 0) {
            continue;
        }
        if (is_among(o->source, length, "replay v4l2 libcamera opencv") &&
            !is_among(o->source, length, uses[i].adapters)) {
            argp_error(state, "--%s is of no use to %.*s: it belongs to %s", name_of(uses[i].key), (int)length,
                       o->source, uses[i].adapters);
        } else if (uses[i].of_depth && o->settings.depth == NULL) {
            argp_error(state, "--%s belongs to --depth-source", name_of(uses[i].key));
        }
    }
}

static void check(struct argp_state *state, capture_options *o)
{
    if (o->list) {
        return;
    }
    scene_output_option(state, "--build", o->scene);
    bool budget = o->build.gaussians != 0 || o->build.keep_percent > 0 || reconstruction_chooses(&o->build);
    if (o->source == NULL) {
        argp_error(state, "--source is missing (--list shows what there is)");
    } else if (o->output == NULL && o->scene == NULL && !o->hash) {
        argp_error(state, "-o REC.mcap or --build SCENE.ply is missing");
    } else if (o->scene == NULL && (o->every > 0 || budget || reconstruction_names_context(&o->build) || o->local)) {
        argp_error(state, "--every, --local, --context and budgets belong to --build");
    } else if (o->scene != NULL && o->build.config.allocate == T3R_ALLOCATE_GIVEN) {
        argp_error(state, "--allocate given needs a recording: trim3r build");
    } else if (o->build.config.depth == T3R_DEPTH_STEREO) {
        argp_error(state, "--depth stereo needs a recording: trim3r build");
    } else if (o->streams && (o->scene == NULL || o->local || reconstruction_names_context(&o->build) ||
                              reconstruction_chooses(&o->build) || o->build.keep_percent > 0)) {
        argp_error(state,
                   "--stream needs --build SCENE.ply, and takes no --local, --context, --auto, --min-psnr or --keep");
    } else if (!o->streams && live_options_given(&o->live, &o->build.config) != NULL) {
        argp_error(state, "--%s belongs to --stream", live_options_given(&o->live, &o->build.config));
    } else if (o->every > 0 && reconstruction_names_context(&o->build)) {
        argp_error(state, "--every and --context exclude each other");
    } else if (o->build.context_kind != CONTEXT_LISTED) {
        argp_error(state, "--context lists the frames of a capture; all and auto need a recording: trim3r build");
    } else if (o->poses == NULL && (o->has_offset || o->pose_topic != NULL || o->strict)) {
        argp_error(state, "--clock-offset, --pose-topic and --strict belong to --poses");
    } else if ((o->max_bytes > 0 || o->sync || o->stored.unchunked || o->stored.compression != T3R_COMPRESSION_NONE) &&
               o->output == NULL) {
        argp_error(state, "--max-bytes, --sync, --compression and --unchunked belong to -o");
    } else if (o->fisheye && !o->has_intrinsics) {
        argp_error(state, "--fisheye belongs to --intrinsics");
    }
    check_uses(state, o);
    for (uint32_t i = 1; i < o->build.context_count; i++) {
        if (o->build.context[i] <= o->build.context[i - 1]) {
            argp_error(state, "--context must ascend: frames are used as they come in");
        }
    }
    if (o->fisheye) {
        o->intrinsics.distortion = T3R_DISTORTION_FISHEYE;
    }
    o->live.scene = o->streams ? o->scene : NULL;
    live_options_check(state, &o->live);
    o->live.every = o->every;
    if (o->streams && !budget) {
        o->build.gaussians = LIVE_GAUSSIANS;
    } else if (o->scene != NULL && !budget) {
        o->build.keep_percent = 10;
    }
}

static error_t parse(int key, char *arg, struct argp_state *state)
{
    capture_options *o = state->input;
    t3r_capture_settings *s = &o->settings;
    if (key >= KEY_DEPTH_SOURCE && key <= KEY_EVERY) {
        o->given |= UINT64_C(1) << (key - KEY_DEPTH_SOURCE);
    }
    switch (key) {
    case ARGP_KEY_INIT:
        state->child_inputs[0] = &o->build;
        state->child_inputs[1] = &o->build;
        state->child_inputs[2] = &o->stored;
        state->child_inputs[3] = &o->build.config;
        state->child_inputs[4] = &o->live;
        return 0;
    case 'o':
        o->output = arg;
        return 0;
    case KEY_SIZE:
        option_size(state, "size", arg, 2, &s->width, &s->height);
        return 0;
    case KEY_FORMAT:
        s->format = arg;
        return 0;
    case KEY_BACKEND:
        s->backend = arg;
        return 0;
    case KEY_BUFFERS:
        s->buffers = option_number(state, "buffers", arg, 2, 32);
        return 0;
    case KEY_REPEAT:
        s->repeat = option_number(state, "repeat", arg, 1, UINT32_MAX);
        return 0;
    case KEY_DEPTH_SOURCE:
        s->depth = arg;
        return 0;
    case KEY_DEPTH_SIZE:
        option_size(state, "depth-size", arg, 2, &s->depth_width, &s->depth_height);
        return 0;
    case KEY_PAIR:
        s->pair_ms = option_number(state, "pair", arg, 1, 1000);
        return 0;
    case KEY_STALL:
        s->stall_ms = option_number(state, "stall", arg, 1, 3600000);
        return 0;
    case KEY_RECONNECT:
        o->reconnect_seconds = option_decimal(state, "reconnect", arg, 0, 1e6);
        return 0;
    case KEY_FRAMES:
        o->frames = option_number(state, "frames", arg, 1, UINT32_MAX);
        return 0;
    case KEY_SECONDS:
        o->seconds = option_decimal(state, "seconds", arg, 0, 1e9);
        return 0;
    case KEY_EVERY:
        o->every = option_number(state, "every", arg, 1, 1000000);
        return 0;
    case KEY_RATE:
        s->rate_millihertz = (uint32_t)(option_decimal(state, "rate", arg, 0, 10000) * 1000 + 0.5);
        return 0;
    case KEY_DEPTH_UNIT:
        s->depth_unit_q40 = (uint64_t)(option_decimal(state, "depth-unit", arg, 0, 100) * 0x1p40 + 0.5);
        return 0;
    case KEY_INTRINSICS:
        parse_intrinsics(state, arg, o);
        return 0;
    case KEY_OFFSET:
        parse_offset(state, arg, o);
        return 0;
    case KEY_MAX_BYTES:
        o->max_bytes = option_bytes(state, "max-bytes", arg);
        return 0;
    case ARGP_KEY_ARG:
        argp_error(state, "'%s' is too many", arg);
        return 0;
    case ARGP_KEY_END:
        check(state, o);
        return 0;
    default:
        return option_field(key, arg, state);
    }
}

static const struct argp_child children[] = {{&reconstruction_budget_argp, 0, "Views and budget of --build:", 10},
                                             {&reconstruction_settings_argp, 0, NULL, 0},
                                             {&recording_argp, 0, NULL, 0},
                                             {&stream_settings_argp, 0, NULL, 0},
                                             {&live_argp, 0, NULL, 0},
                                             {0}};
static const struct argp argp = {
    .options = options,
    .parser = parse,
    .doc =
        "Capture frames into a recording, straight into Gaussians, or both. Ctrl-C ends it; the recording is whole."
        "\vExamples:\n"
        "  trim3r capture --list\n"
        "  trim3r capture --source v4l2:/dev/video0 -o rec.mcap\n"
        "  trim3r capture --source v4l2:/dev/video0 --depth-source /dev/video2 \\\n"
        "    --intrinsics 615,615,320,240 --max-bytes 2G -o rec.mcap\n"
        "  trim3r capture --source replay:rec.mcap --poses tracker.txt \\\n"
        "    --clock-offset estimate -o posed.mcap\n"
        "  trim3r capture --source replay:posed.mcap --build s.ply --keep 10%\n"
        "  trim3r capture --source replay:posed.mcap --build map.ply --stream \\\n"
        "    --snapshot 10 --lines map.jsonl\n\n"
        "Poses are usually known only after the capture: record first, then add them to the recording as above. A "
        "device may come back under another name, but not below /dev/v4l/by-id.\n\n"
        "Every frame that is not recorded is counted under its cause and reported on the topic /camera/events, as is "
        "every pair of colour and depth. A process that is killed loses at most the message that it was writing, with "
        "--compression the frame.",
    .children = children,
};

void capture_options_read(int argc, char **argv, capture_options *o)
{
    *o = (capture_options){.reconnect_seconds = 10};
    reconstruction_defaults(&o->build);
    file_options_parse(&argp, argc, argv, o);
}
