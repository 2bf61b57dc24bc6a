/* SPDX-License-Identifier: Apache-2.0 */
/* trim3r trouble: writes a recording with a trouble in some of its frames. */
#include "study/commands/commands.h"

#include <argp.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/cli.h"
#include "cli/files/recorded_frame.h"
#include "cli/files/whole_file.h"
#include "cli/options/file_options.h"
#include "cli/options/option_values.h"
#include "host/reason.h"
#include "host/text.h"
#include "import/import_source.h"
#include "study/troubles/trouble.h"

#define ERROR_BYTES 512

typedef struct options {
    const char *recording, *output;
    const trouble *what;
    uint32_t first, count;
} options;

enum { KEY_WITH = 0x100, KEY_AT, KEY_FOR };

static error_t parse_option(int key, char *argument, struct argp_state *state)
{
    options *o = state->input;
    switch (key) {
    case KEY_WITH:
        o->what = NULL;
        for (uint32_t i = 0; trouble_at(i) != NULL; i++) {
            o->what = strcmp(trouble_at(i)->name, argument) == 0 ? trouble_at(i) : o->what;
        }
        if (o->what == NULL) {
            argp_error(state, "--with does not know '%s'; --help lists what there is", argument);
        }
        return 0;
    case KEY_AT:
        o->first = option_number(state, "at", argument, 1, UINT32_MAX);
        return 0;
    case KEY_FOR:
        o->count = option_number(state, "for", argument, 1, 100000);
        return 0;
    case 'o':
        o->output = argument;
        return 0;
    case ARGP_KEY_ARG:
        option_argument(state, argument, (const char **[]){&o->recording}, 1);
        return 0;
    case ARGP_KEY_END:
        if (o->recording == NULL || o->output == NULL || o->what == NULL) {
            argp_error(state, "REC.mcap, --with or -o is missing");
        }
        if (o->count > o->first) {
            argp_error(state, "--for is at most --at");
        }
        return 0;
    default:
        return option_field(key, argument, state);
    }
}

static const struct argp_option argp_options[] = {
    OPTION_ARGUMENTS("REC.mcap", OPTION_READS | OPTION_FOLDER),
    {"output", 'o', "OUT.mcap", OPTION_WRITES(FILE_RECORDING), "recording to write (needed)", 0},
    {"with", KEY_WITH, "TROUBLE", 0, "the trouble, listed below (needed)", 0},
    {"at", KEY_AT, "N", 0, "the first frame that has it, at least 1 (10)", 0},
    {"for", KEY_FOR, "N", 0, "number of frames that have it, at most --at (3)", 0},
    {0},
};

/* Appends the list of troubles to the help. */
static char *list_troubles(int key, const char *text, void *input)
{
    (void)input;
    if (key != ARGP_KEY_HELP_POST_DOC) {
        return (char *)(uintptr_t)text;
    }
    char *list = NULL;
    size_t bytes = 0;
    FILE *stream = open_memstream(&list, &bytes);
    if (stream == NULL) {
        return NULL;
    }
    fprintf(stream, "%s\n\nTroubles:\n", text);
    for (uint32_t i = 0; trouble_at(i) != NULL; i++) {
        fprintf(stream, "  %-12s %s\n", trouble_at(i)->name, trouble_at(i)->about);
    }
    fclose(stream);
    return list;
}

static const struct argp parser = {
    .options = argp_options,
    .parser = parse_option,
    .args_doc = "REC.mcap",
    .doc = "Write a recording with a trouble in some of its frames, for `trim3r replay --stream`. Frames are RGB24, as "
           "import writes them, and world units are metres.\v"
           "Examples:\n"
           "  trim3r trouble walk.mcap --with hand --at 20 --for 3 -o hand.mcap\n"
           "  trim3r trouble walk.mcap --with jump --at 20 -o jump.mcap",
    .help_filter = list_troubles,
};

/* Converts a fixed-point camera to doubles, exactly. */
static t3r_recorded_camera camera_of(const t3r_capture_frame *frame)
{
    const t3r_camera *from = &frame->camera;
    t3r_recorded_camera c = {.width = frame->frame.width, .height = frame->frame.height};
    c.fx = from->fx_q16 * 0x1p-16;
    c.fy = from->fy_q16 * 0x1p-16;
    c.cx = from->cx_q16 * 0x1p-16;
    c.cy = from->cy_q16 * 0x1p-16;
    c.distortion = from->distortion;
    for (int i = 0; i < 5; i++) {
        c.coefficients[i] = from->distortion_q24[i] * 0x1p-24;
    }
    for (int i = 0; i < 3; i++) {
        c.position[i] = ldexp((double)from->position_q32[i], -32);
    }
    for (int i = 0; i < 4; i++) {
        c.rotation[i] = from->rotation_q30[i] * 0x1p-30;
    }
    return c;
}

/* Copies the pixels of a frame; free both planes, also after false: out of memory. */
static bool copy_frame(const t3r_capture_frame *frame, int64_t stamp_ns, troubled_frame *copy)
{
    const t3r_frame *f = &frame->frame;
    const size_t row = (size_t)f->width * 3, depth_row = (size_t)f->depth_width * 2;
    *copy = (troubled_frame){.rgb = malloc(row * f->height), .depth_unit = ldexp((double)f->depth_unit_q40, -40)};
    copy->recorded = (t3r_recorded_frame){.stamp_ns = stamp_ns,
                                          .format = T3R_PIXEL_RGB24,
                                          .width = f->width,
                                          .height = f->height,
                                          .planes = {copy->rgb},
                                          .stride_bytes = {f->width * 3},
                                          .depth_width = f->depth_width,
                                          .depth_height = f->depth_height,
                                          .camera = camera_of(frame)};
    for (uint32_t y = 0; y < f->height && copy->rgb != NULL; y++) {
        memcpy(copy->rgb + y * row, f->planes[0] + (size_t)y * f->stride_bytes[0], row);
    }
    if (f->depth == NULL) {
        return copy->rgb != NULL;
    }
    copy->depth = malloc(depth_row * f->depth_height);
    for (uint32_t y = 0; y < f->depth_height && copy->depth != NULL; y++) {
        const uint8_t *from = f->depth + (size_t)y * f->depth_stride_bytes;
        for (uint32_t x = 0; x < f->depth_width; x++) {
            copy->depth[(size_t)y * f->depth_width + x] = (uint16_t)(from[2 * x] | from[2 * x + 1] << 8);
        }
    }
    return copy->rgb != NULL && copy->depth != NULL;
}

/* Writes frame `index` of the troubled recording, which shows frame `source`. */
static int write_frame(const options *o, const t3r_recording *recording, uint32_t index, uint32_t source,
                       t3r_recorder *recorder)
{
    t3r_capture_frame frame;
    int code = recorded_frame_read(recording, o->recording, source, &frame);
    if (code != CLI_OK) {
        return code;
    }
    if (frame.frame.format != T3R_PIXEL_RGB24) {
        return cli_error(CLI_BAD_INPUT, "%s: frame %" PRIu32 " is not RGB24", o->recording, source);
    }
    troubled_frame copy;
    bool done = copy_frame(&frame, (int64_t)index * 1000000000 / 30, &copy);
    uint16_t *depth = copy.depth;
    if (done) {
        trouble_apply(o->what, &copy, index, o->first, o->count);
        copy.recorded.depth = copy.depth;
        done = t3r_recorder_frame(recorder, &copy.recorded) == 0;
    }
    free(depth);
    free(copy.rgb);
    return done ? CLI_OK : cli_error(CLI_BAD_INPUT, "%s: frame %" PRIu32 " cannot be written", o->output, index);
}

static int write_frames(const options *o, const t3r_recording *recording, FILE *stream, t3r_recorder *recorder)
{
    const uint32_t frames = t3r_recording_frame_count(recording);
    const t3r_recording_header header = {.camera = "camera",
                                         .source = o->what->about,
                                         .clock = "synthetic",
                                         .depth_unit = ldexp((double)t3r_recording_depth_unit_q40(recording), -40)};
    int code = t3r_recorder_begin(recorder, t3r_file_sink(stream), &header) == 0
                   ? CLI_OK
                   : cli_error(CLI_BAD_INPUT, "%s: cannot be written", o->output);
    uint32_t source;
    for (uint32_t index = 0;
         code == CLI_OK && (source = trouble_source(o->what, index, frames, o->first, o->count)) != UINT32_MAX;
         index++) {
        code = write_frame(o, recording, index, source, recorder);
    }
    return code == CLI_OK && t3r_recorder_end(recorder) != 0
               ? cli_error(CLI_BAD_INPUT, "%s: cannot be written", o->output)
               : code;
}

static int write_recording(const options *o, const t3r_recording *recording)
{
    t3r_whole_file file;
    char error[ERROR_BYTES];
    t3r_recorder *recorder = malloc(t3r_recorder_bytes());
    if (recorder == NULL) {
        return cli_error(CLI_BAD_INPUT, "out of memory");
    }
    int code = CLI_OK;
    if (whole_file_begin(&file, o->output, error, sizeof error) != 0) {
        code = cli_error(CLI_BAD_INPUT, "%s", error);
    } else {
        code = write_frames(o, recording, file.stream, recorder);
        if (code != CLI_OK) {
            t3r_whole_file_abandon(&file);
        } else if (t3r_whole_file_commit(&file, NULL, error, sizeof error) != 0) {
            code = cli_error(CLI_BAD_INPUT, "%s", error);
        }
    }
    free(recorder);
    return code;
}

/* Prints which frames have the trouble, some or all to the end. */
static void report(const options *o, uint32_t frames)
{
    printf("%s: %s, ", o->output, o->what->name);
    if (o->what->lasts || o->count >= frames - o->first) {
        printf("from frame %" PRIu32 " on\n", o->first);
    } else if (o->count == 1) {
        printf("frame %" PRIu32 "\n", o->first);
    } else {
        printf("frames %" PRIu32 " to %" PRIu32 "\n", o->first, o->first + o->count - 1);
    }
}

int command_trouble(int argc, char **argv)
{
    options o = {.first = 10, .count = 3};
    file_options_parse(&parser, argc, argv, &o);
    t3r_recording *recording = import_source_open(o.recording);
    if (recording == NULL) {
        return CLI_BAD_INPUT;
    }
    const int code = o.first < t3r_recording_frame_count(recording)
                         ? write_recording(&o, recording)
                         : cli_error(CLI_BAD_INPUT, "%s has no frame %" PRIu32, o.recording, o.first);
    if (code == CLI_OK) {
        report(&o, t3r_recording_frame_count(recording));
    }
    t3r_recording_close(recording);
    return code;
}
