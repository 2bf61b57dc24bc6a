/* trim3r eval: scores of rendered views against recorded ones. */
#include "commands.h"

#include <argp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "ablation.h"
#include "cli.h"
#include "evaluation.h"
#include "evaluation_report.h"
#include "option_values.h"
#include "reconstruction.h"

#define MOST_KEEPS 64u
#define MOST_HEADS 32u
#define MOST_CONTESTANTS (MOST_HEADS + ABLATIONS_MOST + METHOD_COUNT)
#define LABEL_BYTES 40
#define SCENE_NAME_BYTES 256
#define ABLATE_KEEPS "60,40,20,10,5"
#define NAME_PARTS_MOST 8u /* parts of a path that a scene's name takes at most */

/* What has rows of its own: a method, trim3r once a head or once an ablation. */
typedef struct contestant {
    method_id method;
    const char *head;        /* NULL: the settings' own */
    uint32_t ablation;       /* with --ablate */
    char label[LABEL_BYTES]; /* over its pictures and in their names */
} contestant;

typedef struct options {
    reconstruction_options settings;
    char **inputs; /* recordings, or the images of --planar */
    uint32_t input_count;
    bool planar, has_target, from_file;
    uint32_t width, height; /* --size */
    uint32_t target;
    double keep[MOST_KEEPS];
    uint32_t keep_count;
    method_id methods[METHOD_COUNT];
    uint32_t method_count;
    char *heads[MOST_HEADS]; /* --heads; parts of one heap string */
    uint32_t head_count;
    bool ablate;
    uint32_t ablations[ABLATIONS_MOST]; /* those named; none = all that apply */
    uint32_t ablation_count;
    contestant contestants[MOST_CONTESTANTS];
    uint32_t contestant_count;
    uint32_t name_parts;
    evaluation_outputs to;
} options;

enum {
    KEY_CONTEXT = 0x200,
    KEY_TARGET,
    KEY_KEEP,
    KEY_METHODS,
    KEY_ITERATIONS,
    KEY_HEADS,
    KEY_ABLATE,
    KEY_PLANAR,
    KEY_SIZE,
    KEY_CSV,
    KEY_IMAGES,
    KEY_HTML,
    KEY_FROM_FILE,
    KEY_JSON
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
        if (o->head_count == MOST_HEADS) {
            argp_error(state, "--heads takes at most %u heads", MOST_HEADS);
        }
        (void)option_head(state, "heads", part);
        o->heads[o->head_count++] = part;
    }
}

static void add_ablation(struct argp_state *state, options *o, const char *name, size_t length)
{
    uint32_t found = 0;
    for (const char *known; (known = ablation_name(found)) != NULL; found++) {
        if (strlen(known) == length && strncmp(name, known, length) == 0) {
            break;
        }
    }
    if (ablation_name(found) == NULL) {
        argp_error(state, "--ablate does not know '%.*s'; --help lists what can be ablated", (int)length, name);
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
    while (text != NULL) {
        size_t length = strcspn(text, ",");
        add_ablation(state, o, text, length);
        text = text[length] == '\0' ? NULL : text + length + 1;
    }
}

/* "room" of "recordings/room.mcap", or "recordings-room" with two parts of the path; at most `bytes` - 1 characters. */
static void scene_name(const char *path, uint32_t parts, char *name, size_t bytes)
{
    const char *start = path + strlen(path);
    for (uint32_t seen = 0; start > path; start--) {
        if (start[-1] == '/' && start[0] != '/' && start[0] != '\0' && ++seen == parts) {
            break;
        }
    }
    snprintf(name, bytes, "%s", start);
    char *dot = strrchr(name, '.');
    if (dot != NULL && dot != name && strchr(dot, '/') == NULL) {
        *dot = '\0';
    }
    for (char *c = name; *c != '\0'; c++) {
        if (*c == '/') {
            *c = '-';
        }
    }
}

/* The first pair of inputs that would share a name; false = all differ. */
static bool share_name(const options *o, uint32_t parts, uint32_t *first, uint32_t *second)
{
    char name[SCENE_NAME_BYTES], other[SCENE_NAME_BYTES];
    for (uint32_t i = 1; i < o->input_count; i++) {
        scene_name(o->inputs[i], parts, name, sizeof name);
        for (uint32_t earlier = 0; earlier < i; earlier++) {
            scene_name(o->inputs[earlier], parts, other, sizeof other);
            if (strcmp(name, other) == 0) {
                *first = earlier;
                *second = i;
                return true;
            }
        }
    }
    return false;
}

/* A scene's name stands for it in the tables and names its folder of pictures: as many parts of the paths as tell the
 * inputs apart. */
static void choose_names(struct argp_state *state, options *o)
{
    uint32_t first = 0, second = 0;
    for (o->name_parts = 1; o->name_parts <= NAME_PARTS_MOST; o->name_parts++) {
        if (!share_name(o, o->name_parts, &first, &second)) {
            return;
        }
    }
    argp_error(state, "%s and %s would have the same name", o->inputs[first], o->inputs[second]);
}

static void check_options(struct argp_state *state, options *o)
{
    if (o->input_count == 0) {
        argp_error(state, o->planar ? "IMAGE... is missing" : "REC.mcap is missing");
    }
    choose_names(state, o);
    if (o->planar && (o->has_target || o->settings.context_count > 0)) {
        argp_error(state, "--planar takes images, not --context and --target");
    }
    if (!o->planar && o->width != 0) {
        argp_error(state, "--size belongs to --planar; --working sets the size of a recording's views");
    }
    if (o->planar && o->settings.width != 0) {
        argp_error(state, "--working belongs to a recording; --size sets the size of --planar");
    }
    if (o->has_target != (o->settings.context_count > 0)) {
        argp_error(state,
                   "--context and --target belong together; without both, all triplets of the recording are taken");
    }
    if (o->ablate && (o->method_count > 0 || o->head_count > 0)) {
        argp_error(state, "--ablate is of the method trim3r with one --head: it excludes --methods and --heads");
    }
    if (o->ablate && o->keep_count == 0) {
        (void)cli_parse_list_percent(ABLATE_KEEPS, o->keep, MOST_KEEPS, &o->keep_count);
    }
    if (o->keep_count == 0) {
        argp_error(state, "--keep is missing");
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
    if (o->planar && o->width == 0) {
        o->width = o->height = 256;
    }
}

static error_t parse_option(int key, char *arg, struct argp_state *state)
{
    options *o = state->input;
    switch (key) {
    case ARGP_KEY_INIT:
        state->child_inputs[0] = &o->settings;
        return 0;
    case KEY_CONTEXT:
        option_frames(state, "context", arg, o->settings.context, &o->settings.context_count);
        return 0;
    case KEY_TARGET:
        o->target = option_number(state, "target", arg, 0, UINT32_MAX);
        o->has_target = true;
        return 0;
    case KEY_KEEP:
        if (cli_parse_list_percent(arg, o->keep, MOST_KEEPS, &o->keep_count) != 0) {
            argp_error(state, "--keep takes percentages above 0 and up to 100 with commas between, not '%s'", arg);
        }
        return 0;
    case KEY_METHODS:
        option_methods(state, "methods", arg, o->methods, &o->method_count);
        return 0;
    case KEY_ITERATIONS:
        o->settings.finetune_iterations = option_number(state, "finetune-iterations", arg, 1, METHOD_ITERATIONS_MOST);
        return 0;
    case KEY_HEADS:
        parse_heads(state, o, arg);
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
    case ARGP_KEY_ARGS:
        o->inputs = state->argv + state->next;
        o->input_count = (uint32_t)(state->argc - state->next);
        return 0;
    case ARGP_KEY_END:
        check_options(state, o);
        return 0;
    default:
        return ARGP_ERR_UNKNOWN;
    }
}

static const struct argp_option argp_options[] = {
    {NULL, 0, NULL, 0, "What is compared:", 1},
    {"context", KEY_CONTEXT, "A,B,...", 0,
     "frames that the scene is made of, one named twice counting once (all triplets that the recording carries)", 0},
    {"target", KEY_TARGET, "T", 0, "the frame to be met; it is never shown to the method", 0},
    {"keep", KEY_KEEP, "P,P,...", 0, "percent of the valid points, one row each", 0},
    {"methods", KEY_METHODS, "M,M,...", 0,
     "trim3r (default); the rivals random, eagles, lightgaussian, pup, efficientgs; +finetune behind any of them", 0},
    {"finetune-iterations", KEY_ITERATIONS, "N", 0, "of the methods with +finetune, 1..100000 (200)", 0},
    {"heads", KEY_HEADS, "H,H,...", 0, "rows of the method trim3r for each of these heads, see --head", 0},
    {"ablate", KEY_ABLATE, "NAME,NAME,...", OPTION_ARG_OPTIONAL,
     "what each part is worth: rows with one part taken away each (all), at 60, 40, 20, 10 and 5 % unless --keep says "
     "otherwise, and one table at the end",
     0},
    {"planar", KEY_PLANAR, NULL, 0,
     "the arguments are images: each is one view on a plane of constant depth, drawn again from the same camera", 0},
    {"size", KEY_SIZE, "WxH", 0, "to which --planar crops and averages images (256x256)", 0},
    {"from-file", KEY_FROM_FILE, NULL, 0, "write each scene as .ply, read it back and draw that", 0},
    {NULL, 0, NULL, 0, "What is written:", 2},
    {"csv", KEY_CSV, "FILE", 0, "the rows", 0},
    {"images", KEY_IMAGES, "DIR", 0,
     "DIR/<target>/<method>_<keep>.png (with --heads <head>, with --ablate <ablation>), target.png, mask.png, "
     "context_a.png, ...",
     0},
    {"html", KEY_HTML, "PAGE.html", 0, "one page with the pictures side by side; it needs no other file", 0},
    {"json", KEY_JSON, NULL, 0, "one JSON object on stdout: rows, and means over the cases", 0},
    {0},
};

static const struct argp_child children[] = {{&reconstruction_settings_argp, 0, NULL, 0}, {0}};

static const struct argp parser = {
    .options = argp_options,
    .parser = parse_option,
    .args_doc = "REC.mcap...\n--planar IMAGE...",
    .doc =
        "Score views of a reconstruction against recorded ones.\v"
        "A row is one scene, context, target, method, head and budget; bits: of a network's weights (and of its "
        "activations, where they differ). psnr (dB), ssim, sharp (mean gradient over the "
        "target's) and perceptual (FLIP at 67 pixels a degree, 0 = none) count the pixels of the mask: those that all "
        "points of the raw depth, drawn with the plain analytic head, leave a transmittance below 0.3. holes: share "
        "of the mask left above 0.5. psnr_all: all pixels over black. context_psnr: mean over the context views, each "
        "on its own mask. build_ms: recorded frames to scene; render_ms: the target view. planar_psnr: all pixels of "
        "--planar, where ssim, sharp, holes and perceptual count all pixels too. Cells that do not apply are empty. "
        "Several cases end in lines of means (decibels are averaged as decibels), which the CSV leaves out; several "
        "recordings get a folder each in --images.\n\n"
        "The rivals keep, of the scene that --head and --refine make of all points, the Gaussians that their papers' "
        "scores rank highest over the context views, and draw them unchanged: random; eagles (influence, the sum of "
        "blending weights); lightgaussian (hits x opacity x volume); pup (second-order sensitivity to place and "
        "scale); efficientgs (dominant in most pixels). +finetune: N iterations of Adam on the context views follow, "
        "on all parameters of what was kept. build_ms counts scoring and fine-tuning.\n\n"
        "--ablate: each row changes one thing of the settings given, --refine among them, and names it in the column "
        "ablation. full: nothing. no-adaptation: the head is told that nothing was pruned; its splats at 100 % are "
        "pruned and, but for --refine, left as they are. no-mask: the network is told so, but its splats still grow "
        "with the distance of kept neighbours. random, uniform, paper, pixel: --allocate. random-clusters: "
        "SuperClusters exchange their textures at random; paper-random-clusters: so with --allocate paper. k-5, k-25,"
        " k-50, k-100, k-200, k-300, k-400: --clusters. n-5, n-10, n-15, n-20: --allocate paper with that "
        "--keep-percent. no-refinement: --refine 0. no-flying, no-redundancy, no-exposure: that switch off. Left out "
        "are no-mask of heads without weights, no-adaptation of the head none, and the last three of --planar. The "
        "table is Markdown, PSNR (dB) / SSIM, means over the cases of a recording; of several recordings the mean, "
        "each counting once. It is long work: rows come to --csv as they are made.\n\n"
        "Examples:\n"
        "  trim3r eval room.mcap --keep 100,20,10\n"
        "  trim3r eval room.mcap --context 0,2 --target 1 --keep 20 --images pictures\n"
        "  trim3r eval a.mcap b.mcap --keep 20,5 --methods trim3r,random --csv ab.csv\n"
        "  trim3r eval room.mcap --keep 20,5 --methods trim3r,pup,pup+finetune\n"
        "  trim3r eval room.mcap --keep 10,5 --heads analytic,moment,small,my.t3w\n"
        "  trim3r eval a.mcap b.mcap --ablate --csv ablations.csv\n"
        "  trim3r eval room.mcap --ablate=full,no-mask,no-adaptation --keep 10,5 --refine 0\n"
        "  trim3r eval --planar photo.jpg --keep 10,5 --html photo.html",
    .children = children,
};

/* ---- contestants ---------------------------------------------------------------------------------------------- */

/* Opens every head once: a bad one is told before the work. */
static int add_head(options *o, const char *text, bool named)
{
    chosen_head head;
    int code = chosen_head_open(&head, text);
    if (code != CLI_OK) {
        return code;
    }
    contestant *it = &o->contestants[o->contestant_count++];
    *it = (contestant){.method = METHOD_TRIM3R, .head = text};
    if (!named) {
        snprintf(it->label, LABEL_BYTES, "%s", method_name(METHOD_TRIM3R));
    } else if (head.weights == NULL || strcmp(head.bits, "8") == 0) {
        snprintf(it->label, LABEL_BYTES, "%s", head.name);
    } else {
        snprintf(it->label, LABEL_BYTES, "%s_w%ua%u", head.name, head.weight_bits, head.activation_bits);
    }
    chosen_head_close(&head);
    for (const contestant *earlier = o->contestants; earlier < it; earlier++) {
        if (earlier->method == METHOD_TRIM3R && strcmp(earlier->label, it->label) == 0) {
            return cli_error(CLI_BAD_USAGE, "--heads: %s and %s have the same name and bits (quantize --name)",
                             earlier->head, text);
        }
    }
    return CLI_OK;
}

/* All ablations that apply to the head, or those named, which must. */
static int choose_ablations(options *o)
{
    chosen_head head;
    int code = chosen_head_open(&head, o->settings.head);
    if (code != CLI_OK) {
        return code;
    }
    t3r_head kind = head.head;
    chosen_head_close(&head);
    for (uint32_t a = 0; o->ablation_count == 0 && ablation_name(a) != NULL; a++) {
        if (ablation_applies(a, kind, o->planar)) {
            o->contestants[o->contestant_count++] = (contestant){.ablation = a};
        }
    }
    for (uint32_t i = 0; i < o->ablation_count; i++) {
        if (!ablation_applies(o->ablations[i], kind, o->planar)) {
            return cli_error(CLI_BAD_USAGE, "--ablate: %s does not apply to %s", ablation_name(o->ablations[i]),
                             o->planar ? "a single image with this head" : "this head");
        }
        o->contestants[o->contestant_count++] = (contestant){.ablation = o->ablations[i]};
    }
    for (uint32_t c = 0; c < o->contestant_count; c++) {
        contestant *it = &o->contestants[c];
        it->method = METHOD_TRIM3R;
        snprintf(it->label, LABEL_BYTES, "%s", ablation_name(it->ablation));
    }
    return CLI_OK;
}

static int choose_contestants(options *o)
{
    int code = CLI_OK;
    if (o->ablate) {
        return choose_ablations(o);
    }
    for (uint32_t m = 0; m < o->method_count && code == CLI_OK; m++) {
        if (o->methods[m] == METHOD_TRIM3R && o->head_count > 0) {
            for (uint32_t h = 0; h < o->head_count && code == CLI_OK; h++) {
                code = add_head(o, o->heads[h], true);
            }
        } else if (o->methods[m] == METHOD_TRIM3R) {
            code = add_head(o, o->settings.head, false);
        } else {
            contestant *it = &o->contestants[o->contestant_count++];
            it->method = o->methods[m];
            snprintf(it->label, LABEL_BYTES, "%s", method_name(it->method));
        }
    }
    return code;
}

/* ---- cases ---------------------------------------------------------------------------------------------------- */

static int measure_all(evaluation_report *report, const options *o, const evaluation_case *what,
                       const evaluation_views *views, uint8_t *render)
{
    int code = evaluation_report_case(report, views, what);
    for (uint32_t c = 0; c < o->contestant_count && code == CLI_OK; c++) {
        const contestant *it = &o->contestants[c];
        reconstruction_options settings = o->settings;
        settings.head = it->head != NULL ? it->head : settings.head;
        if (o->ablate) {
            ablation_apply(it->ablation, &settings);
        }
        evaluation_report_strip(report, it->label);
        for (uint32_t k = 0; k < o->keep_count && code == CLI_OK; k++) {
            evaluation_row row;
            code = evaluation_measure(&row, render, views, what, it->method, o->keep[k], o->from_file, &settings);
            row.ablation = o->ablate ? ablation_name(it->ablation) : "";
            if (code == CLI_OK) {
                code = evaluation_report_row(report, views, what, it->label, &row, render);
            }
        }
    }
    return code;
}

static int evaluate_case(evaluation_report *report, const options *o, const evaluation_case *what)
{
    evaluation_views views;
    int code = evaluation_views_make(&views, what, &o->settings);
    if (code != CLI_OK) {
        return code;
    }
    uint8_t *render = malloc((size_t)views.width * views.height * 3);
    code = render == NULL ? cli_error(CLI_BAD_INPUT, "out of memory") : measure_all(report, o, what, &views, render);
    free(render);
    evaluation_views_free(&views);
    return code;
}

static int open_report(evaluation_report *report, const options *o, uint32_t cases)
{
    evaluation_outputs to = o->to;
    to.planar = o->planar;
    to.ablate = o->ablate;
    to.folder_each = !o->planar && o->input_count > 1;
    return evaluation_report_open(report, &to, cases * o->contestant_count * o->keep_count);
}

static uint32_t case_count(const options *o, const t3r_recording *recording)
{
    return o->has_target ? 1 : t3r_recording_triplet_count(recording);
}

/* A triplet of a stereo pair names its one context view twice. */
static void set_context(evaluation_case *what, const uint32_t *frames, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        bool known = false;
        for (uint32_t v = 0; v < what->context_count; v++) {
            known = known || what->context[v] == frames[i];
        }
        if (!known) {
            what->context[what->context_count++] = frames[i];
        }
    }
}

static int evaluate_recording(evaluation_report *report, const options *o, const char *path,
                              const t3r_recording *recording)
{
    char name[SCENE_NAME_BYTES];
    int code = CLI_OK;
    scene_name(path, o->name_parts, name, sizeof name);
    for (uint32_t i = 0; i < case_count(o, recording) && code == CLI_OK; i++) {
        evaluation_case what = {.recording = recording, .path = path, .scene = name};
        if (o->has_target) {
            set_context(&what, o->settings.context, o->settings.context_count);
            what.target = o->target;
        } else {
            t3r_triplet triplet = t3r_recording_triplet(recording, i);
            set_context(&what, triplet.context, 2);
            what.target = triplet.target;
        }
        code = evaluate_case(report, o, &what);
    }
    return code;
}

/* Opens all before the first is evaluated: a bad one is told at once. */
static int open_recordings(const options *o, t3r_recording **recordings, uint32_t *cases)
{
    *cases = 0;
    for (uint32_t i = 0; i < o->input_count; i++) {
        char error[512] = "";
        recordings[i] = t3r_recording_open(o->inputs[i], error, sizeof error);
        if (recordings[i] == NULL) {
            return cli_error(CLI_BAD_INPUT, "%s", error);
        }
        uint32_t count = case_count(o, recordings[i]);
        if (count == 0) {
            return cli_error(CLI_BAD_INPUT, "%s: the recording carries no triplets; give --context and --target",
                             o->inputs[i]);
        }
        *cases += count;
    }
    return CLI_OK;
}

static int evaluate_recordings(const options *o)
{
    t3r_recording **recordings = calloc(o->input_count, sizeof(t3r_recording *));
    if (recordings == NULL) {
        return cli_error(CLI_BAD_INPUT, "out of memory");
    }
    uint32_t cases;
    int code = open_recordings(o, recordings, &cases);
    if (code == CLI_OK) {
        evaluation_report report;
        code = open_report(&report, o, cases);
        for (uint32_t i = 0; i < o->input_count && code == CLI_OK; i++) {
            code = evaluate_recording(&report, o, o->inputs[i], recordings[i]);
        }
        code = evaluation_report_close(&report, code);
    }
    for (uint32_t i = 0; i < o->input_count; i++) {
        if (recordings[i] != NULL) {
            t3r_recording_close(recordings[i]);
        }
    }
    free(recordings);
    return code;
}

static int evaluate_planar(const options *o)
{
    evaluation_report report;
    int code = open_report(&report, o, o->input_count);
    for (uint32_t i = 0; i < o->input_count && code == CLI_OK; i++) {
        char name[SCENE_NAME_BYTES];
        uint8_t *bytes;
        scene_name(o->inputs[i], o->name_parts, name, sizeof name);
        t3r_recording *recording = evaluation_planar_recording(o->inputs[i], o->width, o->height, &bytes);
        if (recording == NULL) {
            code = CLI_BAD_INPUT;
            break;
        }
        evaluation_case what = {
            .recording = recording, .path = o->inputs[i], .scene = name, .context_count = 1, .planar = true};
        code = evaluate_case(&report, o, &what);
        t3r_recording_close(recording);
        free(bytes);
    }
    return evaluation_report_close(&report, code);
}

int command_eval(int argc, char **argv)
{
    options o = {0};
    reconstruction_defaults(&o.settings);
    o.settings.head = NULL; /* until one is named */
    argp_parse(&parser, argc, argv, 0, NULL, &o);
    int code = choose_contestants(&o);
    if (code == CLI_OK) {
        code = o.planar ? evaluate_planar(&o) : evaluate_recordings(&o);
    }
    free(o.heads[0]);
    return code;
}
