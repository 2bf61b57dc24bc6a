/* SPDX-License-Identifier: Apache-2.0 */
/* trim3r chart: charts and a report from tables of eval. */
#include "study/commands/commands.h"

#include <argp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/cli.h"
#include "cli/files/whole_file.h"
#include "cli/options/file_options.h"
#include "cli/options/option_values.h"
#include "cli/text/word_list.h"
#include "study/chart/names.h"
#include "study/chart/page.h"
#include "study/chart/pictures.h"
#include "study/chart/points.h"
#include "study/chart/raster.h"
#include "study/chart/svg.h"
#include "study/chart/table.h"
#include "study/chart/view.h"

#define ERROR_BYTES 512
#define MOST_COSTS ((uint32_t)(CHART_COSTS_END - CHART_QUALITIES))
#define PICTURE_BYTES ((size_t)9 << 18) /* default: as text, these make a report below 4 MB */
#define PNG_SCALE 2.0

typedef struct options {
    char **tables;
    uint32_t table_count;
    char **folders; /* --pictures */
    uint32_t folder_count;
    const char *page, *svg, *png, *scene;
    chart_measure quality; /* CHART_MEASURES = the first available one */
    chart_measure costs[MOST_COSTS];
    uint32_t cost_count; /* 0 = the costs in the tables */
    size_t picture_bytes;
    bool dark;
} options;

enum { KEY_PICTURES = 0x100, KEY_MIB, KEY_ALL, KEY_QUALITY, KEY_AGAINST };

/* ---- arguments ------------------------------------------------------------------------------------------------- */

/* Returns the measure within [from, to) that has this column name. */
static chart_measure measure(struct argp_state *state, const char *option, list_word name, int from, int to)
{
    for (int m = from; m < to; m++) {
        if (word_is(name, chart_measures[m].column)) {
            return (chart_measure)m;
        }
    }
    argp_error(state, "--%s takes %s, not '%.*s'", option,
               from == 0 ? "psnr, ssim, perceptual, planar_psnr, psnr_all, ssim_all or perceptual_all"
                         : "build_ms, render_ms, arena_bytes and scene_bytes with commas between",
               (int)name.length, name.text);
    return CHART_MEASURES;
}

static void parse_against(struct argp_state *state, options *o, const char *text)
{
    o->cost_count = 0;
    for (list_word w = word_first(text); w.text != NULL; w = word_next(w)) {
        chart_measure cost = measure(state, "against", w, CHART_QUALITIES, CHART_COSTS_END);
        for (uint32_t i = 0; i < o->cost_count; i++) {
            if (o->costs[i] == cost) {
                argp_error(state, "--against names %s twice", chart_measures[cost].column);
            }
        }
        o->costs[o->cost_count++] = cost; /* each once: there is room */
    }
}

static void check_options(struct argp_state *state, const options *o)
{
    if (o->table_count == 0) {
        argp_error(state, "EVAL.csv is missing");
    }
    if (o->page == NULL && o->svg == NULL && o->png == NULL) {
        argp_error(state, "there is no output: give -o, --svg or --png");
    }
    if (o->folder_count > 0 && o->page == NULL) {
        argp_error(state, "--pictures belongs to a report (-o)");
    }
    if (o->folder_count > 1 && o->folder_count != o->table_count) {
        argp_error(state, "--pictures: one folder for all tables, or one for each in their order");
    }
    if (o->dark && o->png == NULL) {
        argp_error(state, "--dark belongs to --png; the others follow the reader");
    }
}

static error_t parse(int key, char *arg, struct argp_state *state)
{
    options *o = state->input;
    switch (key) {
    case 'o':
        o->page = arg;
        return 0;
    case KEY_PICTURES:
        o->folders[o->folder_count++] = arg; /* one slot per argument: there is room */
        return 0;
    case KEY_MIB:
        o->picture_bytes = (size_t)option_number(state, "picture-mib", arg, 1, 1024) << 20;
        return 0;
    case KEY_ALL:
        o->picture_bytes = SIZE_MAX;
        return 0;
    case KEY_QUALITY:
        o->quality = measure(state, "quality", (list_word){arg, strlen(arg)}, 0, CHART_QUALITIES);
        return 0;
    case KEY_AGAINST:
        parse_against(state, o, arg);
        return 0;
    case ARGP_KEY_ARGS:
        option_arguments(state, &o->tables, &o->table_count);
        return 0;
    case ARGP_KEY_END:
        check_options(state, o);
        return 0;
    default:
        return option_field(key, arg, state);
    }
}

static const struct argp_option argp_options[] = {
    OPTION_ARGUMENTS("EVAL.csv", OPTION_READS),
    {NULL, 0, NULL, 0, "What is written:", 1},
    {"output", 'o', "REPORT.html", OPTION_WRITES(FILE_PAGE),
     "report to write: every quality against every cost, in one file that fetches nothing", 0},
    {"svg", OPTION_TO(options, svg), "FILE", OPTION_WRITES(FILE_SVG), "picture to write: a panel for each cost", 0},
    {"png", OPTION_TO(options, png), "FILE", OPTION_WRITES(FILE_PICTURE), "picture of --svg to write in pixels", 0},
    {"dark", OPTION_TO(options, dark), NULL, 0, "draw the PNG on a dark ground", 0},
    {NULL, 0, NULL, 0, "What is shown:", 2},
    {"quality", KEY_QUALITY, "NAME", 0,
     "quality to draw: psnr, ssim, perceptual, planar_psnr, psnr_all, ssim_all or perceptual_all; the report begins "
     "with it (psnr)",
     0},
    {"against", KEY_AGAINST, "NAME,NAME,...", 0,
     "costs to draw the quality against: build_ms, render_ms, arena_bytes, scene_bytes (all that the tables have); the "
     "report "
     "begins with the first",
     0},
    {"scene", OPTION_TO(options, scene), "NAME", 0,
     "scene to draw, alone (the mean over all); the report begins with it", 0},
    {"pictures", KEY_PICTURES, "DIR", OPTION_READS | OPTION_FOLDER,
     "folder that eval --images wrote, for the report: one for all tables, or one each in their order", 0},
    {"picture-mib", KEY_MIB, "N", 0,
     "most MiB of pictures that the report holds, 1..1024, the front's first (as many as leave it below 4 MB)", 0},
    {"all-pictures", KEY_ALL, NULL, 0, "let the report hold all pictures", 0},
    {0},
};

static const struct argp parser = {
    .options = argp_options,
    .parser = parse,
    .args_doc = "EVAL.csv...",
    .doc = "Chart quality against time and bytes, from the tables of eval.\v"
           "A point is one method, head, bits, "
           "refinement, allocation, depth, wavelet, levels, clusters, ablation and budget: its mean over scenes, each "
           "the mean over its cases. Points that differ only in the budget are joined. A ring marks those that nothing "
           "beats in both cost and quality, among the points measured on all cases. Tables may be from different runs "
           "and older versions: a missing column counts as not varied; equal rows are repeated measurements. A "
           "malformed table is refused with its line.\n"
           "\n"
           "The report shows the settings of the point under the pointer or with the keyboard's focus: arrow keys "
           "move, Enter opens. It shows scenes one by one, and for each point its render, the target and a map of the "
           "error.\n"
           "\n"
           "Examples:\n"
           "  trim3r eval room.mcap --keep 100,20,5 --csv a.csv --images a\n"
           "  trim3r chart a.csv --pictures a -o report.html\n"
           "  trim3r eval room.mcap --keep 100,20,5 --refine 0 --csv b.csv --images b\n"
           "  trim3r chart a.csv b.csv --pictures a --pictures b -o report.html\n"
           "  trim3r chart a.csv b.csv --against build_ms --svg speed.svg --png speed.png\n"
           "  trim3r chart a.csv --quality ssim --against scene_bytes --svg bytes.svg",
};

/* ---- work ------------------------------------------------------------------------------------------------------ */

typedef struct chart {
    chart_table table;
    chart_points points;
    chart_names names;
    chart_view views[MOST_COSTS]; /* each with something to show */
    uint32_t view_count;
} chart;

static int make_views(chart *c, options *o)
{
    uint32_t scene = CHART_ALL_SCENES;
    for (uint32_t s = 0; o->scene != NULL && s < c->table.scenes.count; s++) {
        scene = strcmp(c->table.scenes.text[s], o->scene) == 0 ? s : scene;
    }
    if (o->scene != NULL && scene == CHART_ALL_SCENES) {
        return cli_error(CLI_BAD_INPUT, "the tables have no scene '%s'", o->scene);
    }
    for (int m = 0; m < CHART_QUALITIES && o->quality == CHART_MEASURES; m++) {
        o->quality = chart_points_have(&c->points, (chart_measure)m) ? (chart_measure)m : o->quality;
    }
    if (o->quality == CHART_MEASURES) {
        return cli_error(CLI_BAD_INPUT, "no row of the tables has a quality");
    }
    bool asked = o->cost_count > 0;
    for (int m = CHART_QUALITIES; m < CHART_COSTS_END && !asked; m++) {
        o->costs[o->cost_count++] = (chart_measure)m;
    }
    for (uint32_t i = 0; i < o->cost_count; i++) {
        chart_view *view = &c->views[c->view_count];
        if (chart_view_make(view, &c->points, (chart_choice){o->quality, o->costs[i], scene}) != 0) {
            return cli_error(CLI_BAD_INPUT, "out of memory");
        }
        c->view_count++;
        if (view->shown == 0) {
            chart_view_free(view);
            c->view_count--;
            if (asked) {
                return cli_error(CLI_BAD_INPUT, "no row of the tables has %s and %s", chart_measures[o->quality].column,
                                 chart_measures[o->costs[i]].column);
            }
        }
    }
    return c->view_count > 0
               ? CLI_OK
               : cli_error(CLI_BAD_INPUT, "no row of the tables has %s and a cost", chart_measures[o->quality].column);
}

static int read_tables(chart *c, options *o)
{
    char error[ERROR_BYTES] = "";
    for (uint32_t i = 0; i < o->table_count; i++) {
        if (chart_table_read(&c->table, o->tables[i], error, sizeof error) != 0) {
            return cli_error(CLI_BAD_INPUT, "%s", error);
        }
    }
    if (chart_points_make(&c->points, &c->table, error, sizeof error) != 0) {
        return cli_error(CLI_BAD_INPUT, "%s", error);
    }
    if (chart_names_make(&c->names, &c->points) != 0) {
        return cli_error(CLI_BAD_INPUT, "out of memory");
    }
    return make_views(c, o);
}

static int write_svg(const chart *c, const char *path)
{
    char error[ERROR_BYTES] = "";
    t3r_whole_file file;
    if (whole_file_begin(&file, path, error, sizeof error) != 0) {
        return cli_error(CLI_BAD_INPUT, "%s", error);
    }
    chart_svg_write(file.stream, &c->points, &c->names, c->views, c->view_count, CHART_GROUND_READER);
    return t3r_whole_file_commit(&file, NULL, error, sizeof error) == 0 ? CLI_OK
                                                                        : cli_error(CLI_BAD_INPUT, "%s", error);
}

static int write_png(const chart *c, const char *path, bool dark)
{
    char error[ERROR_BYTES] = "", *text = NULL;
    size_t bytes = 0;
    FILE *svg = open_memstream(&text, &bytes);
    if (svg == NULL) {
        return cli_error(CLI_BAD_INPUT, "out of memory");
    }
    chart_svg_write(svg, &c->points, &c->names, c->views, c->view_count, dark ? CHART_GROUND_DARK : CHART_GROUND_LIGHT);
    bool failed = ferror(svg) != 0;
    failed |= fclose(svg) != 0;
    int code = failed ? cli_error(CLI_BAD_INPUT, "out of memory") : CLI_OK;
    if (code == CLI_OK && chart_raster_png(path, text, bytes, PNG_SCALE, error, sizeof error) != 0) {
        code = cli_error(CLI_BAD_INPUT, "%s", error);
    }
    free(text);
    return code;
}

static int write_page(const chart *c, const chart_pictures *pictures, const char *path)
{
    char error[ERROR_BYTES] = "";
    t3r_whole_file file;
    if (whole_file_begin(&file, path, error, sizeof error) != 0) {
        return cli_error(CLI_BAD_INPUT, "%s", error);
    }
    if (chart_page_write(file.stream, &c->points, &c->names, pictures, &c->views[0]) != 0) {
        t3r_whole_file_abandon(&file);
        return cli_error(CLI_BAD_INPUT, "%s: out of memory", path);
    }
    return t3r_whole_file_commit(&file, NULL, error, sizeof error) == 0 ? CLI_OK
                                                                        : cli_error(CLI_BAD_INPUT, "%s", error);
}

static int report(const chart *c, const options *o)
{
    char error[ERROR_BYTES] = "";
    chart_pictures pictures;
    if (chart_pictures_gather(&pictures, &c->points, &c->views[0], o->folders, o->folder_count, o->picture_bytes, error,
                              sizeof error) != 0) {
        return cli_error(CLI_BAD_INPUT, "%s", error);
    }
    if (o->folder_count > 0 && !c->table.has_pictures) {
        (void)cli_error(CLI_OK, "warning: no table names pictures; eval --images with --csv does");
    }
    if (pictures.missing > 0) {
        (void)cli_error(CLI_OK, "warning: %u of the pictures that the tables name are not in the folders",
                        (unsigned)pictures.missing);
    }
    int code = write_page(c, &pictures, o->page);
    chart_pictures_free(&pictures);
    return code;
}

static int run(options *o)
{
    chart c = {0};
    int code = read_tables(&c, o);
    if (code == CLI_OK && o->svg != NULL) {
        code = write_svg(&c, o->svg);
    }
    if (code == CLI_OK && o->png != NULL) {
        code = write_png(&c, o->png, o->dark);
    }
    if (code == CLI_OK && o->page != NULL) {
        code = report(&c, o);
    }
    for (uint32_t v = 0; v < c.view_count; v++) {
        chart_view_free(&c.views[v]);
    }
    chart_names_free(&c.names);
    chart_points_free(&c.points);
    chart_table_free(&c.table);
    return code;
}

int command_chart(int argc, char **argv)
{
    options o = {
        .quality = CHART_MEASURES, .picture_bytes = PICTURE_BYTES, .folders = calloc((size_t)argc, sizeof(char *))};
    if (o.folders == NULL) {
        return cli_error(CLI_BAD_INPUT, "out of memory");
    }
    file_options_parse(&parser, argc, argv, &o);
    int code = run(&o);
    free(o.folders);
    return code;
}
