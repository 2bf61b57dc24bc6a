/* SPDX-License-Identifier: Apache-2.0 */
/* trim3r stress: measures how perturbed frames and hard scenes affect each method. */
#include "study/commands/commands.h"

#include <argp.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/cli.h"
#include "cli/options/file_options.h"
#include "cli/options/option_values.h"
#include "cli/text/word_list.h"
#include "host/text.h"
#include "import/import_source.h"
#include "room/room.h"
#include "study/rivals/options.h"
#include "study/stress/measure.h"
#include "study/stress/report.h"
#include "study/stress/scene.h"

#define MOST_ROWS 64u
#define MOST_CAPTURES 64u
#define ROOM_SEED 1u

typedef struct options {
    stress_contest contest;
    stress_outputs to;
    char **inputs;
    uint32_t input_count;
    uint32_t triplets; /* per recording */
    bool perturb[MOST_ROWS], scene[MOST_ROWS];
    bool grade[STRESS_GRADES + 1];
} options;

enum { KEY_METHODS = 0x200, KEY_KEEP, KEY_ROWS, KEY_STRENGTHS, KEY_CAPTURES, KEY_TRIPLETS, KEY_WORST };

/* ---- arguments --------------------------------------------------------------------------------------------------- */

static void choose_row(struct argp_state *state, options *o, list_word name)
{
    bool found = false;
    const perturbation *p;
    const stress_scene *s;
    for (uint32_t i = 0; (p = stress_perturbation(i)) != NULL; i++) {
        if (word_is(name, p->name)) {
            found = o->perturb[i] = true;
        }
    }
    for (uint32_t i = 0; (s = stress_scene_at(i)) != NULL; i++) {
        if (word_is(name, s->name)) {
            found = o->scene[i] = true;
        }
    }
    if (!found) {
        argp_error(state, "--rows does not know '%.*s'; --help lists what there is", (int)name.length, name.text);
    }
}

static void parse_rows(struct argp_state *state, options *o, const char *text)
{
    memset(o->perturb, 0, sizeof o->perturb);
    memset(o->scene, 0, sizeof o->scene);
    for (list_word w = word_first(text); w.text != NULL; w = word_next(w)) {
        choose_row(state, o, w);
    }
}

static void parse_strengths(struct argp_state *state, options *o, const char *text)
{
    uint32_t grades[STRESS_GRADES], count = 0;
    if (cli_parse_list_u32(text, grades, STRESS_GRADES, &count) != 0) {
        argp_error(state, "--strengths takes some of 1,2,3, not '%s'", text);
    }
    memset(o->grade, 0, sizeof o->grade);
    for (uint32_t i = 0; i < count; i++) {
        if (grades[i] < 1 || grades[i] > STRESS_GRADES) {
            argp_error(state, "--strengths takes some of 1,2,3, not '%s'", text);
        }
        o->grade[grades[i]] = true;
    }
}

static error_t parse_option(int key, char *arg, struct argp_state *state)
{
    options *o = state->input;
    stress_contest *c = &o->contest;
    switch (key) {
    case ARGP_KEY_INIT:
        state->child_inputs[0] = state->child_inputs[1] = &c->settings;
        return 0;
    case KEY_METHODS:
        option_methods(state, "methods", arg, c->methods, &c->method_count);
        return 0;
    case KEY_KEEP:
        option_keep(state, arg, c->keep, STRESS_KEEPS_MOST, &c->keep_count);
        return 0;
    case KEY_ROWS:
        parse_rows(state, o, arg);
        return 0;
    case KEY_STRENGTHS:
        parse_strengths(state, o, arg);
        return 0;
    case KEY_CAPTURES:
        c->captures = option_number(state, "captures", arg, 0, MOST_CAPTURES);
        if (c->captures == 1) {
            argp_error(state, "--captures: one capture does not flicker; 0 measures none, 2 or more do");
        }
        return 0;
    case KEY_TRIPLETS:
        o->triplets = option_number(state, "triplets", arg, 1, UINT32_MAX);
        return 0;
    case KEY_WORST:
        o->to.worst = option_number(state, "worst", arg, 1, STRESS_WORST_MOST);
        return 0;
    case ARGP_KEY_ARGS:
        option_arguments(state, &o->inputs, &o->input_count);
        return 0;
    case ARGP_KEY_END:
        rival_check_settings(state, &c->settings, c->methods, c->method_count);
        if (c->settings.config.allocate == T3R_ALLOCATE_GIVEN) {
            argp_error(state, "--allocate given is of pictures of one recording; stress has scenes of its own");
        }
        return 0;
    default:
        return option_field(key, arg, state);
    }
}

static const struct argp_option argp_options[] = {
    OPTION_ARGUMENTS("REC.mcap", OPTION_READS | OPTION_FOLDER),
    {NULL, 0, NULL, 0, "What is compared:", 1},
    {"methods", KEY_METHODS, "M,M,...", 0, METHOD_HELP, 0},
    {"keep", KEY_KEEP, "P,P,...", 0, "percents of the valid points of the unperturbed frames (10)", 0},
    {"rows", KEY_ROWS, "NAME,...", 0, "perturbations and scenes, of those below (all)", 0},
    {"strengths", KEY_STRENGTHS, "N,...", 0, "strengths of each, 1 the least, 3 most (1,2,3)", 0},
    {"captures", KEY_CAPTURES, "N", 0, "number of noisy captures of each still scene, for flicker; 0 = none (2)", 0},
    {"triplets", KEY_TRIPLETS, "N", 0,
     "number of triplets of each recording, spread evenly over those that it carries (1)", 0},
    {NULL, 0, NULL, 0, "What is written:", 2},
    {"csv", OPTION_TO(options, to.csv), "FILE", OPTION_WRITES(FILE_TABLE),
     "table to write; each row appears when it is made, or all at the end if a table exists", 0},
    {"html", OPTION_TO(options, to.page), "PAGE.html", OPTION_WRITES(FILE_PAGE),
     "page to write, with pictures of the worst cases; it needs no other file", 0},
    {"worst", KEY_WORST, "N", 0, "number of cases on the page, 1..64, one for each perturbation at most (12)", 0},
    {"json", OPTION_TO(options, to.json), NULL, 0, "print one JSON object on stdout: the rows", 0},
    {0},
};

static const struct argp_child children[] = {{.argp = &reconstruction_settings_argp}, {.argp = &rival_argp}, {0}};

/* Adds the names for --rows to the help, after the options. */
static char *list_rows(int key, const char *text, void *input)
{
    (void)input;
    if (key != ARGP_KEY_HELP_POST_DOC || text == NULL) {
        return (char *)(uintptr_t)text;
    }
    char *all = NULL;
    size_t bytes = 0;
    FILE *out = open_memstream(&all, &bytes);
    if (out == NULL) {
        return (char *)(uintptr_t)text;
    }
    fputs("Rows, with their strengths:\n", out);
    const perturbation *p;
    const stress_scene *s;
    for (uint32_t i = 0; (p = stress_perturbation(i)) != NULL; i++) {
        fprintf(out, "  %s, %g %g %g %s: %s\n", p->name, p->strength[0], p->strength[1], p->strength[2], p->unit,
                p->about);
    }
    for (uint32_t i = 0; (s = stress_scene_at(i)) != NULL; i++) {
        fprintf(out, "  %s, %g %g %g %s: %s\n", s->name, s->strength[0], s->strength[1], s->strength[2], s->unit,
                s->about);
    }
    fprintf(out, "\n%s", text);
    return fclose(out) == 0 ? all : (char *)(uintptr_t)text;
}

static const struct argp parser = {
    .options = argp_options,
    .parser = parse_option,
    .help_filter = list_rows,
    .args_doc = "[REC.mcap...]",
    .doc = "Measure how much each method loses when the frames are perturbed, and how it copes with hard scenes; "
           "without a recording, on the built-in room.\v"
           "The context frames change in memory, the target stays as "
           "recorded. The budget is the unperturbed frames' number, so a method must use exactly that many Gaussians, "
           "or all valid points. Losses (dB, SSIM) are against the same method on unperturbed frames, on their mask; "
           "losses of scene-* rows are against all points. Columns:\n"
           "  psnr_unpruned     of all points of the same frames\n"
           "  flicker           mean change in 8-bit levels, on the mask, between the\n"
           "                    renders of two captures of a still scene; these have noise\n"
           "                    of 2 levels and of 0.2 % of the depth, too\n"
           "  flicker_unpruned  the same of all points\n"
           "  mask_changed      share of the retained pixels that the next such capture\n"
           "                    does not retain (unperturbed rows)\n"
           "  motion            median movement of the other Gaussians, as a share of\n"
           "                    their spacing (unperturbed rows)\n"
           "Random numbers have fixed seeds: the same command gives the same figures, except times.\n"
           "\n"
           "An error with a reason is a refusal, which is a result. A broken invariant ends in exit status 1:\n"
           "  another number of Gaussians than the budget, or another arena than before\n"
           "  a Gaussian out of range or not finite, or a score that is no number\n"
           "  trim3r beyond its bounds on a still scene of n Gaussians for each of its\n"
           "    SuperClusters, n at least 1: 0.6 / sqrt(n) of the mask, at most half; a\n"
           "    median movement of 3/4 of the spacing beyond the depth noise's share\n"
           "Of several cases the tables show means; * marks that some were refused.\n"
           "\n"
           "Examples:\n"
           "  trim3r stress\n"
           "  trim3r stress room.mcap --methods trim3r,random,eagles --csv s.csv\n"
           "  trim3r stress a.mcap b.mcap --rows noise,pose,scene-bars --html s.html\n"
           "  trim3r stress --working 64x64 --strengths 2 --captures 0",
    .children = children,
};

/* ---- cells ------------------------------------------------------------------------------------------------------- */

static uint32_t grades_of(const options *o)
{
    uint32_t count = 0;
    for (uint32_t g = 1; g <= STRESS_GRADES; g++) {
        count += o->grade[g];
    }
    return count;
}

/* Returns the number of cells of a case of recorded frames. */
static uint32_t cells_of_case(const options *o)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < MOST_ROWS; i++) {
        count += o->perturb[i];
    }
    return count == 0 ? 0 : 1 + count * grades_of(o);
}

static uint32_t cells_of_scenes(const options *o)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < MOST_ROWS; i++) {
        count += o->scene[i];
    }
    return count * grades_of(o);
}

/* Memory of a case's cells: rows and renders of the current cell and of the unperturbed one. */
typedef struct cells {
    stress_row *rows, *unperturbed;
    uint8_t *renders, *plain;
} cells;

static bool cells_open(cells *m, const stress_case *c, const stress_contest *contest)
{
    size_t count = stress_row_count(contest), bytes = count * c->base.width * c->base.height * 3;
    *m = (cells){.rows = calloc(count, sizeof *m->rows),
                 .unperturbed = calloc(count, sizeof *m->unperturbed),
                 .renders = malloc(bytes),
                 .plain = malloc(bytes)};
    return m->rows != NULL && m->unperturbed != NULL && m->renders != NULL && m->plain != NULL;
}

static void cells_close(cells *m)
{
    free(m->rows);
    free(m->unperturbed);
    free(m->renders);
    free(m->plain);
}

static int perturb_all(stress_report *report, const options *o, const stress_case *c, cells *m)
{
    const stress_contest *contest = &o->contest;
    uint32_t count = stress_row_count(contest);
    int code = stress_measure(m->unperturbed, m->plain, c, contest, NULL, 0);
    for (uint32_t i = 0; i < count && code == CLI_OK; i++) {
        if (m->unperturbed[i].status == STRESS_REFUSED) {
            code = cli_error(CLI_BAD_INPUT, "%s, unperturbed: %s", c->name, m->unperturbed[i].reason);
        }
    }
    if (code == CLI_OK) {
        stress_relate(m->unperturbed, m->unperturbed, count, contest->settings.automatic);
        code = stress_report_cell(report, m->unperturbed, m->plain, m->plain, c, NULL);
    }
    const perturbation *p;
    for (uint32_t i = 0; (p = stress_perturbation(i)) != NULL && code == CLI_OK; i++) {
        for (uint32_t g = 1; g <= STRESS_GRADES && code == CLI_OK; g++) {
            if (o->perturb[i] && o->grade[g]) {
                code = stress_measure(m->rows, m->renders, c, contest, p, g);
                if (code == CLI_OK) {
                    stress_relate(m->rows, m->unperturbed, count, contest->settings.automatic);
                    code = stress_report_cell(report, m->rows, m->renders, m->plain, c, p);
                }
            }
        }
    }
    return code;
}

/* Measures a scene. Its rows have the name of its perturbation. */
static int measure_scene(stress_report *report, const options *o, const stress_case *c, cells *m,
                         const stress_scene *scene, uint32_t grade)
{
    int code = stress_measure(m->rows, m->renders, c, &o->contest, NULL, 0);
    for (uint32_t i = 0; i < stress_row_count(&o->contest) && code == CLI_OK; i++) {
        m->rows[i].what = scene->name;
        m->rows[i].unit = scene->unit;
        m->rows[i].strength = scene->strength[grade - 1];
        m->rows[i].grade = grade;
    }
    return code == CLI_OK ? stress_report_cell(report, m->rows, m->renders, NULL, c, NULL) : code;
}

/* Measures a case and fills its `base`. `scene` NULL: a case of recorded frames. */
static int measure_case(stress_report *report, const options *o, stress_case *c, const stress_scene *scene,
                        uint32_t grade)
{
    int code = stress_case_open(c, &o->contest);
    if (code != CLI_OK) {
        return code;
    }
    cells m;
    if (!cells_open(&m, c, &o->contest)) {
        code = cli_error(CLI_BAD_INPUT, "out of memory");
    } else {
        code = scene == NULL ? perturb_all(report, o, c, &m) : measure_scene(report, o, c, &m, scene, grade);
    }
    cells_close(&m);
    stress_case_close(c);
    return code;
}

/* ---- cases ------------------------------------------------------------------------------------------------------- */

static void case_size(const options *o, uint32_t side, uint32_t *width, uint32_t *height)
{
    *width = o->contest.settings.config.width != 0 ? o->contest.settings.config.width : side;
    *height = o->contest.settings.config.height != 0 ? o->contest.settings.config.height : side;
}

/* Makes room for the first triplet. */
static int stress_room(stress_report *report, const options *o)
{
    static const uint32_t frames[] = {0, 2, 1};
    stress_case c = {.name = "room", .context = "0,2", .target = "1"};
    uint32_t width, height;
    case_size(o, ROOM_SIDE, &width, &height);
    int code =
        stress_capture_open(&c.base, width, height, 2, 0.001) ? CLI_OK : cli_error(CLI_BAD_INPUT, "out of memory");
    for (uint32_t v = 0; v < 3 && code == CLI_OK; v++) {
        room_frame(frames[v], width, height, ROOM_SEED, c.base.view[v].rgb, c.base.view[v].depth);
        room_recorded_camera(frames[v], width, height, &c.base.view[v].camera);
    }
    code = code == CLI_OK ? measure_case(report, o, &c, NULL, 0) : code;
    stress_capture_free(&c.base);
    return code;
}

/* "room" of "recordings/room.mcap" */
static void case_name(const char *path, char *name, size_t bytes)
{
    const char *slash = strrchr(path, '/');
    t3r_text_copy(name, bytes, t3r_text_of(slash == NULL ? path : slash + 1));
    char *dot = strrchr(name, '.');
    if (dot != NULL && dot != name) {
        *dot = '\0';
    }
}

static uint32_t triplet_count(const options *o, const t3r_recording *recording)
{
    uint32_t count = t3r_recording_triplet_count(recording);
    return count < o->triplets ? count : o->triplets;
}

static int stress_triplet(stress_report *report, const options *o, const t3r_recording *recording, const char *path,
                          t3r_triplet triplet)
{
    char name[256], context[32], target[16];
    case_name(path, name, sizeof name);
    evaluation_case what = {.recording = recording, .path = path, .scene = name, .target = triplet.target};
    what.context[what.context_count++] = triplet.context[0];
    snprintf(context, sizeof context, "%" PRIu32, triplet.context[0]);
    if (triplet.context[1] != triplet.context[0]) {
        what.context[what.context_count++] = triplet.context[1];
        snprintf(context, sizeof context, "%" PRIu32 ",%" PRIu32, triplet.context[0], triplet.context[1]);
    }
    snprintf(target, sizeof target, "%" PRIu32, triplet.target);
    stress_case c = {.name = name, .context = context, .target = target};
    int code = stress_capture_read(&c.base, &what, &o->contest.settings);
    code = code == CLI_OK ? measure_case(report, o, &c, NULL, 0) : code;
    stress_capture_free(&c.base);
    return code;
}

static int stress_recording(stress_report *report, const options *o, const t3r_recording *recording, const char *path)
{
    uint32_t all = t3r_recording_triplet_count(recording), chosen = triplet_count(o, recording);
    int code = CLI_OK;
    for (uint32_t i = 0; i < chosen && code == CLI_OK; i++) {
        /* the first triplet of one; of several, the first of each of that many equal parts */
        uint32_t at = (uint32_t)((uint64_t)i * all / chosen);
        code = stress_triplet(report, o, recording, path, t3r_recording_triplet(recording, at));
    }
    return code;
}

static int stress_scenes(stress_report *report, const options *o)
{
    const stress_scene *scene;
    int code = CLI_OK;
    for (uint32_t i = 0; (scene = stress_scene_at(i)) != NULL; i++) {
        for (uint32_t g = 1; g <= STRESS_GRADES && code == CLI_OK; g++) {
            if (!o->scene[i] || !o->grade[g]) {
                continue;
            }
            stress_case c = {.name = scene->name, .context = "", .target = ""};
            uint32_t width, height;
            case_size(o, STRESS_SCENE_SIDE, &width, &height);
            code = stress_scene_draw(&c.base, scene, scene->strength[g - 1], width, height)
                       ? measure_case(report, o, &c, scene, g)
                       : cli_error(CLI_BAD_INPUT, "out of memory");
            stress_capture_free(&c.base);
        }
    }
    return code;
}

/* ---- recordings -------------------------------------------------------------------------------------------------- */

/* Opens all before the first is measured, so that a bad one is reported at once. */
static int open_recordings(const options *o, t3r_recording **recordings, uint32_t *cases)
{
    for (uint32_t i = 0; i < o->input_count; i++) {
        char name[256], other[256];
        case_name(o->inputs[i], name, sizeof name);
        for (uint32_t earlier = 0; earlier < i; earlier++) {
            case_name(o->inputs[earlier], other, sizeof other);
            if (strcmp(name, other) == 0) {
                return cli_error(CLI_BAD_USAGE, "%s and %s would have the same name", o->inputs[earlier], o->inputs[i]);
            }
        }
        recordings[i] = import_source_open(o->inputs[i]);
        if (recordings[i] == NULL) {
            return CLI_BAD_INPUT;
        }
        if (t3r_recording_triplet_count(recordings[i]) == 0) {
            return cli_error(CLI_BAD_INPUT, "%s: the recording carries no triplets", o->inputs[i]);
        }
        *cases += triplet_count(o, recordings[i]);
    }
    return CLI_OK;
}

static int stress_all(const options *o, t3r_recording **recordings, uint32_t cases)
{
    stress_report report;
    uint32_t recorded = cells_of_case(o);
    int code = stress_report_open(&report, &o->to, &o->contest, cases * recorded + cells_of_scenes(o));
    if (code == CLI_OK && recorded > 0 && o->input_count == 0) {
        code = stress_room(&report, o);
    }
    for (uint32_t i = 0; i < o->input_count && recorded > 0 && code == CLI_OK; i++) {
        code = stress_recording(&report, o, recordings[i], o->inputs[i]);
    }
    if (code == CLI_OK) {
        code = stress_scenes(&report, o);
    }
    return stress_report_close(&report, code);
}

int command_stress(int argc, char **argv)
{
    options o = {
        .contest =
            {.methods = {&method_trim3r}, .method_count = 1, .keep = {10}, .keep_count = 1, .captures = 2, .seed = 1},
        .to = {.worst = 12},
        .triplets = 1};
    for (uint32_t i = 0; i < MOST_ROWS; i++) {
        o.perturb[i] = stress_perturbation(i) != NULL;
        o.scene[i] = stress_scene_at(i) != NULL;
    }
    for (uint32_t g = 1; g <= STRESS_GRADES; g++) {
        o.grade[g] = true;
    }
    reconstruction_defaults(&o.contest.settings);
    file_options_parse(&parser, argc, argv, &o);
    t3r_recording **recordings = calloc((size_t)o.input_count + 1, sizeof(t3r_recording *));
    if (recordings == NULL) {
        return cli_error(CLI_BAD_INPUT, "out of memory");
    }
    uint32_t cases = o.input_count == 0;
    int code = open_recordings(&o, recordings, &cases);
    if (code == CLI_OK) {
        code = stress_all(&o, recordings, cases);
    }
    for (uint32_t i = 0; i < o.input_count; i++) {
        if (recordings[i] != NULL) {
            t3r_recording_close(recordings[i]);
        }
    }
    free(recordings);
    return code;
}
