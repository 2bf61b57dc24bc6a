/* trim3r eval: scores of rendered views against recorded ones. */
#include "trim3r/commands/commands.h"

#include <argp.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "study/evaluation/ablation.h"
#include "cli/cli.h"
#include "cli/files/file_options.h"
#include "reconstruction/options/chosen_head.h"
#include "study/evaluation/settings.h"
#include "study/evaluation/work.h"
#include "cli/options/option_values.h"
#include "cli/tables/word_list.h"
#include "reconstruction/options/option_names.h"
#include "cli/work/process_pool.h"
#include "reconstruction/options/poses_option.h"
#include "reconstruction/reconstruction.h"
#include "reconstruction/scene_frames.h"

#define BUDGETS_MOST 64u /* percents, and counts */
#define ABLATE_KEEPS "60,40,20,10,5"

typedef struct options {
    reconstruction_options settings;
    char **inputs; /* recordings, or the images of --planar */
    uint32_t input_count;
    bool planar, has_target, from_file;
    uint32_t width, height; /* --size */
    uint32_t target;
    double keep[BUDGETS_MOST];
    uint32_t keep_count;
    uint32_t gaussians[BUDGETS_MOST];
    uint32_t gaussians_count;
    method_id methods[METHOD_COUNT];
    uint32_t method_count;
    char *heads[EVALUATION_HEADS_MOST]; /* --heads; parts of one heap string */
    uint32_t head_count;
    bool ablate;
    uint32_t ablations[ABLATIONS_MOST]; /* those named; none = all that apply */
    uint32_t ablation_count;
    uint32_t processes;
    evaluation_outputs to;
} options;

enum {
    KEY_CONTEXT = 0x200,
    KEY_TARGET,
    KEY_VIEWS,
    KEY_KEEP,
    KEY_GAUSSIANS,
    KEY_METHODS,
    KEY_PRUNE,
    KEY_SCENE,
    KEY_HEADS,
    KEY_MASK_HEAD,
    KEY_ABLATE,
    KEY_PLANAR,
    KEY_SIZE,
    KEY_CSV,
    KEY_IMAGES,
    KEY_HTML,
    KEY_FROM_FILE,
    KEY_JSON,
    KEY_JOBS,
    KEY_RESUME
};

/* ---- arguments ---------------------------------------------------------------------------------------------- */

static void parse_heads(struct argp_state *state, options *o, const char *text)
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

static void add_ablation(struct argp_state *state, options *o, list_word name)
{
    uint32_t found = 0;
    for (const char *known; (known = ablation_name(found)) != NULL; found++) {
        if (word_is(name, known)) {
            break;
        }
    }
    if (ablation_name(found) == NULL) {
        argp_error(state, "--ablate does not know '%.*s'; --help lists what can be ablated", (int)name.length,
                   name.text);
    }
    for (uint32_t i = 0; i < o->ablation_count; i++) {
        if (o->ablations[i] == found) {
            argp_error(state, "--ablate names %s twice", ablation_name(found));
        }
    }
    o->ablations[o->ablation_count++] = found;
}

static void parse_ablations(struct argp_state *state, options *o, const char *text)
{
    o->ablate = true;
    o->ablation_count = 0;
    for (list_word w = word_first(text); w.text != NULL; w = word_next(w)) {
        add_ablation(state, o, w);
    }
}

static void check_prune(struct argp_state *state, const options *o)
{
    if (o->planar || o->settings.context_views > 2) {
        argp_error(state, "--prune takes the views that its scene was made of: it excludes --planar and --views");
    }
    for (uint32_t m = 0; m < o->method_count; m++) {
        if (method_ranks_for_head(o->methods[m])) {
            argp_error(state,
                       "--prune takes no rival with +head: which pixels a file's Gaussians came from is not known");
        }
    }
}

static void check_scene(struct argp_state *state, const options *o)
{
    if (o->planar || o->from_file || o->ablate || o->method_count > 0 || o->head_count > 0 || o->keep_count > 0 ||
        o->gaussians_count > 0 || o->settings.automatic || o->settings.points_of != NULL ||
        o->settings.poses != POSES_GIVEN) {
        argp_error(state,
                   "--scene is scored as it is: it excludes --planar, --from-file, --ablate, --methods, --heads, "
                   "--keep, --gaussians, --auto, --prune and --poses");
    }
}

static void check_options(struct argp_state *state, options *o)
{
    if (o->input_count == 0) {
        argp_error(state, o->planar ? "IMAGE... is missing" : "REC.mcap is missing");
    }
    uint32_t pair[2];
    if (evaluation_name_parts(o->inputs, o->input_count, pair) == 0) {
        argp_error(state, "%s and %s would have the same name", o->inputs[pair[0]], o->inputs[pair[1]]);
    }
    if (o->planar && (o->has_target || o->settings.context_count > 0)) {
        argp_error(state, "--planar takes images, not --context and --target");
    }
    if (o->planar && o->settings.context_views > 2) {
        argp_error(state, "--views belongs to a recording, not to --planar");
    }
    if (o->settings.context_views > 2 && o->settings.context_count > o->settings.context_views) {
        argp_error(state, "--context names more frames than --views");
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
    if (o->has_target != (o->settings.context_count > 0)) {
        argp_error(state,
                   "--context and --target belong together; without both, all triplets of the recording are taken");
    }
    if (o->to.resume && (o->to.csv == NULL || o->to.page != NULL || o->from_file)) {
        argp_error(state, "--resume needs --csv, and excludes --html, whose pictures are not kept, and --from-file");
    }
    if (o->ablate && (o->method_count > 0 || o->head_count > 0)) {
        argp_error(state, "--ablate is of the method trim3r with one --head: it excludes --methods and --heads");
    }
    if (o->settings.scene != NULL) {
        check_scene(state, o);
    }
    const bool budgeted = o->keep_count > 0 || o->gaussians_count > 0 || o->settings.scene != NULL;
    if (o->ablate && !budgeted) {
        (void)cli_parse_list_percent(ABLATE_KEEPS, o->keep, BUDGETS_MOST, &o->keep_count);
    }
    if (!budgeted && o->settings.automatic) {
        o->keep[o->keep_count++] = 100;
    }
    if (!budgeted && o->keep_count == 0) {
        argp_error(state, "the budget is missing: --keep P, --gaussians Z or --auto");
    }
    if (o->method_count == 0) {
        o->methods[o->method_count++] = METHOD_TRIM3R;
    }
    if (o->head_count > 0 && o->settings.head != NULL) {
        argp_error(state, "--head and --heads exclude each other");
    }
    if (o->settings.head == NULL) {
        o->settings.head = CHOSEN_HEAD_DEFAULT;
    }
    for (uint32_t m = 0; m < o->method_count && o->settings.mask_head != NULL; m++) {
        if (!method_ranks_for_head(o->methods[m])) {
            argp_error(state, "--mask-head belongs to rivals with +head, not to %s", method_name(o->methods[m]));
        }
    }
    if (o->planar && o->width == 0) {
        o->width = o->height = 256;
    }
    if (o->settings.points_of != NULL) {
        check_prune(state, o);
    }
}

static error_t parse_option(int key, char *arg, struct argp_state *state)
{
    options *o = state->input;
    switch (key) {
    case ARGP_KEY_INIT:
        state->child_inputs[0] = &o->settings;
        state->child_inputs[1] = &o->settings.poses;
        return 0;
    case KEY_CONTEXT:
        option_frames(state, "context", arg, o->settings.context, &o->settings.context_count);
        return 0;
    case KEY_TARGET:
        o->target = option_number(state, "target", arg, 0, UINT32_MAX);
        o->has_target = true;
        return 0;
    case KEY_VIEWS:
        o->settings.context_views = option_number(state, "views", arg, 2, T3R_MAX_VIEWS);
        return 0;
    case KEY_KEEP:
        option_keep(state, arg, o->keep, BUDGETS_MOST, &o->keep_count);
        return 0;
    case KEY_GAUSSIANS:
        option_counts(state, "gaussians", arg, T3R_MAX_GAUSSIANS, o->gaussians, BUDGETS_MOST, &o->gaussians_count);
        return 0;
    case KEY_METHODS:
        option_methods(state, "methods", arg, o->methods, &o->method_count);
        return 0;
    case KEY_PRUNE:
        o->settings.points_of = arg;
        return 0;
    case KEY_SCENE:
        o->settings.scene = arg;
        return 0;
    case KEY_HEADS:
        parse_heads(state, o, arg);
        return 0;
    case KEY_MASK_HEAD:
        o->settings.mask_head = option_head(state, "mask-head", arg);
        return 0;
    case KEY_ABLATE:
        parse_ablations(state, o, arg);
        return 0;
    case KEY_PLANAR:
        o->planar = true;
        return 0;
    case KEY_SIZE:
        option_size(state, "size", arg, T3R_MIN_SIDE, &o->width, &o->height);
        return 0;
    case KEY_CSV:
        o->to.csv = arg;
        return 0;
    case KEY_IMAGES:
        o->to.images = arg;
        return 0;
    case KEY_HTML:
        o->to.page = arg;
        return 0;
    case KEY_FROM_FILE:
        o->from_file = true;
        return 0;
    case KEY_JSON:
        o->to.json = true;
        return 0;
    case KEY_RESUME:
        o->to.resume = true;
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
        return ARGP_ERR_UNKNOWN;
    }
}

static const struct argp_option argp_options[] = {
    OPTION_ARGUMENTS("REC.mcap", OPTION_READS),
    {NULL, 0, NULL, 0, "What is compared:", 1},
    {"context", KEY_CONTEXT, "A,B,...", 0,
     "frames that the scene is made of; one named twice counts once (all triplets that the recording carries)", 0},
    {"target", KEY_TARGET, "T", 0, "frame to compare the rendered view with; the method never sees it", 0},
    {"views", KEY_VIEWS, "N", 0,
     "frames of every context, 2..16 (2: the triplet's own, or --context); those nearest to the target are added", 0},
    {"keep", KEY_KEEP, "P,P,...", 0, "percents of the valid points, one row each; with --auto the upper bound (100)",
     0},
    {"gaussians", KEY_GAUSSIANS, "Z,Z,...", 0,
     "numbers of Gaussians, one row each, behind those of --keep: all valid points where there are fewer", 0},
    {"methods", KEY_METHODS, "M,M,...", 0, METHOD_HELP, 0},
    {"prune", KEY_PRUNE, "SCENE.ply", OPTION_READS,
     "scene, made elsewhere of the views of --context, to prune: percents are of its Gaussians; trim3r makes new ones "
     "of points among their means, the rivals keep some; where a view has no depth, the mask is of the means",
     0},
    {"scene", KEY_SCENE, "SCENE", OPTION_READS,
     "scene file, of trim3r or made elsewhere, to score as it is: nothing is built; it stands in the recording's "
     "world, "
     "and the frames of --context, or of the triplets, make the mask alone; where one has no depth, the mask is of the "
     "scene's means",
     0},
    {"heads", KEY_HEADS, "H,H,...", OPTION_READS | OPTION_LIST | OPTION_OR_WORD,
     "heads to compare, as --head takes them: rows of the method trim3r for each", 0},
    {"mask-head", KEY_MASK_HEAD, "HEAD", OPTION_READS | OPTION_OR_WORD,
     "head whose unpruned scene rivals with +head rank (the one of --head); so --head can be one that was retrained "
     "for their points",
     0},
    {"ablate", KEY_ABLATE, "NAME,NAME,...", OPTION_ARG_OPTIONAL,
     "parts to take away, one in each row (all), at 60, 40, 20, 10 and 5 % unless --keep names others; a table of what "
     "each is worth comes at the end",
     0},
    {"planar", KEY_PLANAR, NULL, 0,
     "take images as arguments: each is one view on a plane of constant depth, drawn again from the same camera", 0},
    {"size", KEY_SIZE, "WxH", 0, "size to which --planar crops and averages images (256x256)", 0},
    {"from-file", KEY_FROM_FILE, NULL, 0, "write each scene as .ply, read it back and draw that", 0},
    {NULL, 0, NULL, 0, "What is written:", 2},
    {"csv", KEY_CSV, "FILE", OPTION_WRITES(FILE_TABLE),
     "table to write; each row appears when it is made, or without --resume all at the end where a table stands", 0},
    {"images", KEY_IMAGES, "DIR", OPTION_WRITES(FILE_PICTURE) | OPTION_FOLDER,
     "folder to write pictures into: DIR/<target>/<method>_<keep>.png, target.png, mask.png, context_a.png, ...; with "
     "--heads <head> or with --ablate <ablation> is in the name, and settings that are not the default come before "
     "<keep>, as in trim3r_refine-0_10.png; the column picture names each",
     0},
    {"html", KEY_HTML, "PAGE.html", OPTION_WRITES(FILE_PAGE),
     "page to write, with the pictures side by side; it needs no other file", 0},
    {"json", KEY_JSON, NULL, 0, "print one JSON object on stdout: rows, means over the cases, refused cases", 0},
    {NULL, 0, NULL, 0, "How the work is done:", 3},
    {"jobs", KEY_JOBS, "N", 0,
     "processes that share the cases, 1..256, or all: one for each processor (1); times are then those of a busy "
     "machine",
     0},
    {"resume", KEY_RESUME, NULL, 0,
     "skip rows that are in --csv already, and add the others to it; a table older than the program or a recording is "
     "refused",
     0},
    {0},
};

/* Apart from the other texts: a string has at most 4095 characters. */
static const char examples[] =
    "Examples:\n"
    "  trim3r eval room.mcap --keep 100,20,10\n"
    "  trim3r eval room.mcap --context 0,2 --target 1 --keep 20 --images dir\n"
    "  trim3r eval room.mcap --keep 20,5 --views 4\n"
    "  trim3r eval room.mcap --gaussians 20000,5000 --poses estimate\n"
    "  trim3r eval room.mcap --keep 20,5 --methods trim3r,pup,pup+finetune,pup+head\n"
    "  trim3r eval room.mcap --keep 10,5 --heads analytic,small,my.t3w\n  trim3r eval room.mcap "
    "--ablate=full,no-mask,no-adaptation --keep 10,5\n  trim3r eval room.mcap --prune s.ply --context 0,2 "
    "--target 1 --keep 20\n  trim3r eval *.mcap --keep 40,10 --jobs all --csv all.csv --resume\n"
    "  trim3r eval room.mcap --scene mine.ply\n"
    "  trim3r eval --planar photo.jpg --keep 10,5 --html photo.html";

static char *add_examples(int key, const char *text, void *input)
{
    (void)input;
    return key == ARGP_KEY_HELP_EXTRA ? strdup(examples) : (char *)(uintptr_t)text;
}

static const struct argp_child children[] = {{.argp = &reconstruction_settings_argp}, {.argp = &poses_argp}, {0}};

static const struct argp parser = {
    .options = argp_options,
    .parser = parse_option,
    .args_doc = "REC.mcap...\n--planar IMAGE...",
    .doc = "Score views of a reconstruction against recorded ones.\v"
           "A row is one scene, context, target, method, head and budget. Cells that do not apply are empty. Several "
           "cases end in lines of means, which the CSV leaves out.\n"
           "  keep          percent of the valid points that was asked for\n"
           "  requested     number of Gaussians that was asked for instead\n"
           "  bits          of a network's weights, and of its activations if not the same\n"
           "  psnr, ssim    on the mask; decibels are averaged as decibels\n"
           "  sharp         mean gradient over the target's, on the mask\n"
           "  perceptual    FLIP at 67 pixels a degree, on the mask; 0 = no difference\n"
           "  holes         share of the mask that keeps a transmittance above 0.5\n"
           "  psnr_all      of all pixels, over black\n"
           "  planar_psnr   of all pixels of --planar, where no score has a mask\n"
           "  context_psnr  mean over the context views, each on its own mask\n"
           "  build_ms      recorded frames to scene, with scores and fine-tuning\n"
           "  render_ms     the target view\n"
           "  scene_bytes   the Gaussians as the arena holds them, 44 bytes each\n"
           "  picture       the name of the render within --images\n"
           "The mask: the pixels that all points of the raw depth, drawn with the plain analytic head, leave a "
           "transmittance below 0.3.\n"
           "\n"
           "--views N: the frames of the triplet, or of --context, come first. Then come the other frames that have "
           "pose, intrinsics and (but for --depth stereo) depth, the nearest to the target's camera first. Two "
           "parts make up the distance, as the root of their squares: the distance of the centres over the median "
           "depth of the first frame, and that of the directions of view as unit vectors. Of equal ones the lower "
           "index is taken, the target never. The mask is that of all N. A recording with too few frames is refused.\n"
           "\n"
           "The rivals rank the Gaussians that --head and --refine make of all points, by the score of their papers "
           "over the context views. They draw the best ones unchanged.\n"
           "  eagles         influence: the sum of blend weights\n"
           "  lightgaussian  hits x opacity x volume\n"
           "  pup            second-order sensitivity to place and scale\n"
           "  efficientgs    dominance: in most pixels\n"
           "  +finetune      N iterations of Adam follow, on all parameters\n"
           "  +head          --head makes new Gaussians of the points they came from\n"
           "\n"
           "--poses estimate: the first context view and the target keep their recorded poses, so that an error of the "
           "others is seen. build_ms does not count the estimate.\n"
           "\n"
           "--ablate: each row changes one thing of the settings given.\n"
           "  full                      nothing\n"
           "  no-adaptation             the head works as if nothing had been pruned; what\n"
           "                            it makes of all points is pruned, then refined\n"
           "  no-mask                   the network works so, but its splats still grow\n"
           "                            with the distance of retained neighbours\n"
           "  random, uniform, paper, pixel   --allocate\n"
           "  random-clusters           SuperClusters exchange their textures at random\n"
           "  paper-random-clusters     the same with --allocate paper\n"
           "  k-5, k-25, k-50, k-100, k-200, k-300, k-400   --clusters\n"
           "  n-5, n-10, n-15, n-20     --allocate paper with that --keep-percent\n"
           "  no-refinement             --refine 0\n"
           "  no-flying, no-redundancy, no-exposure   that switch off\n"
           "The table is Markdown: PSNR (dB) / SSIM, means over the cases of a recording; of several recordings the "
           "mean, each counting once.\n"
           "\n"
           "Refused cases (without depth or stereo match) are left out and reported, and --resume tries them again. "
           "Where no case is left the exit status is 1.\n",
    .help_filter = add_examples,
    .children = children,
};

/* ---- work ------------------------------------------------------------------------------------------------------- */

static int open_cases(const options *o, evaluation_cases *cases)
{
    if (o->planar) {
        return evaluation_cases_of_images(cases, o->inputs, o->input_count, o->width, o->height);
    }
    return evaluation_cases_of_recordings(cases, o->inputs, o->input_count, &o->settings, o->target);
}

static int choose_contestants(const options *o, evaluation_contestants *chosen)
{
    if (o->settings.scene != NULL) {
        evaluation_contestants_scene(chosen);
        return CLI_OK;
    }
    if (o->ablate) {
        return evaluation_contestants_ablations(chosen, o->ablations, o->ablation_count, o->planar, &o->settings);
    }
    return evaluation_contestants_methods(chosen, o->methods, o->method_count, o->heads, o->head_count, &o->settings);
}

/* Opens the scene to be pruned: a bad one is told before the work. */
static int look_at_scene(const char *path, const evaluation_cases *cases)
{
    if (cases->count > 1) {
        return cli_error(CLI_BAD_USAGE, "--prune: the scene belongs to one context; name it, of one recording, by "
                                        "--context and --target");
    }
    scene_file scene;
    int code = scene_to_prune(path, &scene);
    if (code == CLI_OK) {
        scene_file_free(&scene);
    }
    return code;
}

static int report_all(const options *o, const evaluation_work *work)
{
    evaluation_outputs to = o->to;
    to.planar = o->planar;
    to.ablate = o->ablate;
    to.folder_each = !o->planar && o->input_count > 1;
    int code = evaluation_settings_suffix(&o->settings, o->head_count == 0, to.suffix);
    if (code != CLI_OK) {
        return code;
    }
    evaluation_report report;
    code = evaluation_report_open(&report, &to, work->cases->count, evaluation_work_rows_each(work));
    code = code == CLI_OK ? evaluation_work_do(work, &report) : code;
    return evaluation_report_close(&report, code);
}

/* Opens the scene to be scored, for the same reason. */
static int look_at_judged(const char *path)
{
    scene_file scene;
    char error[512] = "";
    if (scene_file_read(path, &scene, error, sizeof error) != 0) {
        return cli_error(CLI_BAD_INPUT, "%s", error);
    }
    scene_file_free(&scene);
    return CLI_OK;
}

/* Percents first, then counts; a scene that is there has a row, too. */
static uint32_t list_budgets(const options *o, evaluation_budget budgets[2 * BUDGETS_MOST])
{
    for (uint32_t i = 0; i < o->keep_count; i++) {
        budgets[i] = (evaluation_budget){.keep = o->keep[i]};
    }
    for (uint32_t i = 0; i < o->gaussians_count; i++) {
        budgets[o->keep_count + i] = (evaluation_budget){.gaussians = o->gaussians[i]};
    }
    if (o->settings.scene != NULL) {
        budgets[0] = (evaluation_budget){.keep = NAN};
        return 1;
    }
    return o->keep_count + o->gaussians_count;
}

static int evaluate(const options *o)
{
    evaluation_budget budgets[2 * BUDGETS_MOST];
    evaluation_contestants contestants;
    evaluation_cases cases = {0};
    evaluation_resume resume = {0};
    int code = choose_contestants(o, &contestants);
    code = code == CLI_OK ? open_cases(o, &cases) : code;
    if (code == CLI_OK && o->settings.points_of != NULL) {
        code = look_at_scene(o->settings.points_of, &cases);
    }
    if (code == CLI_OK && o->settings.scene != NULL) {
        code = look_at_judged(o->settings.scene);
    }
    if (code == CLI_OK && o->to.resume) {
        const char *made = o->settings.scene != NULL ? o->settings.scene : o->settings.points_of;
        code = evaluation_resume_open(&resume, o->to.csv, o->inputs, o->input_count, made, o->to.images != NULL);
    }
    if (code == CLI_OK) {
        evaluation_work work = {
            .cases = &cases,
            .contestants = &contestants,
            .settings = &o->settings,
            .budgets = budgets,
            .budget_count = list_budgets(o, budgets),
            .from_file = o->from_file,
            .processes = o->processes,
            .resume = &resume,
        };
        code = report_all(o, &work);
    }
    evaluation_resume_close(&resume);
    evaluation_cases_close(&cases);
    return code;
}

int command_eval(int argc, char **argv)
{
    options o = {.processes = 1};
    reconstruction_defaults(&o.settings);
    o.settings.head = NULL; /* until one is named */
    file_options_parse(&parser, argc, argv, &o);
    int code = evaluate(&o);
    free(o.heads[0]);
    return code;
}
