/* SPDX-License-Identifier: Apache-2.0 */
/* trim3r view: a scene, a recording or both, in a browser. */
#include "trim3r/commands/view.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "cli/cli.h"
#include "cli/files/whole_file.h"
#include "cli/options/file_kind.h"
#include "cli/options/file_options.h"
#include "cli/options/option_values.h"
#include "cli/tables/json_output.h"
#include "import/import_source.h"
#include "reconstruction/context/context_frames.h"
#include "scene/scene_file.h"
#include "scene/scene_options.h"
#include "trim3r/commands/commands.h"
#include "viewer/camera_path.h"
#include "viewer/follow.h"
#include "viewer/page.h"
#include "viewer/server.h"
#include "viewer/start_view.h"
#include "viewer/viewpoints.h"

#define ERROR_BYTES 512

enum { KEY_PORT = 0x1000, KEY_COMPARE };

static const struct argp_option options[] = {
    OPTION_ARGUMENTS("INPUT", OPTION_READS | OPTION_FOLDER | OPTION_LATER),
    {"output", 'o', "view.html", OPTION_WRITES(FILE_PAGE), "page to write, which needs no server (it is served)", 0},
    {"port", KEY_PORT, "N", 0, "port of the server on 127.0.0.1, 0 = any free one (0)", 0},
    {"compare", KEY_COMPARE, "LIST", 0,
     "further frames of the recording to look from and to compare with (the one in the middle of the first two context "
     "frames)",
     0},
    {"follow", OPTION_TO(view_options, follow), "RUN.jsonl", OPTION_READS | OPTION_LATER,
     "lines that replay --stream or capture --stream writes beside SCENE.ply: the page shows the map as it grows, the "
     "camera's path, latency and decisions",
     0},
    {"json", OPTION_TO(view_options, json), NULL, 0, "print one JSON object on stdout", 0},
    {0},
};

static void check_options(struct argp_state *state, view_options *o)
{
    for (int i = 0; i < 2 && o->inputs[i] != NULL; i++) {
        const bool scene = scene_file_is_one(o->inputs[i]);
        const char **place = scene ? &o->scene : &o->recording;
        if (*place != NULL) {
            argp_error(state, "'%s' and '%s' are both %s; one scene and one recording go together", *place,
                       o->inputs[i], scene ? "scenes" : "recordings");
        }
        *place = o->inputs[i];
    }
    if (o->inputs[0] == NULL) {
        argp_error(state, "REC.mcap or SCENE.ply is missing");
    } else if (o->settings.config.allocate == T3R_ALLOCATE_GIVEN) {
        argp_error(state, "a page builds by trim3r's own allocations alone");
    } else if (o->follow != NULL && (o->scene == NULL || o->recording != NULL || o->output != NULL)) {
        argp_error(state, "--follow needs a scene alone, and a page that is served");
    } else if (o->compare_count > 0 && o->recording == NULL) {
        argp_error(state, "--compare needs a recording");
    }
}

static error_t parse(int key, char *arg, struct argp_state *state)
{
    view_options *o = state->input;
    switch (key) {
    case ARGP_KEY_INIT:
        state->child_inputs[0] = &o->settings;
        state->child_inputs[1] = &o->settings.scene_flags;
        return 0;
    case 'o':
        o->output = arg;
        return 0;
    case KEY_PORT:
        o->port = (uint16_t)option_number(state, "port", arg, 0, UINT16_MAX);
        return 0;
    case KEY_COMPARE:
        option_frames(state, "compare", arg, o->compare, &o->compare_count);
        return 0;
    case ARGP_KEY_ARG:
        option_argument(state, arg, (const char **[]){&o->inputs[0], &o->inputs[1]}, 2);
        return 0;
    case ARGP_KEY_END:
        check_options(state, o);
        if (o->settings.gaussians == 0 && o->settings.keep_percent <= 0 && !reconstruction_chooses(&o->settings)) {
            o->settings.keep_percent = 10;
        }
        return 0;
    default:
        return option_field(key, arg, state);
    }
}

static const struct argp_child children[] = {{.argp = &reconstruction_argp}, {.argp = &scene_input_argp}, {0}};
const struct argp view_argp = {
    .options = options,
    .parser = parse,
    .args_doc = "REC.mcap|SCENE.ply [REC.mcap|SCENE.ply]",
    .doc = "Show a scene or a recording in a browser, by the runtime itself as WebAssembly.\v"
           "Examples:\n"
           "  trim3r view room.mcap --context 0,2 -o view.html\n"
           "  trim3r view room.mcap --context 0,2 --keep 5% --head tiny\n"
           "  trim3r view scene.ply -o view.html\n"
           "  trim3r view scene.ply room.mcap --context 0,2 --port 8080\n"
           "  trim3r view map.ply --follow run.jsonl\n"
           "\n"
           "The page builds scenes of a recording itself: a slider changes the budget, and mask, SuperClusters, "
           "texture and error are drawn over the frames. The first scene is built here as well, and the page "
           "compares the hashes. A scene file is drawn as it is; with a recording as well, the page does both. Scene "
           "files and recordings can be dropped on the page, and scenes cropped, and saved as .ply.\n"
           "\n"
           "With -o the page is one file that fetches nothing. Without, it is served on 127.0.0.1 until Ctrl-C.",
    .children = children,
};

/* ---- the page's data ------------------------------------------------------------------------------------------- */

static int add_frames(viewpoints *v, const view_options *o, const t3r_recording *recording, const reconstruction *r)
{
    const bool by_sensor = r->config.depth == T3R_DEPTH_SENSOR;
    const uint32_t width = r->config.width, height = r->config.height;
    int code = CLI_OK;
    for (uint32_t i = 0; i < r->context_count && code == CLI_OK; i++) {
        code = viewpoints_add(v, recording, o->recording, r->context[i], width, height, by_sensor);
    }
    for (uint32_t i = 0; i < o->compare_count && code == CLI_OK; i++) {
        code = viewpoints_add(v, recording, o->recording, o->compare[i], width, height, false);
    }
    uint32_t middle;
    if (code == CLI_OK && o->compare_count == 0 && viewpoints_middle(r->context, r->context_count, &middle)) {
        code = viewpoints_add(v, recording, o->recording, middle, width, height, false);
    }
    return code;
}

/* Builds what the page builds first, so that the page can compare. */
static int prepare_recording(const view_options *o, reconstruction *r, viewpoints *v, camera_path *path,
                             viewer_page *page)
{
    t3r_recording *recording = import_source_open(o->recording);
    if (recording == NULL) {
        return CLI_BAD_INPUT;
    }
    reconstruction_options settings = o->settings;
    int code = context_resolve(&settings, recording, o->recording);
    if (code == CLI_OK) {
        context_warn_of_strangers(recording, o->recording, &settings);
        code = reconstruction_build(r, recording, o->recording, &settings);
    }
    if (code == CLI_OK && o->after != NULL) {
        const reconstruction_account account = reconstruction_account_of(r);
        code = o->after(o->user, recording, r, &account);
    }
    if (code == CLI_OK) {
        code = add_frames(v, o, recording, r);
        camera_path_read(recording, path);
        page->path = path->places;
        page->path_count = path->count;
        page->data.config = r->config;
        page->data.config.workers = 1;
        page->data.weights = r->head.weights;
        page->data.weight_bytes = r->head.bytes;
        page->data.frames = v->frames;
        page->data.frame_count = v->count;
        page->valid_points = r->scene.valid_points;
        page->gaussians = r->scene.count;
        page->hashed = o->scene == NULL;
        page->hash = reconstruction_hash(r);
    }
    t3r_recording_close(recording);
    return code;
}

static int prepare_scene(const scene_file *scene, viewpoints *v, viewer_page *page)
{
    page->data.config = t3r_default_config(START_VIEW_WIDTH, START_VIEW_HEIGHT, 0, 1);
    return viewpoints_add_before(v, scene, START_VIEW_WIDTH, START_VIEW_HEIGHT);
}

/* ---- output ---------------------------------------------------------------------------------------------------- */

static void tell(const view_options *o, const viewer_page *page, const char *key, const char *where, uint64_t bytes)
{
    if (o->after != NULL) {
        return;
    }
    if (o->json) {
        cJSON *root = cJSON_CreateObject();
        cJSON_AddStringToObject(root, key, where);
        json_add_integer(root, "bytes", (int64_t)bytes);
        json_add_integer(root, "viewpoints", page->viewpoint_count);
        json_add_integer(root, "gaussians", page->gaussians);
        if (page->hashed) {
            json_add_hash(root, "hash", page->hash);
        }
        json_print(root);
    } else if (o->output != NULL) {
        printf("%s: %" PRIu64 " bytes; open it in a browser\n", where, bytes);
    } else {
        printf("%s (Ctrl-C ends it)\n", where);
    }
}

static int write_file(const view_options *o, const viewer_page *page)
{
    char error[ERROR_BYTES] = "";
    uint64_t bytes;
    t3r_whole_file file;
    if (whole_file_begin(&file, o->output, error, sizeof error) != 0) {
        return cli_error(CLI_BAD_INPUT, "%s", error);
    }
    if (viewer_page_write(page, file.stream) != 0) {
        t3r_whole_file_abandon(&file);
        return cli_error(CLI_BAD_INPUT, "out of memory");
    }
    if (t3r_whole_file_commit(&file, &bytes, error, sizeof error) != 0) {
        return cli_error(CLI_BAD_INPUT, "%s", error);
    }
    tell(o, page, "page", o->output, bytes);
    return CLI_OK;
}

/* Returns the page in heap memory; NULL if out of memory. */
static char *page_text(const viewer_page *page, size_t *bytes)
{
    char *text = NULL;
    FILE *memory = open_memstream(&text, bytes);
    if (memory == NULL) {
        return NULL;
    }
    const bool whole = viewer_page_write(page, memory) == 0 && !ferror(memory);
    if (fclose(memory) != 0 || !whole) {
        free(text);
        return NULL;
    }
    return text;
}

static int serve(const view_options *o, const viewer_page *page)
{
    char error[ERROR_BYTES] = "", address[64];
    uint16_t port = o->port;
    size_t bytes = 0;
    const int listener = server_open(&port, error, sizeof error);
    if (listener < 0) {
        return cli_error(CLI_BAD_INPUT, "%s", error);
    }
    viewer_follow follow = {.page = page_text(page, &bytes),
                            .data = &page->data,
                            .map = o->follow != NULL ? o->scene : NULL,
                            .lines = o->follow,
                            .scene_flags = o->settings.scene_flags};
    follow.page_bytes = bytes;
    if (follow.page != NULL) {
        snprintf(address, sizeof address, "http://127.0.0.1:%u/", (unsigned)port);
        tell(o, page, "address", address, bytes);
        (void)server_run(listener, port, viewer_follow_find, &follow, error, sizeof error);
    }
    const int code = cli_error(CLI_BAD_INPUT, "%s", follow.page != NULL ? error : "out of memory");
    free(follow.page);
    close(listener);
    return code;
}

static const char *last_part(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash != NULL ? slash + 1 : path;
}

static void name_page(const view_options *o, char *title, size_t bytes)
{
    if (o->title != NULL) {
        snprintf(title, bytes, "%s", o->title);
    } else {
        snprintf(title, bytes, "%s%s%s", last_part(o->inputs[0]), o->inputs[1] != NULL ? " and " : "",
                 o->inputs[1] != NULL ? last_part(o->inputs[1]) : "");
    }
}

static int show(const view_options *o, const scene_file *scene, reconstruction *r)
{
    char title[256];
    viewpoints v = {.count = 0};
    camera_path path;
    scene_file built;
    viewer_page page = {.title = title,
                        .names = v.names,
                        .viewpoints = v.frames,
                        .is_served = o->output == NULL,
                        .follows = o->follow != NULL,
                        .is_file = o->scene != NULL};
    name_page(o, title, sizeof title);
    int code = CLI_OK;
    if (o->recording != NULL) {
        code = prepare_recording(o, r, &v, &path, &page);
    } else {
        code = prepare_scene(scene, &v, &page);
        page.gaussians = scene->count;
    }
    page.viewpoint_count = v.count;
    t3r_config *config = &page.data.config;
    const uint32_t points = config->width * config->height * config->views;
    built =
        (scene_file){.frame = r->scene.frame, .gaussians = (t3r_gaussian *)r->scene.gaussians, .count = r->scene.count};
    page.data.scene = o->scene != NULL ? scene : &built;
    config->max_gaussians = points > page.data.scene->count ? points : page.data.scene->count;
    if (code == CLI_OK) {
        code = o->output != NULL ? write_file(o, &page) : serve(o, &page);
    }
    viewpoints_free(&v);
    return code;
}

void view_defaults(view_options *o)
{
    *o = (view_options){.port = 0};
    reconstruction_defaults(&o->settings);
    o->settings.config.keep_analysis = 1; /* as the page's own builds: the slider takes the analysis over */
}

/* Waits until another program has written the file. */
static void wait_for(const char *path)
{
    const struct timespec moment = {.tv_nsec = 200000000};
    if (access(path, F_OK) != 0) {
        (void)cli_error(CLI_OK, "%s: waits until a stream writes it (Ctrl-C ends it)", path);
    }
    while (access(path, F_OK) != 0) {
        nanosleep(&moment, NULL);
    }
}

int view_run(const view_options *o)
{
    if (!viewer_page_is_built()) {
        return cli_error(
            CLI_BAD_INPUT,
            "this program was built without the page: install clang, lld and wasi-libc (tools/setup --viewer), and "
            "build again");
    }
    char error[ERROR_BYTES] = "";
    scene_file scene = {0};
    reconstruction r = {0};
    if (o->follow != NULL) {
        wait_for(o->follow);
        wait_for(o->scene);
    }
    if (o->scene != NULL && scene_file_read(o->scene, o->settings.scene_flags, &scene, error, sizeof error) != 0) {
        return cli_error(CLI_BAD_INPUT, "%s", error);
    }
    const int code = show(o, &scene, &r);
    reconstruction_close(&r);
    scene_file_free(&scene);
    return code;
}

int command_view(int argc, char **argv)
{
    view_options o;
    view_defaults(&o);
    file_options_parse(&view_argp, argc, argv, &o);
    return view_run(&o);
}
