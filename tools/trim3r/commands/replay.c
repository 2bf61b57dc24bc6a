/* SPDX-License-Identifier: Apache-2.0 */
/* trim3r replay: hashes every stage and compares with an earlier run. */
#include "trim3r/commands/commands.h"

#include <argp.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/cli.h"
#include "cli/files/recorded_frame.h"
#include "cli/jobs/work_times.h"
#include "cli/options/file_options.h"
#include "cli/options/option_values.h"
#include "cli/tables/json_output.h"
#include "core/hash.h"
#include "import/import_source.h"
#include "reconstruction/context/context_frames.h"
#include "reconstruction/options/settings.h"
#include "reconstruction/reconstruction.h"
#include "reconstruction/reconstruction_error.h"
#include "reconstruction/replay/hash_report.h"
#include "reconstruction/replay/replay_expectation.h"
#include "reconstruction/replay/replay_slide.h"
#include "reconstruction/replay/replay_stream.h"
#include "scene/scene_options.h"

#define ERROR_BYTES 512

typedef struct replay_options {
    const char *recording;
    const char *expect;
    bool json;
    replay_stream_options stream;
    bool streams, slides;
    reconstruction_options settings;
} replay_options;

typedef struct replayed_view {
    uint32_t frame;
    uint32_t width, height;
    uint8_t *rgb;
    uint64_t *tiles; /* a hash for each 16x16 tile, row-major */
    uint32_t tile_columns, tile_count;
    uint64_t hash; /* of the whole run */
    work_times times;
} replayed_view;

enum { KEY_JSON = 0x1000, KEY_EVERY, KEY_UNTIL, KEY_ROUNDS };

static const struct argp_option options[] = {
    OPTION_ARGUMENTS("REC.mcap", OPTION_READS | OPTION_FOLDER),
    {"expect", OPTION_TO(replay_options, expect), "HASH|FILE", OPTION_READS | OPTION_OR_WORD,
     "expected final hash, or the JSON of an earlier run; exit status 1 when it differs", 0},
    {"json", KEY_JSON, NULL, 0, "print one JSON object on stdout, fit for --expect", 0},
    {"slide", OPTION_TO(replay_options, slides), NULL, 0,
     "build a scene at every frame, of it and the previous one; print the time of each and the hash of all", 0},
    {NULL, 0, NULL, 0, "A map that follows the camera:", 5},
    {"stream", OPTION_TO(replay_options, streams), NULL, 0,
     "take all frames in turn: keyframes go into one map of at most --gaussians; the frames between them are drawn and "
     "compared",
     0},
    {"every", KEY_EVERY, "N", 0, "distance of keyframes in frames, 1..1000 (3)", 0},
    {"until", KEY_UNTIL, "FRAME|TIME", 0,
     "last frame to take, by its number, or by its time since the first one with a unit: 90s, 500ms (the last)", 0},
    {"rounds", KEY_ROUNDS, "N", 0,
     "rounds in which all keyframes are shown to the map again after the last frame, 0..16: it then forgets less (0)",
     0},
    {"no-hash", OPTION_TO(replay_options, stream.no_hash), NULL, 0,
     "hash no stage, which takes time in each keyframe; nothing can be expected then", 0},
    {"images", OPTION_TO(replay_options, stream.images), "DIR", OPTION_WRITES(FILE_PICTURE) | OPTION_FOLDER,
     "folder to write the held-back frames that have a depth and their views into: frame_<frame>.png, mask_, live_, "
     "final_",
     0},
    {"output", 'o', "MAP.ply", OPTION_WRITES(FILE_SCENE),
     "scene to write: the map in the end, and with --snapshot on "
     "the way",
     0},
    {0},
};

static void check_stream(struct argp_state *state, const replay_options *o)
{
    const live_options *live = &o->stream.live;
    const char *given = live_options_given(live, &o->settings.config);
    given = o->stream.has_until        ? "until"
            : o->stream.rounds > 0     ? "rounds"
            : o->stream.no_hash        ? "no-hash"
            : o->stream.images != NULL ? "images"
            : live->scene != NULL      ? "output"
                                       : given;
    if (!o->streams && given != NULL) {
        argp_error(state, "--%s belongs to --stream%s", given,
                   strcmp(given, "output") == 0 ? "; trim3r build -o writes a scene of some frames" : "");
    }
    scene_output_option(state, "-o", live->scene);
    live_options_check(state, live);
    if (o->streams &&
        (reconstruction_names_context(&o->settings) || reconstruction_chooses(&o->settings) ||
         o->settings.config.depth == T3R_DEPTH_STEREO || o->settings.config.allocate == T3R_ALLOCATE_GIVEN)) {
        argp_error(state, "--stream takes no --context, --auto, --min-psnr, --allocate given or --depth stereo");
    }
    if (o->stream.rounds > 0 && live->state != NULL) {
        argp_error(state, "--rounds and --state exclude each other: after its rounds a map cannot be continued");
    }
    if (o->stream.no_hash && o->expect != NULL) {
        argp_error(state, "--no-hash and --expect exclude each other");
    }
    if (o->expect != NULL && live->most_ms > 0) {
        argp_error(state, "--max-ms gives other bits in each run: --expect has nothing to compare");
    }
}

/* Parses "120", a frame, or "4.5s", a time. */
static void parse_until(struct argp_state *state, const char *text, replay_stream_options *o)
{
    o->has_until = true;
    if (text[strspn(text, "0123456789")] == '\0') {
        o->until_frame = option_number(state, "until", text, 0, UINT32_MAX - 1);
    } else {
        o->until_frame = UINT32_MAX;
        o->until_ns = option_time(state, "until", text);
    }
}

static error_t parse(int key, char *arg, struct argp_state *state)
{
    replay_options *o = state->input;
    switch (key) {
    case ARGP_KEY_INIT:
        state->child_inputs[0] = &o->settings;
        state->child_inputs[1] = &o->settings.config;
        state->child_inputs[2] = &o->stream.live;
        return 0;
    case KEY_JSON:
        o->json = o->stream.json = true;
        return 0;
    case KEY_EVERY:
        o->stream.live.every = option_number(state, "every", arg, 1, 1000);
        return 0;
    case KEY_ROUNDS:
        o->stream.rounds = option_number(state, "rounds", arg, 0, 16);
        return 0;
    case KEY_UNTIL:
        parse_until(state, arg, &o->stream);
        return 0;
    case 'o':
        o->stream.live.scene = arg;
        return 0;
    case ARGP_KEY_ARG:
        option_argument(state, arg, (const char **[]){&o->recording}, 1);
        return 0;
    case ARGP_KEY_END:
        if (o->recording == NULL) {
            argp_error(state, "REC.mcap is missing");
        }
        if (o->settings.gaussians == 0 && o->settings.keep_percent <= 0 && !reconstruction_chooses(&o->settings)) {
            o->settings.keep_percent = 10;
        }
        check_stream(state, o);
        if (o->slides && (o->streams || reconstruction_names_context(&o->settings) ||
                          o->settings.config.allocate == T3R_ALLOCATE_GIVEN)) {
            argp_error(state, "--slide takes no --stream, --context or --allocate given");
        }
        return 0;
    default:
        return option_field(key, arg, state);
    }
}

static const struct argp_child children[] = {
    {.argp = &reconstruction_argp}, {.argp = &stream_settings_argp}, {.argp = &live_argp}, {0}};
static const struct argp argp = {
    .options = options,
    .parser = parse,
    .args_doc = "REC.mcap",
    .doc =
        "Build a scene (10 % of the points, unless a budget is given), draw the first frame that is not a context "
        "view, "
        "and print the hash of every stage and of the whole. With --stream, take all frames of the recording in turn; "
        "percents are then of the points of the first two keyframes. With --slide, build a scene at every frame."
        "\vExamples:\n"
        "  trim3r replay room.mcap\n"
        "  trim3r replay room.mcap --json > golden.json\n"
        "  trim3r replay room.mcap --expect golden.json --threads 2 --arena min\n"
        "  trim3r replay walk.mcap --slide --warm on\n"
        "  trim3r replay walk.mcap --stream --every 3 --gaussians 10000 -o map.ply\n"
        "  trim3r replay walk.mcap --stream --gaussians 10000 --rounds 1 -o map.ply\n"
        "  trim3r replay walk.mcap --stream --at-hand 2 --remember 6\n\n"
        "With a file to compare with, the first stage that differs is named, and for the raster the first 16x16 tile.",
    .children = children,
};

/* ---- the run ---------------------------------------------------------------------------------------------------- */

/* Writes the first place that differs as text; "" if none does. */
static void find_difference(const expectation *e, const reconstruction *r, const replayed_view *view, char *text,
                            size_t text_bytes)
{
    t3r_stage stage = expectation_missed(e, r, view->hash, text, text_bytes);
    for (uint32_t i = 0; stage == T3R_STAGE_RASTER && i < e->tile_count && i < view->tile_count; i++) {
        if (e->tiles[i] != view->tiles[i]) {
            snprintf(text, text_bytes, "stage %s, tile %" PRIu32 " (pixels from %" PRIu32 ", %" PRIu32 ")",
                     t3r_stage_name(stage), i, i % view->tile_columns * T3R_TILE_SIDE,
                     i / view->tile_columns * T3R_TILE_SIDE);
            break;
        }
    }
}

static void hash_tiles(replayed_view *view)
{
    for (uint32_t tile = 0; tile < view->tile_count; tile++) {
        uint32_t left = tile % view->tile_columns * T3R_TILE_SIDE, top = tile / view->tile_columns * T3R_TILE_SIDE;
        uint32_t right = left + T3R_TILE_SIDE < view->width ? left + T3R_TILE_SIDE : view->width;
        uint32_t bottom = top + T3R_TILE_SIDE < view->height ? top + T3R_TILE_SIDE : view->height;
        uint64_t hash = T3R_HASH_START;
        for (uint32_t y = top; y < bottom; y++) {
            hash = t3r_hash_bytes(hash, view->rgb + ((size_t)y * view->width + left) * 3, (size_t)(right - left) * 3);
        }
        view->tiles[tile] = hash;
    }
}

static uint32_t choose_target(const t3r_recording *recording, const reconstruction *r)
{
    for (uint32_t frame = 0; frame < t3r_recording_frame_count(recording); frame++) {
        bool context = false;
        for (uint32_t v = 0; v < r->context_count; v++) {
            context = context || r->context[v] == frame;
        }
        if (!context) {
            return frame;
        }
    }
    return r->context[0];
}

static int draw_target(const t3r_recording *recording, const char *path, reconstruction *r, replayed_view *view)
{
    t3r_capture_frame frame;
    view->frame = choose_target(recording, r);
    int code = recorded_frame_read(recording, path, view->frame, &frame);
    if (code != CLI_OK) {
        return code;
    }
    view->width = r->config.render_width;
    view->height = r->config.render_height;
    view->tile_columns = (view->width + T3R_TILE_SIDE - 1) / T3R_TILE_SIDE;
    view->tile_count = (uint32_t)T3R_TILES_(view->width, view->height);
    view->rgb = malloc((size_t)view->width * view->height * 3);
    view->tiles = calloc(view->tile_count, sizeof *view->tiles);
    if (view->rgb == NULL || view->tiles == NULL) {
        return cli_error(CLI_BAD_INPUT, "out of memory");
    }
    t3r_camera camera =
        reconstruction_camera(&frame.camera, frame.frame.width, frame.frame.height, view->width, view->height);
    t3r_target target = {
        .width = view->width, .height = view->height, .rgb = view->rgb, .rgb_stride_bytes = view->width * 3};
    work_times_pass(&view->times);
    t3r_status status = t3r_render(r->runtime, &camera, &target);
    work_times_end(&view->times, WORK_DRAW);
    cli_progress_end();
    if (status != T3R_OK) {
        return reconstruction_render_error(status, path, r->runtime, &camera, &target);
    }
    hash_tiles(view);
    view->hash = t3r_hash_bytes(reconstruction_hash(r), view->rgb, (size_t)view->width * view->height * 3);
    return CLI_OK;
}

static void print_json(const replay_options *o, const reconstruction *r, const replayed_view *view,
                       const expectation *e, const char *difference)
{
    cJSON *root = cJSON_CreateObject();
    cJSON_AddStringToObject(root, "recording", o->recording);
    cJSON_AddNumberToObject(root, "bits_epoch", T3R_BITS_EPOCH);
    json_add_integers(root, "context", r->context, r->context_count);
    json_add_integer(root, "target", view->frame);
    json_add_integer(root, "width", view->width);
    json_add_integer(root, "height", view->height);
    json_add_integer(root, "gaussians", r->scene.count);
    json_add_integer(root, "valid_points", r->valid_points);
    json_add_integer(root, "passes", t3r_refinement_passes(r->runtime));
    cJSON_AddStringToObject(root, "head", r->head.name);
    if (r->head.weights != NULL) {
        cJSON_AddStringToObject(root, "head_crc", r->head.crc);
    }
    json_add_integer(root, "arena_bytes", (int64_t)r->arena_bytes);
    work_times_add_json(root, &view->times);
    hash_report_add_stages(root, r);
    cJSON *tiles = cJSON_AddArrayToObject(root, "tiles");
    for (uint32_t i = 0; i < view->tile_count; i++) {
        char text[HASH_TEXT_BYTES];
        hash_text(view->tiles[i], text);
        cJSON_AddItemToArray(tiles, cJSON_CreateString(text));
    }
    json_add_hash(root, "hash", view->hash);
    expectation_add(root, e, difference);
    json_print(root);
}

static void print_text(const replay_options *o, const reconstruction *r, const replayed_view *view)
{
    char text_of_times[WORK_TIMES_BYTES];
    printf("%s: context", o->recording);
    for (uint32_t v = 0; v < r->context_count; v++) {
        printf("%s%" PRIu32, v == 0 ? " " : ",", r->context[v]);
    }
    printf(", view %" PRIu32 ", %" PRIu32 " Gaussians, head %s, arena %zu bytes\n%s\n", view->frame, r->scene.count,
           r->head.name, r->arena_bytes, work_times_text(&view->times, text_of_times));
    hash_report_print(r, view->hash);
}

static int replay(const replay_options *o, const t3r_recording *recording, const expectation *e,
                  const work_times *reading)
{
    reconstruction r;
    reconstruction_options settings = o->settings;
    int code = context_resolve(&settings, recording, o->recording);
    code = code == CLI_OK ? reconstruction_build(&r, recording, o->recording, &settings) : code;
    if (code != CLI_OK) {
        return code;
    }
    reconstruction_warn_of_budget(&o->settings, r.requested, r.scene.count);
    replayed_view view = {.times = *reading};
    view.times.seconds[WORK_BUILD] = r.add_views_seconds + r.build_seconds;
    code = draw_target(recording, o->recording, &r, &view);
    if (code == CLI_OK) {
        char difference[128];
        find_difference(e, &r, &view, difference, sizeof difference);
        if (o->json) {
            print_json(o, &r, &view, e, difference);
        } else {
            print_text(o, &r, &view);
        }
        code = expectation_verdict(e, o->recording, view.hash, difference, o->json);
    }
    free(view.tiles);
    free(view.rgb);
    reconstruction_close(&r);
    return code;
}

static void warn_of_epoch(const replay_options *o, const t3r_recording *recording)
{
    uint32_t epoch = t3r_recording_bits_epoch(recording);
    if (epoch != 0 && epoch != T3R_BITS_EPOCH) {
        (void)cli_error(CLI_OK, "warning: %s is of bits epoch %" PRIu32 ", this is %d: hashes of then do not hold",
                        o->recording, epoch, T3R_BITS_EPOCH);
    }
}

int command_replay(int argc, char **argv)
{
    replay_options o = {0};
    reconstruction_defaults(&o.settings);
    file_options_parse(&argp, argc, argv, &o);

    expectation e;
    int code = expectation_read(&e, o.expect);
    if (code == CLI_OK) {
        work_times times;
        work_times_begin(&times);
        t3r_recording *recording = import_source_open(o.recording);
        if (recording == NULL) {
            code = CLI_BAD_INPUT;
        } else {
            work_times_end(&times, WORK_READ);
            warn_of_epoch(&o, recording);
            code = o.streams  ? replay_stream(&o.stream, recording, o.recording, &o.settings, &e)
                   : o.slides ? replay_slide(recording, o.recording, &o.settings, o.json, &e)
                              : replay(&o, recording, &e, &times);
            t3r_recording_close(recording);
        }
    }
    expectation_free(&e);
    return code;
}
