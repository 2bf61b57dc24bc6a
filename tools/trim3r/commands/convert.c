/* SPDX-License-Identifier: Apache-2.0 */
/* trim3r convert: a scene file to another format. */
#include "trim3r/commands/commands.h"

#include <argp.h>
#include <inttypes.h>
#include <stdio.h>

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
    bool json;
} options;

enum { KEY_UP = 0x100 };

static error_t parse_option(int key, char *argument, struct argp_state *state)
{
    options *o = state->input;
    switch (key) {
    case ARGP_KEY_INIT:
        state->child_inputs[0] = &o->flags;
        return 0;
    case 'o':
        o->output = argument;
        return 0;
    case KEY_UP:
        o->flags |= SCENE_FILE_UP * (int)scene_up_option(state, argument);
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
    {"json", OPTION_TO(options, json), NULL, 0, "print one JSON object on stdout", 0},
    {0},
};

static const struct argp_child children[] = {{.argp = &scene_input_argp}, {0}};
static const struct argp argp = {
    .options = argp_options,
    .parser = parse_option,
    .args_doc = "SCENE.ply",
    .doc = "Turn a scene file into another format.\v"
           "The scene's first bytes determine the format to read, the "
           "ending of -o the one to write. Harmonics are kept up to the degree that the format holds.\n"
           "\n"
           "Examples:\n"
           "  trim3r convert scene.ply -o scene.spz\n"
           "  trim3r convert theirs.compressed.ply -o theirs.ply\n"
           "  trim3r convert scene.ply --up z -o scene.splat",
    .children = children,
};

static void report(const options *o, const scene_conversion *done)
{
    if (o->json) {
        cJSON *root = cJSON_CreateObject();
        cJSON_AddStringToObject(root, "scene", o->output);
        json_add_integer(root, "gaussians", done->count);
        json_add_integer(root, "degree_read", done->degree_read);
        json_add_integer(root, "degree", done->degree);
        json_print(root);
        return;
    }
    printf("%s: %" PRIu32 " Gaussians, harmonics of degree %" PRIu32, o->output, done->count, done->degree);
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
    if (scene_file_convert(o.scene, o.output, o.flags, &done, error, sizeof error) != 0) {
        return cli_error(CLI_BAD_INPUT, "%s", error);
    }
    report(&o, &done);
    return CLI_OK;
}
