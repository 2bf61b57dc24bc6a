/* SPDX-License-Identifier: Apache-2.0 */
#include "evaluation/options.h"

#include <stdlib.h>
#include <string.h>

#include "cli/cli.h"
#include "cli/jobs/process_pool.h"
#include "cli/options/file_options.h"
#include "cli/options/option_values.h"
#include "evaluation/cases.h"
#include "reconstruction/chosen_head.h"
#include "reconstruction/options/option_names.h"
#include "reconstruction/options/poses_option.h"
#include "scene/scene_options.h"

enum { KEY_CONTEXT = 0x200, KEY_TARGET, KEY_VIEWS, KEY_KEEP, KEY_GAUSSIANS, KEY_HEADS, KEY_SIZE, KEY_JOBS };

static void parse_heads(struct argp_state *state, evaluation_options *o, const char *text)
{
    char *rest = NULL, *own = strdup(text);
    if (own == NULL) {
        argp_failure(state, CLI_BAD_INPUT, 0, "out of memory");
        return;
    }
    o->head_count = 0;
    for (char *part = own; part != NULL; part = rest) {
        rest = strchr(part, ',');
        if (rest != NULL) {
            *rest++ = '\0';
        }
        if (o->head_count == EVALUATION_HEADS_MOST) {
            argp_error(state, "--heads takes at most %u heads", EVALUATION_HEADS_MOST);
        }
        (void)option_head(state, "heads", part);
        o->heads[o->head_count++] = part;
    }
}

static void check_scene(struct argp_state *state, const evaluation_options *o)
{
    if (o->planar || o->from_file || o->head_count > 0 || o->keep_count > 0 || o->gaussians_count > 0 ||
        reconstruction_chooses(&o->settings) || o->settings.points_of != NULL || o->settings.poses != POSES_GIVEN) {
        argp_error(
            state,
            "--scene is scored as it is: it excludes --planar, --from-file, --heads, --keep, --gaussians, --auto, "
            "--min-psnr, --prune and --poses");
    }
}

static void check_options(struct argp_state *state, evaluation_options *o)
{
    if (o->input_count == 0) {
        argp_error(state, o->planar ? "IMAGE... is missing" : "REC.mcap is missing");
    }
    uint32_t pair[2];
    if (evaluation_name_parts(o->inputs, o->input_count, pair) == 0) {
        argp_error(state, "%s and %s would have the same name", o->inputs[pair[0]], o->inputs[pair[1]]);
    }
    if (o->planar && (o->has_target || reconstruction_names_context(&o->settings))) {
        argp_error(state, "--planar takes images, not --context and --target");
    }
    if (o->planar && o->settings.context_views > 2) {
        argp_error(state, "--views belongs to a recording, not to --planar");
    }
    if (o->settings.context_views > 2 && o->settings.context_count > o->settings.context_views) {
        argp_error(state, "--context names more frames than --views");
    }
    if (o->settings.context_views > 2 && o->settings.context_kind != CONTEXT_LISTED) {
        argp_error(state, "--views adds frames to a listed --context, not to all or auto");
    }
    if (o->planar && o->settings.poses != POSES_GIVEN) {
        argp_error(state, "--poses belongs to a recording, not to --planar");
    }
    if (o->planar && o->settings.config.depth != T3R_DEPTH_SENSOR) {
        argp_error(state, "--depth belongs to a recording, not to --planar");
    }
    if (!o->planar && o->width != 0) {
        argp_error(state, "--size belongs to --planar; --working sets the size of a recording's views");
    }
    if (o->planar && o->settings.config.width != 0) {
        argp_error(state, "--working belongs to a recording; --size sets the size of --planar");
    }
    if (o->has_target != reconstruction_names_context(&o->settings)) {
        argp_error(state,
                   "--context and --target belong together; without both, all triplets of the recording are taken");
    }
    if (o->to.resume && (o->to.csv == NULL || o->to.page != NULL || o->from_file)) {
        argp_error(state, "--resume needs --csv, and excludes --html, whose pictures are not kept, and --from-file");
    }
    if (o->settings.scene != NULL) {
        check_scene(state, o);
    }
    const bool budgeted = o->keep_count > 0 || o->gaussians_count > 0 || o->settings.scene != NULL;
    if (!budgeted && reconstruction_chooses(&o->settings)) {
        o->keep[o->keep_count++] = 100;
    }
    if (!budgeted && o->keep_count == 0) {
        argp_error(state, "the budget is missing: --keep P, --gaussians Z, --auto or --min-psnr DB");
    }
    if (o->head_count > 0 && o->settings.head != NULL) {
        argp_error(state, "--head and --heads exclude each other");
    }
    if (o->settings.head == NULL) {
        o->settings.head = CHOSEN_HEAD_DEFAULT;
    }
    if (o->planar && o->width == 0) {
        o->width = o->height = 256;
    }
    if (o->settings.points_of != NULL && (o->planar || o->settings.context_views > 2)) {
        argp_error(state, "--prune takes the views that its scene was made of: it excludes --planar and --views");
    }
}

static error_t parse(int key, char *arg, struct argp_state *state)
{
    evaluation_options *o = state->input;
    switch (key) {
    case ARGP_KEY_INIT:
        state->child_inputs[0] = &o->settings;
        state->child_inputs[1] = &o->settings.poses;
        state->child_inputs[2] = &o->settings.scene_flags;
        return 0;
    case KEY_CONTEXT:
        reconstruction_parse_context(state, arg, &o->settings);
        return 0;
    case KEY_TARGET:
        o->target = option_number(state, "target", arg, 0, UINT32_MAX);
        o->has_target = true;
        return 0;
    case KEY_VIEWS:
        o->settings.context_views = option_number(state, "views", arg, 2, T3R_MAX_VIEWS);
        return 0;
    case KEY_KEEP:
        option_keep(state, arg, o->keep, EVALUATION_BUDGETS_MOST, &o->keep_count);
        return 0;
    case KEY_GAUSSIANS:
        option_counts(state, "gaussians", arg, T3R_MAX_GAUSSIANS, o->gaussians, EVALUATION_BUDGETS_MOST,
                      &o->gaussians_count);
        return 0;
    case KEY_HEADS:
        parse_heads(state, o, arg);
        return 0;
    case KEY_SIZE:
        option_size(state, "size", arg, T3R_MIN_SIDE, &o->width, &o->height);
        return 0;
    case KEY_JOBS:
        o->processes = strcmp(arg, "all") == 0 ? process_pool_processors()
                                               : option_number(state, "jobs", arg, 1, PROCESS_POOL_MOST);
        return 0;
    case ARGP_KEY_ARGS:
        option_arguments(state, &o->inputs, &o->input_count);
        return 0;
    case ARGP_KEY_END:
        check_options(state, o);
        return 0;
    default:
        return option_field(key, arg, state);
    }
}

static const struct argp_option options[] = {
    OPTION_ARGUMENTS("REC.mcap", OPTION_READS | OPTION_FOLDER),
    {NULL, 0, NULL, 0, "What is compared:", 1},
    {"context", KEY_CONTEXT, "LIST|all|auto", 0,
     "frames that the scene is made of: 0,2 or 0-3 or 0:11:2, one named twice counting once; all, but without the "
     "target; or auto, chosen of those (all triplets that the recording carries)",
     0},
    {"target", KEY_TARGET, "T", 0, "frame to compare the rendered view with; the method never sees it", 0},
    {"views", KEY_VIEWS, "N", 0,
     "frames of every context, 2..16 (2: the triplet's own, or --context); those nearest to the target are added", 0},
    {"keep", KEY_KEEP, "P,P,...", 0, "percents of the valid points, one row each; with --auto the upper bound (100)",
     0},
    {"gaussians", KEY_GAUSSIANS, "Z,Z,...", 0,
     "numbers of Gaussians, one row each, after those of --keep: all valid points if there are fewer", 0},
    {"prune", OPTION_TO(evaluation_options, settings.points_of), "SCENE.ply", OPTION_READS,
     "scene, made elsewhere of the views of --context, to prune: percents are of its Gaussians; trim3r makes new ones "
     "of points among their means",
     0},
    {"scene", OPTION_TO(evaluation_options, settings.scene), "SCENE", OPTION_READS,
     "scene file, of trim3r or made elsewhere, to score as it is: nothing is built; it is in the recording's "
     "world, and the frames of --context, or of the triplets, make the mask alone",
     0},
    {"heads", KEY_HEADS, CHOSEN_HEAD_VALUES ",...", OPTION_READS | OPTION_LIST | OPTION_OR_WORD,
     "heads to compare, as --head takes them: rows of the method trim3r for each", 0},
    {"planar", OPTION_TO(evaluation_options, planar), NULL, 0,
     "take images as arguments: each is one view on a plane of constant depth, drawn again from the same camera", 0},
    {"size", KEY_SIZE, "WxH", 0, "size to which --planar crops and averages images (256x256)", 0},
    {"from-file", OPTION_TO(evaluation_options, from_file), NULL, 0,
     "write each scene as .ply, read it back and draw that", 0},
    {NULL, 0, NULL, 0, "What is written:", 2},
    {"csv", OPTION_TO(evaluation_options, to.csv), "FILE", OPTION_WRITES(FILE_TABLE) | OPTION_PIPE,
     "table to write; each row appears when it is made, or without --resume all at the end if a table exists", 0},
    {"images", OPTION_TO(evaluation_options, to.images), "DIR", OPTION_WRITES(FILE_PICTURE) | OPTION_FOLDER,
     "folder to write pictures into: DIR/<target>/<method>_<keep>.png, target.png, mask.png, context_a.png, ...; with "
     "--heads <head> is in the name, and settings that are not the default come before <keep>, as in "
     "trim3r_refine-0_10.png; the column picture names each",
     0},
    {"html", OPTION_TO(evaluation_options, to.page), "PAGE.html", OPTION_WRITES(FILE_PAGE),
     "page to write, with the pictures side by side; it needs no other file", 0},
    {"wide", OPTION_TO(evaluation_options, to.wide), NULL, 0,
     "print all main columns, in 224 characters, not those that fit 80; several methods or heads print them always", 0},
    {"json", OPTION_TO(evaluation_options, to.json), NULL, 0,
     "print one JSON object on stdout: rows, means over the cases, refused cases", 0},
    {NULL, 0, NULL, 0, "How the work is done:", 3},
    {"jobs", KEY_JOBS, "N", 0,
     "processes that share the cases, 1..256, or all: one for each processor (1); times are then those of a busy "
     "machine",
     0},
    {"resume", OPTION_TO(evaluation_options, to.resume), NULL, 0,
     "skip rows that are in --csv already, and add the others to it; a table older than the program or a recording is "
     "refused",
     0},
    {0},
};

/* Apart from the other texts: a string has at most 4095 characters. */
static const char examples[] = "Examples:\n"
                               "  trim3r eval room.mcap --keep 100,20,10\n"
                               "  trim3r eval room.mcap --context 0,2 --target 1 --keep 20 --images dir\n"
                               "  trim3r eval room.mcap --keep 20,5 --views 4\n"
                               "  trim3r eval room.mcap --gaussians 20000,5000 --poses estimate\n"
                               "  trim3r eval room.mcap --keep 10,5 --heads analytic,small,my.t3w\n"
                               "  trim3r eval room.mcap --prune s.ply --context 0,2 --target 1 --keep 20\n"
                               "  trim3r eval *.mcap --keep 40,10 --jobs all --csv all.csv --resume\n"
                               "  trim3r eval room.mcap --scene mine.ply\n"
                               "  trim3r eval --planar photo.jpg --keep 10,5 --html photo.html";

static char *add_examples(int key, const char *text, void *input)
{
    (void)input;
    return key == ARGP_KEY_HELP_EXTRA ? strdup(examples) : (char *)(uintptr_t)text;
}

static const struct argp_child children[] = {
    {.argp = &reconstruction_settings_argp}, {.argp = &poses_argp}, {.argp = &scene_input_argp}, {0}};

const struct argp evaluation_argp = {
    .options = options,
    .parser = parse,
    .args_doc = "REC.mcap...\n--planar IMAGE...",
    .doc = "Score views of a reconstruction against recorded ones.\v"
           "A row is one scene, context, target, method, head and budget. Cells that do not apply are empty. Several "
           "cases end in lines of means, which the CSV leaves out.\n"
           "  keep          percent of the valid points that was asked for\n"
           "  requested     number of Gaussians that was asked for instead\n"
           "  bits          of a network's weights, and of its activations if not the same\n"
           "  psnr_all      of the picture as far as the lens reaches, over black;\n"
           "                decibels are averaged as decibels\n"
           "  ssim_all, perceptual_all\n"
           "                of the same pixels\n"
           "  psnr, ssim    on the mask\n"
           "  sharp         mean gradient over the target's, on the mask\n"
           "  perceptual    FLIP at 67 pixels a degree, on the mask; 0 = no difference\n"
           "  holes         share of the mask that keeps a transmittance above 0.5\n"
           "  psnr_seen     psnr, but empty where a frame has no depth: a mean of it\n"
           "                never mixes masks with whole pictures\n"
           "  planar_psnr   of all pixels of --planar, where no score has a mask\n"
           "  context_psnr  mean over the context views, each on its own mask\n"
           "  build_ms      recorded frames to scene\n"
           "  render_ms     the target view\n"
           "  scene_bytes   the Gaussians as the arena holds them, 44 bytes each\n"
           "  loss          of --auto: decibels lost, measured between the context views\n"
           "  picture       the name of the render within --images\n"
           "  bits_epoch    of the program: results of other epochs have other bits\n"
           "The mask: the pixels whose surface a context view saw. Their recorded depth puts a point into a context "
           "view that measured the same depth there, within 5 %, at the nearest pixel or beside it. Where the target "
           "or a context view has no recorded depth, the mask is the whole picture. No scene is built for it, and "
           "--depth does not change it. With --poses estimate it follows the recorded poses, if there are any.\n"
           "\n"
           "--views N: the frames of the triplet, or of --context, come first. Then come the other frames that have "
           "pose, intrinsics and (but for --depth stereo) depth, the nearest to the target's camera first. The "
           "distance is the root of a sum of two squares: the distance of the centres over the median depth of the "
           "first frame, and the distance of the viewing directions as unit vectors. Of equal ones the lower index "
           "is taken; the target is never taken. The mask is of all N. A recording with too few frames is refused.\n"
           "\n"
           "--poses estimate: the first context view and the target keep their recorded poses, so that errors of "
           "the others show. build_ms does not count the estimate.\n"
           "\n"
           "Refused cases (without depth or stereo match) are left out and reported, and --resume tries them again. "
           "If no case is left, the exit status is 1.\n",
    .help_filter = add_examples,
    .children = children,
};

void evaluation_defaults(evaluation_options *o)
{
    *o = (evaluation_options){.processes = 1};
    reconstruction_defaults(&o->settings);
    o->settings.head = NULL; /* until one is named */
}

void evaluation_options_free(evaluation_options *o)
{
    free(o->heads[0]);
}
