/* trim3r import: a posed folder to a recording. */
#include "commands.h"

#include <argp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli.h"
#include "import_frame.h"
#include "json_output.h"
#include "option_values.h"
#include "posed_folder.h"
#include "reason.h"
#include "recording.h"
#include "trim3r.h"
#include "whole_file.h"

#define ERROR_BYTES 1024

typedef struct options {
    const char *directory;
    const char *output;
    uint32_t width, height; /* 0 = as the pictures are */
    double intrinsics[9];
    uint32_t intrinsics_count;
    bool json;
} options;

typedef struct totals {
    uint32_t width, height; /* of every frame */
    uint32_t depth_frames;
    uint64_t bytes;
} totals;

enum { KEY_INTRINSICS = 0x100, KEY_JSON };

static int parse_numbers(const char *text, double *numbers, uint32_t most, uint32_t *count)
{
    *count = 0;
    for (;;) {
        char *end;
        double value = strtod(text, &end);
        if (end == text || *count == most || !(value > -1e6 && value < 1e6)) {
            return -1;
        }
        numbers[(*count)++] = value;
        if (*end == '\0') {
            return 0;
        }
        if (*end != ',') {
            return -1;
        }
        text = end + 1;
    }
}

static void check_options(struct argp_state *state, const options *o)
{
    if (o->directory == NULL) {
        argp_error(state, "DIR is missing");
    }
    if (o->output == NULL) {
        argp_error(state, "-o REC.mcap is missing");
    }
}

static error_t parse_option(int key, char *argument, struct argp_state *state)
{
    options *o = state->input;
    switch (key) {
    case 's':
        option_size(state, "size", argument, T3R_MIN_SIDE, &o->width, &o->height);
        return 0;
    case KEY_INTRINSICS:
        if (parse_numbers(argument, o->intrinsics, 9, &o->intrinsics_count) != 0 ||
            (o->intrinsics_count != 4 && o->intrinsics_count != 9) || !(o->intrinsics[0] > 0) ||
            !(o->intrinsics[1] > 0)) {
            argp_error(state, "--intrinsics %s: not fx,fy,cx,cy[,k1,k2,p1,p2,k3]", argument);
        }
        return 0;
    case 'o':
        o->output = argument;
        return 0;
    case KEY_JSON:
        o->json = true;
        return 0;
    case ARGP_KEY_ARG:
        option_argument(state, argument, (const char **[]){&o->directory}, 1);
        return 0;
    case ARGP_KEY_END:
        check_options(state, o);
        return 0;
    default:
        return ARGP_ERR_UNKNOWN;
    }
}

static const struct argp_option argp_options[] = {
    {"output", 'o', "REC.mcap", 0, "The recording to write; it appears when it is whole", 0},
    {"size", 's', "WxH", 0,
     "Crop every picture to the largest centred part of that aspect, then resize: colour by area average, depth by the "
     "pixel at the centre of each box",
     0},
    {"intrinsics", KEY_INTRINSICS, "LIST", 0,
     "TUM RGB-D: the colour camera as fx,fy,cx,cy[,k1,k2,p1,p2,k3] in pixels, (0, 0) being the centre of the top-left "
     "pixel; known for folders with freiburg1, freiburg2 or freiburg3 in their name",
     0},
    {"json", KEY_JSON, NULL, 0, "One JSON object on stdout", 0},
    {0},
};

static const struct argp parser = {
    .options = argp_options,
    .parser = parse_option,
    .args_doc = "DIR",
    .doc = "Turn a posed folder into a recording.\v"
           "DIR holds transforms.json (instant-ngp, NeRFCapture, nerfstudio: camera_model OPENCV or OPENCV_FISHEYE, "
           "depth_path with integer_depth_scale, trim3r_triplets) or rgb.txt, groundtruth.txt and optionally depth.txt "
           "(TUM RGB-D; pictures without a pose are left out). Frames get stamps 1/30 s apart.\n\n"
           "Examples:\n"
           "  trim3r import scene --size 256x256 -o scene.mcap\n"
           "  trim3r import rgbd_dataset_freiburg1_desk -o desk.mcap\n"
           "  trim3r import desk --intrinsics 525,525,319.5,239.5 -o desk.mcap",
};

/* The folder's own name: what the recording says it was made from. */
static char *source_name(const char *directory, const char *kind)
{
    char *full = realpath(directory, NULL);
    const char *slash = full == NULL ? NULL : strrchr(full, '/');
    const char *base = slash != NULL && slash[1] != '\0' ? slash + 1 : directory;
    size_t bytes = strlen(base) + strlen(kind) + 16;
    char *name = malloc(bytes);
    if (name != NULL) {
        snprintf(name, bytes, "%s (%s)", base, kind);
    }
    free(full);
    return name;
}

static int write_frame(t3r_recorder *recorder, const options *o, const posed_folder *folder, uint32_t index, totals *t,
                       char *error)
{
    const posed_frame *frame = &folder->frames[index];
    char reason[ERROR_BYTES];
    import_buffers buffers;
    t3r_recorded_frame recorded;
    int status = import_frame(o->directory, frame, o->width, o->height, &buffers, &recorded, reason, sizeof reason);
    if (status != 0) {
        t3r_reason(error, ERROR_BYTES, "%s: frame %u: %.700s", o->directory, index, reason);
    } else if (index > 0 && (recorded.width != t->width || recorded.height != t->height)) {
        status = t3r_reason(error, ERROR_BYTES, "%s: frame %u: %s: %ux%u pixels, but frame 0 has %ux%u; give --size",
                            o->directory, index, frame->image, recorded.width, recorded.height, t->width, t->height);
    } else {
        recorded.stamp_ns = (int64_t)index * 1000000000 / 30;
        t->width = recorded.width;
        t->height = recorded.height;
        t->depth_frames += recorded.depth != NULL;
        if (t3r_recorder_frame(recorder, &recorded) != 0) {
            status = t3r_reason(error, ERROR_BYTES, "%s: frame %u cannot be written", o->output, index);
        }
    }
    import_buffers_free(&buffers);
    return status;
}

static int write_frames(t3r_recorder *recorder, FILE *stream, const options *o, const posed_folder *folder,
                        const char *source, totals *t, char *error)
{
    t3r_recording_header header = {.camera = "camera",
                                   .source = source,
                                   .clock = "synthetic",
                                   .depth_unit = folder->depth_unit,
                                   .triplets = folder->triplets,
                                   .triplet_count = folder->triplet_count};
    if (t3r_recorder_begin(recorder, t3r_file_sink(stream), &header) != 0) {
        return t3r_reason(error, ERROR_BYTES, "%s: cannot be written", o->output);
    }
    for (uint32_t i = 0; i < folder->frame_count; i++) {
        cli_progress("importing", i, folder->frame_count);
        if (write_frame(recorder, o, folder, i, t, error) != 0) {
            return -1;
        }
    }
    if (t3r_recorder_end(recorder) != 0) {
        return t3r_reason(error, ERROR_BYTES, "%s: cannot be written", o->output);
    }
    return 0;
}

static int write_recording(const options *o, const posed_folder *folder, totals *t, char *error)
{
    whole_file file;
    char *source = source_name(o->directory, folder->kind);
    t3r_recorder *recorder = malloc(t3r_recorder_bytes());
    int status = -1;
    if (source == NULL || recorder == NULL) {
        t3r_reason(error, ERROR_BYTES, "out of memory");
    } else if (whole_file_begin(&file, o->output, error, ERROR_BYTES) == 0) {
        status = write_frames(recorder, file.stream, o, folder, source, t, error);
        if (status == 0) {
            status = whole_file_commit(&file, &t->bytes, error, ERROR_BYTES);
        } else {
            whole_file_abandon(&file);
        }
    }
    free(recorder);
    free(source);
    return status;
}

static void print_json(const posed_folder *folder, const totals *t)
{
    cJSON *json = cJSON_CreateObject();
    cJSON_AddNumberToObject(json, "frames", folder->frame_count);
    cJSON_AddNumberToObject(json, "depth_frames", t->depth_frames);
    cJSON_AddNumberToObject(json, "triplets", folder->triplet_count);
    cJSON_AddNumberToObject(json, "width", t->width);
    cJSON_AddNumberToObject(json, "height", t->height);
    json_add_integer(json, "bytes", (int64_t)t->bytes);
    cJSON_AddNumberToObject(json, "skipped", folder->skipped);
    json_print(json);
}

int command_import(int argc, char **argv)
{
    options o = {0};
    argp_parse(&parser, argc, argv, 0, NULL, &o);
    posed_folder_options how = {.intrinsics = o.intrinsics, .intrinsics_count = o.intrinsics_count};
    posed_folder folder;
    totals t = {0};
    char error[ERROR_BYTES];
    int status = posed_folder_open(o.directory, &how, &folder, error, sizeof error);
    if (status == 0) {
        status = write_recording(&o, &folder, &t, error);
        cli_progress_end();
    }
    if (status != 0) {
        status = cli_error(CLI_BAD_INPUT, "%s", error);
    } else if (o.json) {
        print_json(&folder, &t);
    } else {
        printf("%s: %u frames of %ux%u (%u with depth), %u triplets, %llu bytes\n", o.output, folder.frame_count,
               t.width, t.height, t.depth_frames, folder.triplet_count, (unsigned long long)t.bytes);
        if (folder.skipped > 0) {
            printf("left out: %u pictures without a pose near in time\n", folder.skipped);
        }
    }
    posed_folder_close(&folder);
    return status;
}
