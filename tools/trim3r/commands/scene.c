/* SPDX-License-Identifier: Apache-2.0 */
/* trim3r scene: pictures, a folder, a bag or a recording to a scene or a page, by import and by build or view. */
#include <argp.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "cli/cli.h"
#include "cli/files/part_files.h"
#include "cli/options/file_kind.h"
#include "cli/options/file_options.h"
#include "cli/options/option_values.h"
#include "import/poses/intrinsics.h"
#include "scene/scene_options.h"
#include "trim3r/commands/build.h"
#include "trim3r/commands/commands.h"
#include "trim3r/commands/import.h"
#include "trim3r/commands/view.h"
#include "trim3r/scene/command_line.h"
#include "trim3r/scene/scene_report.h"

#define LONGEST_SIDE 640u /* of the size that is worked on, unless another is given */
#define PATH_BYTES 4096

typedef struct scene_request {
    const char *input, *output;
    const char *recording; /* NULL = not kept */
    const char *intrinsics, *gaussians, *keep, *min_psnr;
    uint32_t width, height; /* 0 = at most LONGEST_SIDE */
    bool shows, json;       /* shows: prints the commands, and runs none */
} scene_request;

enum { KEY_SIZE = 0x100 };

/* Checks the values that import and build parse again, before any of them runs. */
static void check_values(struct argp_state *state, const scene_request *o)
{
    double numbers[INTRINSICS_NUMBERS];
    uint32_t count;
    if (o->gaussians != NULL) {
        option_number(state, "gaussians", o->gaussians, 1, T3R_MAX_GAUSSIANS);
    }
    if (o->keep != NULL) {
        option_percents(state, "keep", o->keep, numbers, 1, &count);
    }
    if (o->min_psnr != NULL) {
        option_decimal(state, "min-psnr", o->min_psnr, 0.01, 100);
    }
    if (o->intrinsics != NULL && intrinsics_of_text(o->intrinsics, numbers) == 0) {
        argp_error(state, "--intrinsics %s: not " INTRINSICS_FORM, o->intrinsics);
    }
}

static void check_options(struct argp_state *state, const scene_request *o)
{
    check_values(state, o);
    if (o->input == NULL) {
        argp_error(state, "PHOTOS, a folder, a bag or a recording is missing");
    } else if (o->output == NULL) {
        argp_error(state, "-o SCENE.ply or -o PAGE.html is missing");
    } else if ((o->gaussians != NULL) + (o->keep != NULL) + (o->min_psnr != NULL) > 1) {
        argp_error(state, "--gaussians, --keep and --min-psnr exclude each other");
    } else if (file_kind_named(o->output) != FILE_PAGE) {
        scene_output_option(state, "-o", o->output);
    }
}

static error_t parse_option(int key, char *argument, struct argp_state *state)
{
    scene_request *o = state->input;
    switch (key) {
    case 'o':
        o->output = argument;
        return 0;
    case KEY_SIZE:
        option_size(state, "size", argument, T3R_MIN_SIDE, &o->width, &o->height);
        return 0;
    case ARGP_KEY_ARG:
        option_argument(state, argument, (const char **[]){&o->input}, 1);
        return 0;
    case ARGP_KEY_END:
        check_options(state, o);
        return 0;
    default:
        return option_field(key, argument, state);
    }
}

static const struct argp_option argp_options[] = {
    OPTION_ARGUMENTS("INPUT", OPTION_READS | OPTION_FOLDER),
    {"output", 'o', "SCENE|PAGE", OPTION_WRITES(FILE_SCENE | FILE_PAGE),
     "scene to write, or page.html that shows it (needed); the ending names the format", 0},
    {"recording", OPTION_TO(scene_request, recording), "REC.mcap", OPTION_WRITES(FILE_RECORDING),
     "recording to keep, for render, view and eval (not kept)", 0},
    {"size", KEY_SIZE, "WxH", 0, "size that is worked on (that of the frames, the longer side at most 640)", 0},
    {"intrinsics", OPTION_TO(scene_request, intrinsics), "LIST", 0,
     "lens of pictures, as for import: fx,fy,cx,cy[,k1,k2,p1,p2,k3] (EXIF's focal length, else an estimate)", 0},
    {"gaussians", OPTION_TO(scene_request, gaussians), "Z", 0, "number of Gaussians (as for --keep 10%)", 0},
    {"keep", OPTION_TO(scene_request, keep), "P%", 0, "percent of the valid points to retain (10%)", 0},
    {"min-psnr", OPTION_TO(scene_request, min_psnr), "DB", 0,
     "decibels with which the chosen frames must be drawn, by as few Gaussians as they need, instead of a number "
     "(none)",
     0},
    {"dry-run", OPTION_TO(scene_request, shows), NULL, 0, "print the commands that do the same, and run none", 0},
    {"json", OPTION_TO(scene_request, json), NULL, 0, "print one JSON object on stdout", 0},
    {0},
};

static const struct argp argp = {
    .options = argp_options,
    .parser = parse_option,
    .args_doc = "PHOTOS|DIR|BAG|REC.mcap",
    .doc = "Turn photos, a folder, a bag or a recording into a scene, or into a page that shows it."
           "\vIt finds out what the input is and runs import, then build or view, with options that suit it: poses are "
           "estimated where there are none, depth is that of a sensor or matched from the colours, and --context auto "
           "chooses the frames. Six lines say what was done, and how well each picture is drawn, in dB: 25 and more "
           "is good, less than 18 poor. The quality of the scene is poor when more than a quarter of the chosen "
           "pictures is. It is good when none is poor and half of them are good, and half of the others, if there are "
           "any, are not poor. Sides that no picture shows are smeared. Pictures that are blurred, or of which the "
           "scene shows little, are named.\n"
           "\n"
           "Photos: move sideways, a hand's breadth from one photo to the next, and do not only turn. Photos are "
           "turned upright as EXIF states.\n"
           "\n"
           "Examples:\n"
           "  trim3r scene photos -o scene.ply\n"
           "  trim3r scene photos -o page.html\n"
           "  trim3r scene photos --min-psnr 26 -o scene.ply\n"
           "  trim3r scene photos --dry-run -o scene.ply\n"
           "  trim3r scene bag.mcap --keep 5% --recording bag-frames.mcap -o scene.spz",
};

/* The commands of one run. */
typedef struct plan {
    scene_source source;
    bool imports, estimates, by_stereo, is_page;
    command_line import, build; /* build is "trim3r view" for a page */
} plan;

/* ---- planning --------------------------------------------------------------------------------------------------- */

/* Fits the frames' size into LONGEST_SIDE. Returns whether that makes them smaller. */
static bool smaller_size(const scene_source *source, uint32_t *width, uint32_t *height)
{
    const uint32_t longest = source->width > source->height ? source->width : source->height;
    *width = (source->width * LONGEST_SIDE + longest / 2) / longest;
    *height = (source->height * LONGEST_SIDE + longest / 2) / longest;
    *width = *width < T3R_MIN_SIDE ? T3R_MIN_SIDE : *width;
    *height = *height < T3R_MIN_SIDE ? T3R_MIN_SIDE : *height;
    return longest > LONGEST_SIDE;
}

/* Writes the lines; `recording` is what import makes. */
static void make_lines(plan *p, const scene_request *o, const char *recording)
{
    uint32_t width = o->width, height = o->height;
    const bool sized = width > 0 || smaller_size(&p->source, &width, &height);
    line_begin(&p->import, "trim3r import");
    line_add(&p->import, o->input);
    if (o->intrinsics != NULL) {
        line_add_option(&p->import, "--intrinsics", o->intrinsics);
    }
    if (sized && p->imports) {
        line_add_size(&p->import, "--size", width, height);
    }
    if (p->estimates) {
        line_add_option(&p->import, "--poses", "estimate");
    }
    line_add_option(&p->import, "-o", recording);

    line_begin(&p->build, p->is_page ? "trim3r view" : "trim3r build");
    line_add(&p->build, p->imports ? recording : o->input);
    line_add_option(&p->build, "--context", "auto");
    if (p->by_stereo) {
        line_add_option(&p->build, "--depth", "stereo");
    }
    if (sized && !p->imports) {
        line_add_size(&p->build, "--working", width, height);
    }
    if (o->min_psnr != NULL) {
        line_add_option(&p->build, "--min-psnr", o->min_psnr);
    } else if (o->gaussians != NULL) {
        line_add_option(&p->build, "--gaussians", o->gaussians);
    } else {
        line_add_option(&p->build, "--keep", o->keep != NULL ? o->keep : "10%");
    }
    line_add_option(&p->build, "--threads", "all");
    line_add_option(&p->build, "-o", o->output);
}

static int make_plan(plan *p, const scene_request *o)
{
    *p = (plan){.is_page = file_kind_named(o->output) == FILE_PAGE};
    const int code = scene_source_look(&p->source, o->input);
    p->estimates = p->source.posed < p->source.frames && p->source.posed < 2;
    p->by_stereo = 2 * p->source.with_depth < p->source.frames;
    p->imports = !p->source.is_recording || p->estimates || o->recording != NULL || o->intrinsics != NULL;
    if (code == CLI_OK && p->source.frames < 2 && p->by_stereo) {
        return cli_error(CLI_BAD_INPUT, "%s: one picture without depth: two or more are needed", o->input);
    }
    return code;
}

/* ---- running ---------------------------------------------------------------------------------------------------- */

typedef struct scene_run {
    scene_report report;
    const char *recording;
    bool lacks_memory;
} scene_run;

static void after_import(void *user, const posed_folder *folder, const pose_account *accounts)
{
    scene_run *run = user;
    run->lacks_memory = folder != NULL && scene_report_keep(&run->report, folder, accounts) != 0;
}

static int after_build(void *user, const t3r_recording *recording, reconstruction *r,
                       const reconstruction_account *account)
{
    scene_run *run = user;
    scene_report *report = &run->report;
    const t3r_pairing_info pairing = t3r_recording_pairing(recording);
    report->frames = pairing.frames;
    report->posed = pairing.with_pose;
    report->gaussians = r->scene.count;
    report->valid_points = account->valid_points;
    report->width = account->width;
    report->height = account->height;
    report->depth = t3r_depth_name(r->config.depth);
    return drawn_pictures(recording, run->recording, r, account, report->drawn, &report->drawn_count);
}

static int run_import(plan *p, scene_run *run)
{
    import_options options;
    import_defaults(&options);
    line_parse(&p->import, &import_argp, &options);
    options.after = after_import;
    options.user = run;
    const int code = import_run(&options);
    return code == CLI_OK && run->lacks_memory ? cli_error(CLI_BAD_INPUT, "out of memory") : code;
}

static int run_build(plan *p, scene_run *run)
{
    if (p->is_page) {
        view_options options;
        view_defaults(&options);
        line_parse(&p->build, &view_argp, &options);
        options.title = run->report.input; /* the recording may be temporary */
        options.after = after_build;
        options.user = run;
        return view_run(&options);
    }
    build_options options;
    build_defaults(&options);
    line_parse(&p->build, &build_argp, &options);
    options.after = after_build;
    options.user = run;
    return build_run(&options);
}

static int run_lines(plan *p, const scene_request *o, const char *recording)
{
    const double start = cli_now();
    scene_run run = {.report = {.input = o->input, .output = o->output, .source = p->source, .estimated = p->estimates},
                     .recording = p->imports ? recording : o->input};
    int code = p->imports ? run_import(p, &run) : CLI_OK;
    code = code == CLI_OK ? run_build(p, &run) : code;
    run.report.seconds = cli_now() - start;
    if (code == CLI_OK && o->json) {
        scene_report_print_json(&run.report);
    } else if (code == CLI_OK) {
        scene_report_print(&run.report);
    }
    scene_report_free(&run.report);
    return code;
}

/* Makes an empty file for a recording that is not kept; a signal removes it. */
static int make_temporary(char path[PATH_BYTES])
{
    const char *folder = getenv("TMPDIR");
    const int length = snprintf(path, PATH_BYTES, "%s/trim3r-scene-XXXXXX.mcap",
                                folder != NULL && *folder != '\0' ? folder : P_tmpdir);
    const int file = length > 0 && length < PATH_BYTES ? mkstemps(path, (int)strlen(".mcap")) : -1;
    if (file < 0) {
        return cli_error(CLI_BAD_INPUT, "no temporary file can be made in TMPDIR; --recording names another place");
    }
    close(file);
    return part_files_add(path) ? CLI_OK : cli_error(CLI_BAD_INPUT, "%s: too many files at a time", path);
}

static int run_with_temporary(plan *p, const scene_request *o)
{
    char path[PATH_BYTES];
    int code = make_temporary(path);
    if (code == CLI_OK) {
        make_lines(p, o, path);
        code = run_lines(p, o, path);
        unlink(path);
        part_files_forget(path);
    }
    return code;
}

/* Prints the lines, with a recording named after the output. */
static int show_lines(plan *p, const scene_request *o)
{
    char recording[PATH_BYTES];
    const char *slash = strrchr(o->output, '/'), *dot = strrchr(o->output, '.');
    const size_t stem = dot != NULL && (slash == NULL || dot > slash) ? (size_t)(dot - o->output) : strlen(o->output);
    snprintf(recording, sizeof recording, "%.*s.mcap", (int)stem, o->output);
    make_lines(p, o, o->recording != NULL ? o->recording : recording);
    if (p->imports) {
        line_print(&p->import);
    }
    line_print(&p->build);
    return CLI_OK;
}

int command_scene(int argc, char **argv)
{
    scene_request o = {0};
    plan p;
    file_options_parse(&argp, argc, argv, &o);
    const int code = make_plan(&p, &o);
    if (code != CLI_OK) {
        return code;
    }
    if (o.shows) {
        return show_lines(&p, &o);
    }
    if (p.imports && o.recording == NULL) {
        return run_with_temporary(&p, &o);
    }
    make_lines(&p, &o, o.recording);
    return run_lines(&p, &o, o.recording);
}
