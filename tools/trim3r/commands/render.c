/* SPDX-License-Identifier: Apache-2.0 */
/* trim3r render: draws a scene file from a viewpoint. */
#include "trim3r/commands/commands.h"

#include <argp.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/cli.h"
#include "cli/jobs/work_times.h"
#include "cli/options/file_options.h"
#include "cli/options/option_values.h"
#include "cli/options/standard_output.h"
#include "cli/tables/json_output.h"
#include "core/hash.h"
#include "kernels/project.h"
#include "pictures/picture.h"
#include "pictures/video.h"
#include "reconstruction/reconstruction_error.h"
#include "scene/scene_options.h"
#include "trim3r/commands/render.h"

#define ERROR_BYTES 512
#define MAX_PATH_BYTES 4096

enum {
    KEY_VIEW = 0x1000,
    KEY_SIZE,
    KEY_FOV,
    KEY_ORBIT,
    KEY_ARC,
    KEY_UP,
    KEY_RATE,
    KEY_DEPTH_UNIT,
    KEY_ARENA,
    KEY_MAX_MS,
    KEY_TILE_SPLATS
};

static const struct argp_option options[] = {
    OPTION_ARGUMENTS("SCENE.ply", OPTION_READS | OPTION_FOLDER),
    {NULL, 0, NULL, 0, "Viewpoint:", 1},
    {"view", KEY_VIEW, "N", 0, "frame of REC.mcap whose camera draws", 0},
    {"pose", OPTION_TO(render_options, pose), "FILE.json", OPTION_READS,
     "camera as JSON, or several, one numbered picture each (below)", 0},
    {"path", OPTION_TO(render_options, pose), "FILE.json", OPTION_READS,
     "the same as --pose, for a camera path as nerfstudio's viewer saves it", 0},
    {"orbit", KEY_ORBIT, "N", 0,
     "turntable: N views around the middle of the scene, from above, or from --view or --pose on", 0},
    {"arc", KEY_ARC, "DEGREES", 0,
     "part of a turn that --orbit draws, with --view or --pose in its middle (360, from there on)", 0},
    {"up", KEY_UP, "x|-x|y|-y|z|-z", 0,
     "axis of the scene that points up, about which it turns (that of the file, else -y)", 0},
    {"trajectory", OPTION_TO(render_options, trajectory), "FILE", OPTION_READS,
     "list of poses, one numbered picture each; the lens is that of --view, --pose or --fov", 0},
    {"strict", OPTION_TO(render_options, strict), NULL, 0, POSE_LOSSES_STRICT_HELP, 0},
    {"fov", KEY_FOV, "DEGREES", 0, "horizontal angle of view of a trajectory, with --size, or of a turntable (60)", 0},
    {"size", KEY_SIZE, "WxH", 0, "size of the picture; the lens is scaled along (the camera's; 640x480)", 0},
    {NULL, 0, NULL, 0, "Pictures:", 2},
    {"output", 'o', "view.png", OPTION_WRITES(FILE_PICTURE | FILE_VIDEO) | OPTION_PIPE,
     "picture to write (needed), or of several views a video: .mp4, .mkv, .mov or .webm, by the program ffmpeg; -: a "
     "picture to standard output",
     0},
    {"rate", KEY_RATE, "FPS", 0, "pictures a second of a video (those of the camera path, or 24)", 0},
    {"depth", OPTION_TO(render_options, depth), "d.png", OPTION_WRITES(FILE_PICTURE),
     "depth along z to write, 16 bits, 0 = none", 0},
    {"depth-unit", KEY_DEPTH_UNIT, "U", 0, "world units in one step of the depth picture (0.001)", 0},
    {"alpha", OPTION_TO(render_options, alpha), "a.png", OPTION_WRITES(FILE_PICTURE),
     "coverage to write, 16 bits, 65535 = opaque", 0},
    {NULL, 0, NULL, 0, "Bounds of the time that a view takes:", 3},
    {"max-ms", KEY_MAX_MS, "MS", 0, "give up when a view takes longer (never)", 0},
    {"tile-splats", KEY_TILE_SPLATS, "N", 0,
     "draw a tile of 16 x 16 pixels from its N nearest Gaussians alone, 0..16777216; 0 = from all (0)", 0},
    {"arena", KEY_ARENA, "BYTES[K|M|G]|min|full", 0,
     "bytes of memory of the runtime; min is the least that works, full the most that helps (full)", PROCESSOR_GROUP},
    {NULL, 0, NULL, 0, "Other:", PROCESSOR_GROUP + 1},
    {"json", OPTION_TO(render_options, json), NULL, 0, "print one JSON object on stdout", 0},
    {0},
};

static double parse_positive(struct argp_state *state, const char *option, const char *text, double most)
{
    char *end;
    size_t length = strspn(text, "0123456789.eE-");
    double value = strtod(text, &end);
    if (length == 0 || end != text + length || *end != '\0' || !(value > 0 && value < most)) {
        argp_error(state, "--%s takes a number above 0 and below %g, not '%s'", option, most, text);
    }
    return value;
}

/* Pictures are PNG; standard output and devices take any bytes. */
static void check_picture_name(struct argp_state *state, const char *option, const char *path)
{
    if (path != NULL && !standard_output_is(path) && file_kind_named(path) != FILE_PICTURE &&
        strncmp(path, "/dev/", 5) != 0) {
        argp_error(state, "%s %s: pictures are written as .png", option, path);
    }
}

static void check_options(struct argp_state *state, const render_options *o)
{
    int lenses = o->has_view + (o->pose != NULL) + o->has_fov;
    if (o->scene == NULL) {
        argp_error(state, "SCENE is missing");
    } else if (o->output == NULL) {
        argp_error(state, "-o view.png is missing");
    } else if (o->has_view != (o->recording != NULL)) {
        argp_error(state, "REC.mcap and --view N go together");
    } else if (o->orbit > 0 && o->trajectory != NULL) {
        argp_error(state, "--orbit and --trajectory exclude each other");
    } else if (o->orbit == 0 && o->arc > 0) {
        argp_error(state, "--arc belongs to --orbit");
    } else if (o->orbit == 0 && o->up != T3R_UP_UNKNOWN) {
        argp_error(state, "--up belongs to --orbit");
    } else if (lenses > 1 || (lenses == 0 && o->orbit == 0)) {
        argp_error(state, "%s: give one of REC.mcap --view N, --pose FILE, --fov DEGREES, or --orbit N",
                   lenses == 0 ? "no viewpoint" : "more than one viewpoint");
    } else if (o->has_fov && o->orbit == 0 && (o->trajectory == NULL || !o->has_size)) {
        argp_error(state, "--fov goes with --orbit, or with --trajectory and --size");
    } else if (o->rate > 0 && !video_is_named(o->output)) {
        argp_error(state, "--rate belongs to a video");
    }
    if (!video_is_named(o->output)) {
        check_picture_name(state, "-o", o->output);
    }
    check_picture_name(state, "--depth", o->depth);
    check_picture_name(state, "--alpha", o->alpha);
}

static error_t parse(int key, char *arg, struct argp_state *state)
{
    render_options *o = state->input;
    switch (key) {
    case ARGP_KEY_INIT:
        state->child_inputs[0] = &o->settings.processor;
        state->child_inputs[1] = &o->settings.scene_flags;
        return 0;
    case KEY_VIEW:
        o->view = option_number(state, "view", arg, 0, UINT32_MAX);
        o->has_view = true;
        return 0;
    case KEY_FOV:
        o->fov_degrees = parse_positive(state, "fov", arg, 180);
        o->has_fov = true;
        return 0;
    case KEY_SIZE:
        option_size(state, "size", arg, 1, &o->width, &o->height);
        o->has_size = true;
        return 0;
    case KEY_ORBIT:
        o->orbit = option_number(state, "orbit", arg, 1, 100000);
        return 0;
    case KEY_ARC:
        o->arc = parse_positive(state, "arc", arg, 360);
        return 0;
    case KEY_UP:
        o->up = scene_up_option(state, arg);
        return 0;
    case KEY_RATE:
        o->rate = parse_positive(state, "rate", arg, 1000);
        return 0;
    case 'o':
        o->output = arg;
        return 0;
    case KEY_DEPTH_UNIT:
        o->depth_unit = parse_positive(state, "depth-unit", arg, 1e6);
        return 0;
    case KEY_ARENA:
        reconstruction_parse_arena(state, arg, &o->settings);
        return 0;
    case KEY_MAX_MS:
        o->most_ms = parse_positive(state, "max-ms", arg, 1e9);
        return 0;
    case KEY_TILE_SPLATS:
        o->settings.config.tile_splats = option_number(state, "tile-splats", arg, 0, T3R_MAX_GAUSSIANS);
        return 0;
    case ARGP_KEY_ARG:
        option_argument(state, arg, (const char **[]){&o->scene, &o->recording}, 2);
        return 0;
    case ARGP_KEY_END:
        check_options(state, o);
        return 0;
    default:
        return option_field(key, arg, state);
    }
}

static const struct argp_child children[] = {{.argp = &processor_argp}, {.argp = &scene_input_argp}, {0}};
static const struct argp argp = {
    .options = options,
    .parser = parse,
    .args_doc = "SCENE.ply [REC.mcap]",
    .doc =
        "Draw a scene."
        "\vExamples:\n"
        "  trim3r render scene.ply room.mcap --view 1 -o view.png\n"
        "  trim3r render scene.ply --pose pose.json --depth depth.png -o view.png\n"
        "  trim3r render scene.ply --trajectory t.txt --fov 60 --size 640x480 -o v.png\n"
        "  trim3r render scene.ply --orbit 120 -o turn.mp4\n"
        "  trim3r render scene.ply room.mcap --view 1 --orbit 36 -o turn.png\n"
        "  trim3r render scene.ply room.mcap --view 1 --orbit 9 --arc 10 -o near.png\n"
        "  trim3r render splat.ply --path camera_path.json -o path.mp4\n\n"
        "A pose file holds the fields of one frame of transforms.json, or is a transforms.json:\n"
        "  {\"fl_x\": 220, \"fl_y\": 220, \"cx\": 128, \"cy\": 128, \"w\": 256, \"h\": 256,\n"
        "   \"transform_matrix\": [[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]}\n"
        "transform_matrix: camera to world, x right, y up, z backward; cx, cy from the picture's corner; "
        "fl_y, cx and cy may be left out; Blender's camera_angle_x may stand for fl_x, and --size for w and h. The "
        "file may also be a camera path of nerfstudio, with render_width and camera_path, or cameras.json of 3D "
        "Gaussian Splatting. Several poses give view_0000.png, view_0001.png ...\n"
        "A trajectory has lines of TUM, `stamp tx ty tz qx qy qz qw`, or of EuRoC: camera to world, x right, y down, "
        "z forward. Poses that cannot be used are left out, counted and named.",
    .children = children,
};

/* ---- pictures ---------------------------------------------------------------------------------------------------- */

/* Writes "dir/view_0007.png" for "dir/view.png" with index 7 of several. */
static int numbered_path(const char *path, uint32_t index, uint32_t count, char out[MAX_PATH_BYTES])
{
    const char *slash = strrchr(path, '/');
    const char *dot = strrchr(path, '.');
    size_t stem = dot != NULL && (slash == NULL || dot > slash) ? (size_t)(dot - path) : strlen(path);
    int length = count == 1
                     ? snprintf(out, MAX_PATH_BYTES, "%s", path)
                     : snprintf(out, MAX_PATH_BYTES, "%.*s_%04" PRIu32 "%s", (int)stem, path, index, path + stem);
    return length >= 0 && length < MAX_PATH_BYTES ? 0 : -1;
}

static int write_picture(const char *path, uint32_t index, uint32_t count, const picture *p)
{
    char name[MAX_PATH_BYTES], error[ERROR_BYTES] = "";
    if (numbered_path(path, index, count, name) != 0) {
        return cli_error(CLI_BAD_INPUT, "%s: the path is too long", path);
    }
    return picture_write_png(name, p, error, sizeof error) == 0 ? CLI_OK : cli_error(CLI_BAD_INPUT, "%s", error);
}

/* Converts depths of a picture to steps of the depth picture. A depth of more steps than 16 bits hold, or of less than
 * half a step, becomes 0, none, with a warning. */
static void convert_depth(const char *path, const reconstruction *r, const uint32_t *depth_q20, size_t count,
                          double unit, uint16_t *out)
{
    uint32_t far = 0, near = 0;
    for (size_t i = 0; i < count; i++) {
        const double value = nearbyint(reconstruction_depth(r, depth_q20[i]) / unit);
        out[i] = value > UINT16_MAX ? 0 : (uint16_t)value;
        far += value > UINT16_MAX;
        near += depth_q20[i] != 0 && value < 1;
    }
    if (far > 0) {
        (void)cli_error(CLI_OK,
                        "warning: %s: %" PRIu32 " pixels are farther than 65535 steps of %g, and 0: raise --depth-unit",
                        path, far, unit);
    }
    if (near > 0) {
        (void)cli_error(CLI_OK,
                        "warning: %s: %" PRIu32 " pixels are nearer than half a step of %g, and 0: lower --depth-unit",
                        path, near, unit);
    }
}

static bool shows_nothing(const uint16_t *alpha_q15, size_t count)
{
    size_t i = 0;
    while (i < count && alpha_q15[i] == 0) {
        i++;
    }
    return i == count;
}

typedef struct planes {
    uint8_t *rgb;
    uint32_t *depth_q20;
    uint16_t *alpha_q15;
    uint16_t *grey;
} planes;

/* Writes a picture of the colour, or adds it to the video. */
static int write_colour(const render_options *o, const t3r_camera *view, uint32_t index, uint32_t count,
                        const planes *p, video *film)
{
    if (film->pictures == NULL) {
        const picture colour = {
            .width = view->width, .height = view->height, .channels = 3, .bits = 8, .samples = p->rgb};
        return write_picture(o->output, index, count, &colour);
    }
    return video_add(film, p->rgb) == 0 ? CLI_OK : cli_error(CLI_BAD_INPUT, "%s: ffmpeg takes no more", o->output);
}

static int render_one(const render_options *o, reconstruction *r, const t3r_camera *view, uint32_t index,
                      uint32_t count, const planes *p, video *film, uint64_t *hash, work_times *times)
{
    size_t pixels = (size_t)view->width * view->height;
    t3r_target target = {
        .width = view->width,
        .height = view->height,
        .rgb = p->rgb,
        .rgb_stride_bytes = view->width * 3,
        .depth_q20 = o->depth != NULL ? p->depth_q20 : NULL,
        .depth_stride_bytes = view->width * 4,
        .alpha_q15 = p->alpha_q15,
        .alpha_stride_bytes = view->width * 2,
    };
    r->give_up_at = o->most_ms > 0 ? cli_now() + o->most_ms / 1e3 : 0;
    work_times_pass(times);
    int code = reconstruction_look_from(r, view, view->width, view->height);
    if (code != CLI_OK) {
        return code;
    }
    t3r_status status = t3r_render(r->runtime, view, &target);
    work_times_end(times, WORK_DRAW);
    if (status == T3R_ERR_CANCELLED) {
        return cli_error(CLI_BAD_INPUT, "view %" PRIu32 " takes longer than %g ms (--max-ms, --tile-splats)", index,
                         o->most_ms);
    }
    if (status != T3R_OK) {
        const char *const from[] = {o->pose, o->trajectory, o->recording, o->scene};
        uint32_t named = 0;
        while (from[named] == NULL) {
            named++;
        }
        return reconstruction_render_error(status, from[named], r->runtime, view, &target);
    }
    if (shows_nothing(p->alpha_q15, pixels)) {
        (void)cli_error(CLI_OK,
                        "warning: view %" PRIu32 " shows nothing of the scene: no Gaussian is in front of it, from a "
                        "distance of %g on",
                        index, ldexp(T3R_NEAR_Q20, r->scene.frame.exponent - 20));
    }
    *hash = t3r_hash_bytes(*hash, p->rgb, pixels * 3);
    code = write_colour(o, view, index, count, p, film);
    picture grey = {.width = view->width, .height = view->height, .channels = 1, .bits = 16, .samples = p->grey};
    if (code == CLI_OK && o->depth != NULL) {
        convert_depth(o->depth, r, p->depth_q20, pixels, o->depth_unit, p->grey);
        code = write_picture(o->depth, index, count, &grey);
    }
    if (code == CLI_OK && o->alpha != NULL) {
        for (size_t i = 0; i < pixels; i++) {
            p->grey[i] = (uint16_t)(((uint32_t)p->alpha_q15[i] * 65535 + 16383) / 32767);
        }
        code = write_picture(o->alpha, index, count, &grey);
    }
    work_times_end(times, WORK_WRITE);
    return code;
}

/* Opens the video, if -o is one. */
static int open_film(const render_options *o, const viewpoint_list *views, video *film)
{
    char error[ERROR_BYTES] = "";
    const t3r_camera *first = &views->items[0];
    *film = (video){0};
    if (!video_is_named(o->output)) {
        return CLI_OK;
    }
    for (uint32_t i = 1; i < views->count; i++) {
        if (views->items[i].width != first->width || views->items[i].height != first->height) {
            return cli_error(CLI_BAD_USAGE, "%s: views 0 and %" PRIu32 " differ in size: give --size", o->output, i);
        }
    }
    const double rate = o->rate > 0 ? o->rate : views->rate > 0 ? views->rate : RENDER_RATE;
    return video_begin(film, o->output, first->width, first->height, rate, error, sizeof error) == 0
               ? CLI_OK
               : cli_error(CLI_BAD_INPUT, "%s", error);
}

static int close_film(video *film, int code)
{
    char error[ERROR_BYTES] = "";
    return video_end(film, code == CLI_OK, error, sizeof error) == 0 ? code : cli_error(CLI_BAD_INPUT, "%s", error);
}

static int render_all(const render_options *o, scene_file *scene, const viewpoint_list *views, work_times *times)
{
    uint32_t width = 1, height = 1;
    size_t pixels = 1;
    for (uint32_t i = 0; i < views->count; i++) {
        const t3r_camera *v = &views->items[i];
        width = v->width > width ? v->width : width;
        height = v->height > height ? v->height : height;
        size_t area = (size_t)v->width * v->height;
        pixels = area > pixels ? area : pixels;
    }
    if (views->count > 1 && standard_output_is(o->output)) {
        return cli_error(CLI_BAD_USAGE, "-o -: %" PRIu32 " views are numbered files, and need a name", views->count);
    }
    reconstruction r;
    int code = reconstruction_load(&r, scene, width, height, &o->settings);
    if (code != CLI_OK) {
        return code;
    }
    planes p = {malloc(pixels * 3), malloc(pixels * 4), malloc(pixels * 2), malloc(pixels * 2)};
    uint64_t hash = T3R_HASH_START;
    if (p.rgb == NULL || p.depth_q20 == NULL || p.alpha_q15 == NULL || p.grey == NULL) {
        code = cli_error(CLI_BAD_INPUT, "out of memory");
    }
    video film = {0};
    code = code == CLI_OK ? open_film(o, views, &film) : code;
    for (uint32_t i = 0; i < views->count && code == CLI_OK; i++) {
        cli_progress("rendering", i, views->count);
        code = render_one(o, &r, &views->items[i], i, views->count, &p, &film, &hash, times);
    }
    code = close_film(&film, code);
    times->seconds[WORK_DRAW] /= views->count;
    times->seconds[WORK_WRITE] /= views->count;
    cli_progress_end();
    if (code == CLI_OK && o->json) {
        cJSON *root = cJSON_CreateObject();
        cJSON_AddStringToObject(root, "view", o->output);
        json_add_integer(root, "views", views->count);
        json_add_integer(root, "poses_left_out", (int64_t)views->losses.count);
        json_add_integer(root, "width", views->items[0].width);
        json_add_integer(root, "height", views->items[0].height);
        json_add_integer(root, "gaussians", r.scene.count);
        json_add_integer(root, "arena_bytes", (int64_t)r.arena_bytes);
        json_add_integer(root, "passes", t3r_render_passes(r.runtime));
        work_times_add_json(root, times);
        json_add_hash(root, "hash", hash);
        json_print(root);
    } else if (code == CLI_OK) {
        char text[WORK_TIMES_BYTES];
        printf("%s: %" PRIu32 " view%s of %" PRIu32 " Gaussians, %" PRIu32 " pass%s\n%s%s\n", o->output, views->count,
               views->count == 1 ? "" : "s", r.scene.count, t3r_render_passes(r.runtime),
               t3r_render_passes(r.runtime) == 1 ? "" : "es", work_times_text(times, text),
               views->count == 1 ? "" : " a view");
    }
    free(p.grey);
    free(p.alpha_q15);
    free(p.depth_q20);
    free(p.rgb);
    reconstruction_close(&r);
    return code;
}

int command_render(int argc, char **argv)
{
    render_options o = {.depth_unit = 0.001};
    reconstruction_defaults(&o.settings);
    file_options_parse(&argp, argc, argv, &o);

    char error[ERROR_BYTES] = "";
    viewpoint_list views = {0};
    scene_file scene = {0};
    work_times times;
    work_times_begin(&times);
    int code = scene_file_read(o.scene, o.settings.scene_flags, &scene, error, sizeof error) == 0
                   ? render_views(&o, &scene, &views)
                   : cli_error(CLI_BAD_INPUT, "%s", error);
    work_times_end(&times, WORK_READ);
    if (code == CLI_OK) {
        code = render_all(&o, &scene, &views, &times);
    }
    scene_file_free(&scene);
    viewpoint_list_free(&views);
    return code;
}
