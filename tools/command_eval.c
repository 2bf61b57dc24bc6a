/* trim3r eval: scores of rendered views against recorded ones. */
#include "commands.h"

#include <argp.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "cli.h"
#include "csv.h"
#include "evaluation.h"
#include "evaluation_pictures.h"
#include "evaluation_table.h"
#include "json_output.h"
#include "reconstruction.h"

#define MOST_KEEPS 64u

typedef struct options {
    reconstruction_options settings;
    char **inputs; /* recordings, or the images of --planar */
    uint32_t input_count;
    bool planar, has_target, from_file, json;
    uint32_t width, height; /* --size */
    uint32_t target;
    double keep[MOST_KEEPS];
    uint32_t keep_count;
    evaluation_method methods[EVALUATION_METHOD_COUNT];
    uint32_t method_count;
    const char *csv, *images, *page;
} options;

enum {
    KEY_CONTEXT = 0x200,
    KEY_TARGET,
    KEY_KEEP,
    KEY_METHODS,
    KEY_PLANAR,
    KEY_SIZE,
    KEY_CSV,
    KEY_IMAGES,
    KEY_HTML,
    KEY_FROM_FILE,
    KEY_JSON
};

/* ---- arguments ---------------------------------------------------------------------------------------------- */

/* Published rivals that are planned; naming one says so instead of calling it unknown. */
static bool planned_method(const char *name, size_t length)
{
    static const char *const planned[] = {"eagles", "lightgaussian", "pup", "efficientgs"};
    static const char suffix[] = "+finetune";
    size_t tail = sizeof suffix - 1;
    if (length > tail && strncmp(name + length - tail, suffix, tail) == 0) {
        length -= tail;
    }
    for (size_t i = 0; i < sizeof planned / sizeof planned[0]; i++) {
        if (strlen(planned[i]) == length && strncmp(name, planned[i], length) == 0) {
            return true;
        }
    }
    return false;
}

static void add_method(struct argp_state *state, options *o, const char *name, size_t length)
{
    for (int m = 0; m < EVALUATION_METHOD_COUNT; m++) {
        const char *known = evaluation_method_name((evaluation_method)m);
        if (strlen(known) != length || strncmp(name, known, length) != 0) {
            continue;
        }
        for (uint32_t i = 0; i < o->method_count; i++) {
            if (o->methods[i] == (evaluation_method)m) {
                argp_error(state, "--methods names %s twice", known);
            }
        }
        o->methods[o->method_count++] = (evaluation_method)m;
        return;
    }
    argp_error(state, "--methods: %.*s is %s; available: trim3r, random", (int)length, name,
               planned_method(name, length) ? "not available yet" : "not a method");
}

static void parse_methods(struct argp_state *state, options *o, const char *text)
{
    o->method_count = 0;
    for (;;) {
        size_t length = strcspn(text, ",");
        add_method(state, o, text, length);
        if (text[length] == '\0') {
            return;
        }
        text += length + 1;
    }
}

static void check_options(struct argp_state *state, options *o)
{
    if (o->input_count == 0) {
        argp_error(state, o->planar ? "IMAGE... is missing" : "REC.mcap is missing");
    }
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
    if (o->keep_count == 0) {
        argp_error(state, "--keep is missing");
    }
    if (o->method_count == 0) {
        o->methods[o->method_count++] = EVALUATION_TRIM3R;
    }
    if (o->planar && o->width == 0) {
        o->width = o->height = 256;
    }
}

static error_t parse_option(int key, char *arg, struct argp_state *state)
{
    options *o = state->input;
    uint32_t count;
    switch (key) {
    case ARGP_KEY_INIT:
        state->child_inputs[0] = &o->settings;
        return 0;
    case KEY_CONTEXT:
        if (cli_parse_list_u32(arg, o->settings.context, T3R_MAX_VIEWS, &o->settings.context_count) != 0) {
            argp_error(state, "--context takes 1 to %u frame indices with commas between, not '%s'", T3R_MAX_VIEWS,
                       arg);
        }
        return 0;
    case KEY_TARGET:
        if (cli_parse_list_u32(arg, &o->target, 1, &count) != 0) {
            argp_error(state, "--target takes a frame index, not '%s'", arg);
        }
        o->has_target = true;
        return 0;
    case KEY_KEEP:
        if (cli_parse_list_percent(arg, o->keep, MOST_KEEPS, &o->keep_count) != 0) {
            argp_error(state, "--keep takes percentages above 0 and up to 100 with commas between, not '%s'", arg);
        }
        return 0;
    case KEY_METHODS:
        parse_methods(state, o, arg);
        return 0;
    case KEY_PLANAR:
        o->planar = true;
        return 0;
    case KEY_SIZE:
        if (cli_parse_size(arg, &o->width, &o->height) != 0 || o->width < T3R_MIN_SIDE || o->height < T3R_MIN_SIDE ||
            o->width > T3R_MAX_SIDE || o->height > T3R_MAX_SIDE) {
            argp_error(state, "--size takes WxH, each %u..%u, not '%s'", T3R_MIN_SIDE, T3R_MAX_SIDE, arg);
        }
        return 0;
    case KEY_CSV:
        o->csv = arg;
        return 0;
    case KEY_IMAGES:
        o->images = arg;
        return 0;
    case KEY_HTML:
        o->page = arg;
        return 0;
    case KEY_FROM_FILE:
        o->from_file = true;
        return 0;
    case KEY_JSON:
        o->json = true;
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
    {"context", KEY_CONTEXT, "A,B,...", 0, "frames that the scene is made of (all triplets that the recording carries)",
     0},
    {"target", KEY_TARGET, "T", 0, "the frame to be met; it is never shown to the method", 0},
    {"keep", KEY_KEEP, "P,P,...", 0, "percent of the valid points, one row each", 0},
    {"methods", KEY_METHODS, "M,M,...", 0, "trim3r (default); random: random points, nothing adapted", 0},
    {"planar", KEY_PLANAR, NULL, 0,
     "the arguments are images: each is one view on a plane of constant depth, drawn again from the same camera", 0},
    {"size", KEY_SIZE, "WxH", 0, "to which --planar crops and averages images (256x256)", 0},
    {"from-file", KEY_FROM_FILE, NULL, 0, "write each scene as .ply, read it back and draw that", 0},
    {NULL, 0, NULL, 0, "What is written:", 2},
    {"csv", KEY_CSV, "FILE", 0, "the rows", 0},
    {"images", KEY_IMAGES, "DIR", 0, "DIR/<target>/<method>_<keep>.png, target.png, mask.png, context_a.png, ...", 0},
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
        "A row is one scene, context, target, method and budget. psnr (dB), ssim, sharp (mean gradient over the "
        "target's) and perceptual (FLIP at 67 pixels a degree, 0 = none) count the pixels of the mask: those that all "
        "points of the raw depth, drawn with the plain analytic head, leave a transmittance below 0.3. holes: share "
        "of the mask left above 0.5. psnr_all: all pixels over black. context_psnr: mean over the context views, each "
        "on its own mask. build_ms: recorded frames to scene; render_ms: the target view. planar_psnr: all pixels of "
        "--planar, where ssim, sharp, holes and perceptual count all pixels too. Cells that do not apply are empty. "
        "Several cases end in lines of means (decibels are averaged as decibels), which the CSV leaves out; several "
        "recordings get a folder each in --images.\n\n"
        "Examples:\n"
        "  trim3r eval room.mcap --keep 100,20,10\n"
        "  trim3r eval room.mcap --context 0,2 --target 1 --keep 20 --images pictures\n"
        "  trim3r eval a.mcap b.mcap --keep 20,5 --methods trim3r,random --csv ab.csv\n"
        "  trim3r eval --planar photo.jpg --keep 10,5 --html photo.html",
    .children = children,
};

/* ---- what is written as rows arrive --------------------------------------------------------------------------- */

typedef struct output {
    const options *o;
    csv_table csv;
    html_page *page;
    evaluation_row *rows; /* room for all */
    uint32_t row_count, row_total;
    char folder[4096]; /* of the pictures; "" = none */
} output;

/* Several recordings share a folder by one of their own each. */
static int choose_folder(output *out, const evaluation_case *what)
{
    const options *o = out->o;
    bool shared = !o->planar && o->input_count > 1;
    if (o->images == NULL) {
        return CLI_OK;
    }
    int length =
        snprintf(out->folder, sizeof out->folder, "%s%s%s", o->images, shared ? "/" : "", shared ? what->scene : "");
    return length > 0 && (size_t)length < sizeof out->folder
               ? CLI_OK
               : cli_error(CLI_BAD_USAGE, "--images: the name of a folder of at most %zu bytes is needed",
                           sizeof out->folder - 1);
}

static int open_output(output *out, const options *o, uint32_t cases)
{
    *out = (output){.o = o, .row_total = cases * o->method_count * o->keep_count};
    out->rows = calloc(out->row_total, sizeof *out->rows);
    if (out->rows == NULL) {
        return cli_error(CLI_BAD_INPUT, "out of memory");
    }
    if (o->page != NULL) {
        out->page =
            html_page_new("trim3r: rendered views beside recorded ones",
                          "A scene is built from the context views alone, with the share of their points that stands "
                          "under each picture, and drawn from where the target was taken.");
        if (out->page == NULL) {
            return cli_error(CLI_BAD_INPUT, "out of memory");
        }
    }
    if (o->csv != NULL) {
        out->csv.file = fopen(o->csv, "w");
        if (out->csv.file == NULL) {
            return cli_error(CLI_BAD_INPUT, "%s: %s", o->csv, strerror(errno));
        }
        evaluation_csv_header(&out->csv);
    }
    if (!o->json) {
        evaluation_print_header(stdout, o->planar);
    }
    return CLI_OK;
}

static int put_row(output *out, const evaluation_views *views, const evaluation_case *what, const evaluation_row *row,
                   uint8_t *render)
{
    out->rows[out->row_count++] = *row;
    if (!out->o->json) {
        evaluation_print_row(stdout, row, out->o->planar);
        fflush(stdout);
    } else if (isatty(STDERR_FILENO)) {
        fprintf(stderr, "\r%u of %u rows%s", (unsigned)out->row_count, (unsigned)out->row_total,
                out->row_count == out->row_total ? "\r\033[K" : "");
    }
    if (out->csv.file != NULL) {
        evaluation_csv_row(&out->csv, row);
    }
    if (out->page != NULL) {
        evaluation_page_render(out->page, views, row, render);
    }
    return out->folder[0] != '\0' ? evaluation_write_render(out->folder, views, what, row, render) : CLI_OK;
}

static int put_case(output *out, const evaluation_case *what, const evaluation_views *views, uint8_t *render)
{
    const options *o = out->o;
    if (out->page != NULL) {
        evaluation_page_views(out->page, views, what);
    }
    int code = out->folder[0] != '\0' ? evaluation_write_views(out->folder, views, what) : CLI_OK;
    for (uint32_t m = 0; m < o->method_count && code == CLI_OK; m++) {
        if (out->page != NULL) {
            html_page_strip(out->page, evaluation_method_name(o->methods[m]));
        }
        for (uint32_t k = 0; k < o->keep_count && code == CLI_OK; k++) {
            evaluation_row row;
            code = evaluation_measure(&row, render, views, what, o->methods[m], o->keep[k], o->from_file, &o->settings);
            if (code == CLI_OK) {
                code = put_row(out, views, what, &row, render);
            }
        }
    }
    return code;
}

static int evaluate_case(output *out, const evaluation_case *what)
{
    evaluation_views views;
    int code = choose_folder(out, what);
    if (code == CLI_OK) {
        code = evaluation_views_make(&views, what, &out->o->settings);
    }
    if (code != CLI_OK) {
        return code;
    }
    uint8_t *render = malloc((size_t)views.width * views.height * 3);
    code = render == NULL ? cli_error(CLI_BAD_INPUT, "out of memory") : put_case(out, what, &views, render);
    free(render);
    evaluation_views_free(&views);
    return code;
}

static void print_json(const output *out, const evaluation_row *means, uint32_t mean_count)
{
    cJSON *object = cJSON_CreateObject();
    cJSON *rows = cJSON_AddArrayToObject(object, "rows");
    for (uint32_t i = 0; i < out->row_count; i++) {
        cJSON_AddItemToArray(rows, evaluation_json(&out->rows[i]));
    }
    cJSON *mean_rows = cJSON_AddArrayToObject(object, "means");
    for (uint32_t i = 0; i < mean_count; i++) {
        cJSON_AddItemToArray(mean_rows, evaluation_json(&means[i]));
    }
    json_print(object);
}

static void page_table(html_page *page, const char *heading, const evaluation_row *rows, uint32_t count, bool planar,
                       bool folded)
{
    char text[256];
    html_page_table(page, heading, folded);
    for (uint32_t c = 0; c < EVALUATION_COLUMNS; c++) {
        if (evaluation_glance(&rows[0], c, planar, text, sizeof text)) {
            html_page_table_cell(page, evaluation_column_name(c));
        }
    }
    html_page_table_end_row(page);
    for (uint32_t i = 0; i < count; i++) {
        for (uint32_t c = 0; c < EVALUATION_COLUMNS; c++) {
            if (evaluation_glance(&rows[i], c, planar, text, sizeof text)) {
                html_page_table_cell(page, text);
            }
        }
        html_page_table_end_row(page);
    }
}

/* Means, JSON and page, once all rows are there. A mean of one row is no news. */
static int finish_output(output *out)
{
    evaluation_row *means = calloc(out->row_count, sizeof *means);
    if (means == NULL) {
        return cli_error(CLI_BAD_INPUT, "out of memory");
    }
    uint32_t mean_count = evaluation_means(out->rows, out->row_count, !out->o->planar, means);
    bool several = mean_count < out->row_count;
    int code = CLI_OK;
    if (out->o->json) {
        print_json(out, means, mean_count);
    }
    for (uint32_t i = 0; several && !out->o->json && i < mean_count; i++) {
        evaluation_print_row(stdout, &means[i], out->o->planar);
    }
    if (out->page != NULL) {
        char error[512] = "";
        if (several) {
            page_table(out->page, "Means", means, mean_count, out->o->planar, false);
        }
        page_table(out->page, "Scores", out->rows, out->row_count, out->o->planar, several);
        if (html_page_write(out->page, out->o->page, error, sizeof error) != 0) {
            code = cli_error(CLI_BAD_INPUT, "%s", error);
        }
    }
    free(means);
    return code;
}

static int close_output(output *out, int code)
{
    if (code == CLI_OK) {
        code = finish_output(out);
    }
    if (out->csv.file != NULL) {
        bool failed = ferror(out->csv.file) != 0;
        failed |= fclose(out->csv.file) != 0;
        if (failed && code == CLI_OK) {
            code = cli_error(CLI_BAD_INPUT, "%s: %s", out->o->csv, strerror(errno));
        }
    }
    html_page_free(out->page);
    free(out->rows);
    return code;
}

/* ---- cases ---------------------------------------------------------------------------------------------------- */

/* "room" of "recordings/room.mcap"; at most `bytes` - 1 characters. */
static void scene_name(const char *path, char *name, size_t bytes)
{
    const char *slash = strrchr(path, '/');
    const char *base = slash != NULL && slash[1] != '\0' ? slash + 1 : path;
    snprintf(name, bytes, "%s", base);
    char *dot = strrchr(name, '.');
    if (dot != NULL && dot != name) {
        *dot = '\0';
    }
}

static uint32_t case_count(const options *o, const t3r_recording *recording)
{
    return o->has_target ? 1 : t3r_recording_triplet_count(recording);
}

static int evaluate_recording(output *out, const char *path, const t3r_recording *recording)
{
    const options *o = out->o;
    char name[256];
    int code = CLI_OK;
    scene_name(path, name, sizeof name);
    for (uint32_t i = 0; i < case_count(o, recording) && code == CLI_OK; i++) {
        evaluation_case what = {.recording = recording, .path = path, .scene = name};
        if (o->has_target) {
            what.context_count = o->settings.context_count;
            memcpy(what.context, o->settings.context, sizeof what.context);
            what.target = o->target;
        } else {
            t3r_triplet triplet = t3r_recording_triplet(recording, i);
            what.context_count = 2;
            memcpy(what.context, triplet.context, sizeof triplet.context);
            what.target = triplet.target;
        }
        code = evaluate_case(out, &what);
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
        output out;
        code = open_output(&out, o, cases);
        for (uint32_t i = 0; i < o->input_count && code == CLI_OK; i++) {
            code = evaluate_recording(&out, o->inputs[i], recordings[i]);
        }
        code = close_output(&out, code);
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
    output out;
    int code = open_output(&out, o, o->input_count);
    for (uint32_t i = 0; i < o->input_count && code == CLI_OK; i++) {
        char name[256];
        uint8_t *bytes;
        scene_name(o->inputs[i], name, sizeof name);
        t3r_recording *recording = evaluation_planar_recording(o->inputs[i], o->width, o->height, &bytes);
        if (recording == NULL) {
            code = CLI_BAD_INPUT;
            break;
        }
        evaluation_case what = {
            .recording = recording, .path = o->inputs[i], .scene = name, .context_count = 1, .planar = true};
        code = evaluate_case(&out, &what);
        t3r_recording_close(recording);
        free(bytes);
    }
    return close_output(&out, code);
}

int command_eval(int argc, char **argv)
{
    options o = {0};
    reconstruction_defaults(&o.settings);
    argp_parse(&parser, argc, argv, 0, NULL, &o);
    return o.planar ? evaluate_planar(&o) : evaluate_recordings(&o);
}
