/* SPDX-License-Identifier: Apache-2.0 */
/* trim3r room: the built-in recording. */
#include "trim3r/commands/commands.h"

#include <argp.h>
#include <stdio.h>
#include <stdlib.h>

#include "cli/cli.h"
#include "cli/files/whole_file.h"
#include "cli/options/file_options.h"
#include "cli/options/option_values.h"
#include "cli/options/recording_options.h"
#include "cli/tables/json_output.h"
#include "core/hash.h"
#include "host/reason.h"
#include "recording/recording.h"
#include "room/room.h"

#define ERROR_BYTES 512
#define DEFAULT_SEED 1u

typedef struct options {
    const char *output;
    uint32_t width, height, frames, seed;
    bool json;
    recording_options stored;
} options;

enum { KEY_FRAMES = 0x100, KEY_SEED };

static error_t parse_option(int key, char *argument, struct argp_state *state)
{
    options *o = state->input;
    switch (key) {
    case ARGP_KEY_INIT:
        state->child_inputs[0] = &o->stored;
        return 0;
    case 's':
        option_size(state, "size", argument, T3R_MIN_SIDE, &o->width, &o->height);
        return 0;
    case KEY_FRAMES:
        o->frames = option_number(state, "frames", argument, 1, ROOM_MAX_FRAMES);
        return 0;
    case KEY_SEED:
        o->seed = option_number(state, "seed", argument, 0, UINT32_MAX);
        return 0;
    case 'o':
        o->output = argument;
        return 0;
    case ARGP_KEY_END:
        if (o->output == NULL) {
            argp_error(state, "-o REC.mcap is missing");
        }
        return 0;
    default:
        return option_field(key, argument, state);
    }
}

static const struct argp_option argp_options[] = {
    {"output", 'o', "REC.mcap", OPTION_WRITES(FILE_RECORDING),
     "recording to write; it appears when it is whole (needed)", 0},
    {"size", 's', "WxH", 0, "size of the pictures (256x256)", 0},
    {"frames", KEY_FRAMES, "N", 0, "number of frames along the arc, 1..1000 (6)", 0},
    {"seed", KEY_SEED, "S", 0, "seed of the textures and of the noise (1)", 0},
    {"json", OPTION_TO(options, json), NULL, 0, "print one JSON object on stdout", 0},
    {0},
};

static const struct argp_child children[] = {{&recording_argp, 0, NULL, 0}, {0}};

static const struct argp parser = {
    .options = argp_options,
    .children = children,
    .parser = parse_option,
    .doc = "Write the built-in recording: a furnished room, ray-cast in integers, with exact depth and poses. The same "
           "options give the same frames on every processor.\v"
           "Examples:\n"
           "  trim3r room -o room.mcap\n"
           "  trim3r room --size 640x480 --frames 20 --seed 7 -o room.mcap",
};

typedef struct drawing {
    uint8_t *rgb;
    uint16_t *depth;
    uint64_t hash;
} drawing;

static int write_frames(t3r_recorder *recorder, const t3r_recording_header *header, FILE *stream, const options *o,
                        drawing *d)
{
    if (t3r_recorder_begin(recorder, t3r_file_sink(stream), header) != 0) {
        return -1;
    }
    size_t pixels = (size_t)o->width * o->height;
    for (uint32_t i = 0; i < o->frames; i++) {
        cli_progress("drawing the room", i, o->frames);
        room_frame(i, o->width, o->height, o->seed, d->rgb, d->depth);
        d->hash = t3r_hash_u16s(t3r_hash_bytes(d->hash, d->rgb, pixels * 3), d->depth, pixels);
        t3r_recorded_frame frame = {.stamp_ns = (int64_t)i * 1000000000 / 30,
                                    .format = T3R_PIXEL_RGB24,
                                    .width = o->width,
                                    .height = o->height,
                                    .planes = {d->rgb},
                                    .stride_bytes = {o->width * 3},
                                    .depth = d->depth,
                                    .depth_width = o->width,
                                    .depth_height = o->height};
        room_recorded_camera(i, o->width, o->height, &frame.camera);
        if (t3r_recorder_frame(recorder, &frame) != 0) {
            return -1;
        }
    }
    return t3r_recorder_end(recorder);
}

static int write_recording(const options *o, drawing *d, uint64_t *bytes, char *error)
{
    t3r_whole_file file;
    t3r_triplet triplets[ROOM_MAX_TRIPLETS];
    t3r_recording_header header = {.camera = "camera",
                                   .source = "the built-in room",
                                   .clock = "synthetic",
                                   .depth_unit = 0.001,
                                   .triplets = triplets,
                                   .triplet_count = room_triplets(o->frames, triplets)};
    t3r_recorder *recorder = malloc(t3r_recorder_bytes());
    d->rgb = malloc((size_t)o->width * o->height * 3);
    d->depth = malloc((size_t)o->width * o->height * sizeof *d->depth);
    d->hash = T3R_HASH_START;
    int status = -1;
    if (recorder == NULL || d->rgb == NULL || d->depth == NULL || recording_options_apply(&o->stored, &header) != 0) {
        t3r_reason(error, ERROR_BYTES, "out of memory");
    } else if (whole_file_begin(&file, o->output, error, ERROR_BYTES) == 0) {
        status = write_frames(recorder, &header, file.stream, o, d);
        if (status == 0) {
            status = t3r_whole_file_commit(&file, bytes, error, ERROR_BYTES);
        } else {
            t3r_reason(error, ERROR_BYTES, "%s: cannot be written", o->output);
            t3r_whole_file_abandon(&file);
        }
    }
    t3r_chunk_packer_close(header.packer);
    free(recorder);
    free(d->rgb);
    free(d->depth);
    return status;
}

static void print_json(const options *o, uint64_t hash, uint64_t bytes)
{
    t3r_triplet triplets[ROOM_MAX_TRIPLETS];
    cJSON *json = cJSON_CreateObject();
    cJSON_AddNumberToObject(json, "frames", o->frames);
    cJSON_AddNumberToObject(json, "depth_frames", o->frames);
    cJSON_AddNumberToObject(json, "triplets", room_triplets(o->frames, triplets));
    cJSON_AddNumberToObject(json, "width", o->width);
    cJSON_AddNumberToObject(json, "height", o->height);
    json_add_integer(json, "bytes", (int64_t)bytes);
    json_add_hash(json, "hash", hash);
    json_print(json);
}

int command_room(int argc, char **argv)
{
    options o = {.width = ROOM_SIDE, .height = ROOM_SIDE, .frames = ROOM_FRAMES, .seed = DEFAULT_SEED};
    file_options_parse(&parser, argc, argv, &o);
    drawing d = {0};
    uint64_t bytes = 0;
    char error[ERROR_BYTES];
    int status = write_recording(&o, &d, &bytes, error);
    cli_progress_end();
    if (status != 0) {
        return cli_error(CLI_BAD_INPUT, "%s", error);
    }
    if (o.json) {
        print_json(&o, d.hash, bytes);
        return CLI_OK;
    }
    printf("%s: %u frames of %ux%u, hash %016llx, %llu bytes\n", o.output, o.frames, o.width, o.height,
           (unsigned long long)d.hash, (unsigned long long)bytes);
    return CLI_OK;
}
