/* SPDX-License-Identifier: Apache-2.0 */
/* trim3r convert: a scene file to another format. */
#include "trim3r/commands/commands.h"

#include <argp.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "cli/cli.h"
#include "cli/options/file_options.h"
#include "cli/options/option_values.h"
#include "cli/tables/json_output.h"
#include "scene/scene_file.h"
#include "scene/scene_options.h"

#define ERROR_BYTES 512

typedef struct options {
    const char *scene, *output;
    int flags; /* SCENE_FILE_... */
    scene_crop crop;
    bool crops, json;
} options;

enum { KEY_UP = 0x100, KEY_CROP, KEY_MIN_OPACITY };

/* Returns the bound at the start of a text, `none` if it is empty, and moves the text beyond it; NAN: it is no number.
 */
static double take_bound(const char **text, double none)
{
    char *end;
    const double value = strtod(*text, &end);
    const bool is_empty = **text == ',' || **text == '\0';
    *text = end;
    return is_empty ? none : isfinite(value) ? value : NAN;
}

static void parse_crop(struct argp_state *state, const char *text, scene_crop *crop)
{
    const char *rest = text;
    bool is_box = true;
    for (int i = 0; i < 6 && is_box; i++) {
        double *bound = i < 3 ? &crop->low[i] : &crop->high[i - 3];
        *bound = take_bound(&rest, *bound);
        is_box = (i < 3 || crop->low[i - 3] <= *bound) && *rest++ == (i < 5 ? ',' : '\0');
    }
    if (!is_box) {
        argp_error(state, "--crop takes two corners of a box, the lower one first: X,Y,Z,X,Y,Z, not '%s'", text);
    }
}

static error_t parse_option(int key, char *argument, struct argp_state *state)
{
    options *o = state->input;
    switch (key) {
    case ARGP_KEY_INIT:
        state->child_inputs[0] = &o->flags;
        o->crop = (scene_crop){{-INFINITY, -INFINITY, -INFINITY}, {INFINITY, INFINITY, INFINITY}, 0};
        return 0;
    case 'o':
        o->output = argument;
        return 0;
    case KEY_UP:
        o->flags |= SCENE_FILE_UP * (int)scene_up_option(state, argument);
        return 0;
    case KEY_CROP:
        parse_crop(state, argument, &o->crop);
        o->crops = true;
        return 0;
    case KEY_MIN_OPACITY:
        o->crop.opacity = option_decimal(state, "min-opacity", argument, 0, 1);
        o->crops = true;
        return 0;
    case ARGP_KEY_ARG:
        option_argument(state, argument, (const char **[]){&o->scene}, 1);
        return 0;
    case ARGP_KEY_END:
        if (o->scene == NULL || o->output == NULL) {
            argp_error(state, o->scene == NULL ? "SCENE is missing" : "-o SCENE is missing");
        }
        scene_output_option(state, "-o", o->output);
        return 0;
    default:
        return option_field(key, argument, state);
    }
}

static const struct argp_option argp_options[] = {
    OPTION_ARGUMENTS("SCENE", OPTION_READS | OPTION_FOLDER),
    {"output", 'o', "SCENE", OPTION_WRITES(FILE_SCENE) | OPTION_PIPE,
     "scene to write (needed); its ending names the format; -: .ply to standard output", 0},
    {"up", KEY_UP, "x|-x|y|-y|z|-z", 0,
     "axis of the scene that points up: the file is turned so that y does, for viewers that "
     "want "
     "it (not turned; .spz and .glb as for -y)",
     0},
    {"crop", KEY_CROP, "X,Y,Z,X,Y,Z", 0,
     "keep the Gaussians whose means are in the box between two corners, the lower one first, in the units and axes "
     "of `trim3r info`; a number that is left out is no bound (all)",
     0},
    {"min-opacity", KEY_MIN_OPACITY, "A", 0, "keep the Gaussians of an opacity of at least A, 0..1 (0)", 0},
    {"json", OPTION_TO(options, json), NULL, 0, "print one JSON object on stdout", 0},
    {0},
};

static const struct argp_child children[] = {{.argp = &scene_input_argp}, {0}};
static const struct argp argp = {
    .options = argp_options,
    .parser = parse_option,
    .args_doc = "SCENE.ply",
    .doc = "Turn a scene file into another format, or cut a part out of it.\v"
           "The scene's first bytes determine the format to read, the "
           "ending of -o the one to write. Harmonics are kept up to the degree that the format holds.\n"
           "\n"
           "Examples:\n"
           "  trim3r convert scene.ply -o scene.spz\n"
           "  trim3r convert theirs.compressed.ply -o theirs.ply\n"
           "  trim3r convert theirs.ply --crop=-1,,0,1,,2.5 -o part.ply\n"
           "  trim3r convert scene.ply --up z -o scene.splat",
    .children = children,
};

static void report(const options *o, const scene_conversion *done)
{
    if (o->json) {
        cJSON *root = cJSON_CreateObject();
        cJSON_AddStringToObject(root, "scene", o->output);
        json_add_integer(root, "gaussians_read", done->count_read);
        json_add_integer(root, "gaussians", done->count);
        json_add_integer(root, "degree_read", done->degree_read);
        json_add_integer(root, "degree", done->degree);
        json_print(root);
        return;
    }
    printf("%s: %" PRIu32, o->output, done->count);
    if (o->crops || done->count < done->count_read) {
        printf(" of %" PRIu32, done->count_read);
    }
    printf(" Gaussians, harmonics of degree %" PRIu32, done->degree);
    if (done->degree < done->degree_read) {
        printf(" (%" PRIu32 " were read)", done->degree_read);
    }
    putchar('\n');
}

int command_convert(int argc, char **argv)
{
    options o = {0};
    file_options_parse(&argp, argc, argv, &o);
    char error[ERROR_BYTES] = "";
    scene_conversion done;
    if (scene_file_convert(o.scene, o.output, o.flags, o.crops ? &o.crop : NULL, &done, error, sizeof error) != 0) {
        return cli_error(CLI_BAD_INPUT, "%s", error);
    }
    report(&o, &done);
    return CLI_OK;
}
