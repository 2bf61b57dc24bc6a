/* trim3r replay: the hash of every stage, against an earlier run's. */
#include "commands.h"

#include <argp.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli.h"
#include "file_bytes.h"
#include "hash.h"
#include "json_output.h"
#include "option_values.h"
#include "reconstruction.h"

#define ERROR_BYTES 512
#define MAX_EXPECTATION_BYTES ((size_t)64 << 20)

typedef struct replay_options {
    const char *recording;
    const char *expect;
    bool json;
    reconstruction_options settings;
} replay_options;

/* What an earlier run found: of a lone hash only the last field. */
typedef struct expectation {
    bool given;
    bool has_stage[T3R_STAGE_COUNT];
    uint64_t stage[T3R_STAGE_COUNT];
    uint64_t *tiles; /* heap; NULL = none */
    uint32_t tile_count;
    uint64_t hash;
} expectation;

typedef struct replayed_view {
    uint32_t frame;
    uint32_t width, height;
    uint8_t *rgb;
    uint64_t *tiles; /* a hash for each 16x16 tile, row-major */
    uint32_t tile_columns, tile_count;
    uint64_t hash; /* of the whole run */
} replayed_view;

enum { KEY_EXPECT = 0x1000, KEY_JSON };

static const struct argp_option options[] = {
    {"expect", KEY_EXPECT, "HASH|FILE", 0,
     "the final hash, or the JSON of an earlier run; exit status 1 when it differs", 0},
    {"json", KEY_JSON, NULL, 0, "one JSON object on stdout, fit for --expect", 0},
    {0},
};

static error_t parse(int key, char *arg, struct argp_state *state)
{
    replay_options *o = state->input;
    switch (key) {
    case ARGP_KEY_INIT:
        state->child_inputs[0] = &o->settings;
        state->child_inputs[1] = &o->settings;
        return 0;
    case KEY_EXPECT:
        o->expect = arg;
        return 0;
    case KEY_JSON:
        o->json = true;
        return 0;
    case ARGP_KEY_ARG:
        option_argument(state, arg, (const char **[]){&o->recording}, 1);
        return 0;
    case ARGP_KEY_END:
        if (o->recording == NULL) {
            argp_error(state, "REC.mcap is missing");
        }
        if (o->settings.gaussians == 0 && o->settings.keep_percent <= 0 && !o->settings.automatic) {
            o->settings.keep_percent = 10;
        }
        if (o->settings.method != METHOD_TRIM3R) {
            argp_error(state, "--method %s is made in floats, which promise no bits; trim3r alone is replayed",
                       method_name(o->settings.method));
        }
        return 0;
    default:
        return ARGP_ERR_UNKNOWN;
    }
}

static const struct argp_child children[] = {
    {&reconstruction_budget_argp, 0, NULL, 0}, {&reconstruction_settings_argp, 0, NULL, 0}, {0}};
static const struct argp argp = {
    .options = options,
    .parser = parse,
    .args_doc = "REC.mcap",
    .doc =
        "Builds (10 % kept unless told otherwise), draws the first frame that is not a context view, and prints the "
        "hash "
        "of every stage and of the whole."
        "\vExamples:\n"
        "  trim3r replay room.mcap\n"
        "  trim3r replay room.mcap --json > golden.json\n"
        "  trim3r replay room.mcap --expect golden.json --threads 2 --arena min\n\n"
        "With a file to compare with, the first stage that differs is named, and for the raster the first 16x16 tile.",
    .children = children,
};

/* ---- the expectation ------------------------------------------------------------------------------------------ */

static int read_hash(const cJSON *item, uint64_t *hash)
{
    return cJSON_IsString(item) && hash_parse(item->valuestring, hash) == 0 ? 0 : -1;
}

static int read_tiles(const cJSON *tiles, expectation *e)
{
    int count = cJSON_GetArraySize(tiles);
    e->tiles = calloc((size_t)count + 1, sizeof *e->tiles);
    if (e->tiles == NULL) {
        return -1;
    }
    const cJSON *item;
    cJSON_ArrayForEach(item, tiles)
    {
        if (read_hash(item, &e->tiles[e->tile_count++]) != 0) {
            return -1;
        }
    }
    return 0;
}

static int read_expectation(const char *text, expectation *e)
{
    *e = (expectation){0};
    if (text == NULL) {
        return CLI_OK;
    }
    e->given = true;
    if (hash_parse(text, &e->hash) == 0) {
        return CLI_OK;
    }
    char error[ERROR_BYTES] = "";
    size_t count;
    uint8_t *bytes = t3r_file_bytes(text, MAX_EXPECTATION_BYTES, &count, error, sizeof error);
    if (bytes == NULL) {
        return cli_error(CLI_BAD_INPUT, "--expect takes 16 hexadecimal digits or a file: %s", error);
    }
    cJSON *root = cJSON_ParseWithLength((const char *)bytes, count);
    free(bytes);
    const cJSON *stages = cJSON_GetObjectItemCaseSensitive(root, "stages");
    const cJSON *tiles = cJSON_GetObjectItemCaseSensitive(root, "tiles");
    const char *wrong = NULL;
    if (root == NULL) {
        wrong = "is not JSON";
    } else if (read_hash(cJSON_GetObjectItemCaseSensitive(root, "hash"), &e->hash) != 0) {
        wrong = "has no field hash of 16 hexadecimal digits";
    }
    for (int stage = 0; wrong == NULL && stage < T3R_STAGE_COUNT; stage++) {
        const cJSON *item = cJSON_GetObjectItemCaseSensitive(stages, t3r_stage_name((t3r_stage)stage));
        if (item != NULL) {
            e->has_stage[stage] = true;
            wrong =
                read_hash(item, &e->stage[stage]) == 0 ? NULL : "has a stage whose hash is not 16 hexadecimal digits";
        }
    }
    if (wrong == NULL && cJSON_IsArray(tiles) && read_tiles(tiles, e) != 0) {
        wrong = "has a tile whose hash is not 16 hexadecimal digits";
    }
    cJSON_Delete(root);
    return wrong == NULL ? CLI_OK : cli_error(CLI_BAD_INPUT, "%s: %s", text, wrong);
}

/* The first place that differs, as text; "" when none does. */
static void find_difference(const expectation *e, const reconstruction *r, const replayed_view *view, char *text,
                            size_t text_bytes)
{
    text[0] = '\0';
    for (int stage = 0; stage < T3R_STAGE_COUNT; stage++) {
        if (!e->has_stage[stage] || (r->stage_hashed[stage] && e->stage[stage] == r->stage_hash[stage])) {
            continue;
        }
        snprintf(text, text_bytes, "stage %s", t3r_stage_name((t3r_stage)stage));
        for (uint32_t i = 0; stage == T3R_STAGE_RASTER && i < e->tile_count && i < view->tile_count; i++) {
            if (e->tiles[i] != view->tiles[i]) {
                snprintf(text, text_bytes, "stage %s, tile %" PRIu32 " (pixels from %" PRIu32 ", %" PRIu32 ")",
                         t3r_stage_name((t3r_stage)stage), i, i % view->tile_columns * T3R_TILE_SIDE,
                         i / view->tile_columns * T3R_TILE_SIDE);
                break;
            }
        }
        return;
    }
    if (e->given && e->hash != view->hash) {
        snprintf(text, text_bytes, "the final hash");
    }
}

/* ---- the run ---------------------------------------------------------------------------------------------------- */

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
    int code = reconstruction_frame(recording, path, view->frame, &frame);
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
    t3r_status status = t3r_render(r->runtime, &camera, &target);
    cli_progress_end();
    if (status != T3R_OK) {
        return reconstruction_error(status, path, &r->config, r->arena_bytes);
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
    cJSON_AddStringToObject(root, "head", r->head.name);
    if (r->head.weights != NULL) {
        cJSON_AddStringToObject(root, "head_crc", r->head.crc);
    }
    json_add_integer(root, "arena_bytes", (int64_t)r->arena_bytes);
    cJSON *stages = cJSON_AddObjectToObject(root, "stages");
    for (int stage = 0; stage < T3R_STAGE_COUNT; stage++) {
        if (r->stage_hashed[stage]) {
            json_add_hash(stages, t3r_stage_name((t3r_stage)stage), r->stage_hash[stage]);
        }
    }
    cJSON *tiles = cJSON_AddArrayToObject(root, "tiles");
    for (uint32_t i = 0; i < view->tile_count; i++) {
        char text[HASH_TEXT_BYTES];
        hash_text(view->tiles[i], text);
        cJSON_AddItemToArray(tiles, cJSON_CreateString(text));
    }
    json_add_hash(root, "hash", view->hash);
    if (e->given) {
        json_add_hash(root, "expected", e->hash);
        cJSON_AddBoolToObject(root, "match", difference[0] == '\0');
        cJSON_AddStringToObject(root, "first_difference", difference);
    }
    json_print(root);
}

static void print_text(const replay_options *o, const reconstruction *r, const replayed_view *view)
{
    char text[HASH_TEXT_BYTES];
    printf("%s: context", o->recording);
    for (uint32_t v = 0; v < r->context_count; v++) {
        printf("%s%" PRIu32, v == 0 ? " " : ",", r->context[v]);
    }
    printf(", view %" PRIu32 ", %" PRIu32 " Gaussians, head %s, arena %zu bytes\n", view->frame, r->scene.count,
           r->head.name, r->arena_bytes);
    for (int stage = 0; stage < T3R_STAGE_COUNT; stage++) {
        if (r->stage_hashed[stage]) {
            hash_text(r->stage_hash[stage], text);
            printf("%-14s %s\n", t3r_stage_name((t3r_stage)stage), text);
        }
    }
    hash_text(view->hash, text);
    printf("%-14s %s\n", "final", text);
}

static int replay(const replay_options *o, const t3r_recording *recording, const expectation *e)
{
    reconstruction r;
    int code = reconstruction_build(&r, recording, o->recording, &o->settings);
    if (code != CLI_OK) {
        return code;
    }
    uint32_t epoch = t3r_recording_bits_epoch(recording);
    if (epoch != 0 && epoch != T3R_BITS_EPOCH) {
        fprintf(stderr, "trim3r replay: %s is of bits epoch %" PRIu32 ", this is %d: hashes of then do not hold\n",
                o->recording, epoch, T3R_BITS_EPOCH);
    }
    replayed_view view = {0};
    code = draw_target(recording, o->recording, &r, &view);
    if (code == CLI_OK) {
        char difference[128];
        find_difference(e, &r, &view, difference, sizeof difference);
        if (o->json) {
            print_json(o, &r, &view, e, difference);
        } else {
            print_text(o, &r, &view);
        }
        if (difference[0] != '\0') {
            char expected[HASH_TEXT_BYTES], found[HASH_TEXT_BYTES];
            hash_text(e->hash, expected);
            hash_text(view.hash, found);
            code = cli_error(CLI_BAD_INPUT, "%s: expected %s, found %s; first difference: %s", o->recording, expected,
                             found, difference);
        } else if (e->given && !o->json) {
            puts("as expected");
        }
    }
    free(view.tiles);
    free(view.rgb);
    reconstruction_close(&r);
    return code;
}

int command_replay(int argc, char **argv)
{
    replay_options o = {0};
    reconstruction_defaults(&o.settings);
    argp_parse(&argp, argc, argv, 0, NULL, &o);

    expectation e;
    int code = read_expectation(o.expect, &e);
    if (code == CLI_OK) {
        char error[ERROR_BYTES] = "";
        t3r_recording *recording = t3r_recording_open(o.recording, error, sizeof error);
        if (recording == NULL) {
            code = cli_error(CLI_BAD_INPUT, "%s", error);
        } else {
            code = replay(&o, recording, &e);
            t3r_recording_close(recording);
        }
    }
    free(e.tiles);
    return code;
}
