/* SPDX-License-Identifier: Apache-2.0 */
/* trim3r build: frames of a recording to a scene file, or to the start of an outside optimiser. */
#include "trim3r/commands/build.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>

#include "cli/cli.h"
#include "cli/files/recorded_frame.h"
#include "cli/jobs/work_times.h"
#include "cli/options/file_options.h"
#include "cli/options/option_values.h"
#include "cli/tables/json_output.h"
#include "cli/text/style.h"
#include "import/estimation/poses_output.h"
#include "import/estimation/recording_poses.h"
#include "import/import_source.h"
#include "reconstruction/aligned_poses.h"
#include "reconstruction/colmap/colmap_start.h"
#include "reconstruction/context/context_frames.h"
#include "reconstruction/options/poses_option.h"
#include "reconstruction/options/settings.h"
#include "reconstruction/reconstruction.h"
#include "scene/scene_file.h"
#include "scene/scene_options.h"
#include "scene/tile_lists.h"
#include "trim3r/commands/commands.h"

#define ERROR_BYTES 512

enum { KEY_LOCAL = 0x1000, KEY_COMMENTS, KEY_UP };

static const struct argp_option options[] = {
    OPTION_ARGUMENTS("REC.mcap", OPTION_READS | OPTION_FOLDER),
    {"output", 'o', "SCENE.ply", OPTION_WRITES(FILE_SCENE) | OPTION_PIPE,
     "scene to write (needed, or --colmap); -: .ply to standard output", 0},
    {"colmap", OPTION_TO(build_options, colmap), "DIR", OPTION_WRITES(FILE_OTHER) | OPTION_FOLDER,
     "folder, new or empty, for the start of another optimiser: the context views, and the means and colours of the "
     "Gaussians, as a COLMAP model in text",
     0},
    {"prune", OPTION_TO(build_options, settings.points_of), "SCENE.ply", OPTION_READS,
     "scene, made elsewhere, to prune instead of building one: the recording gives its views, --context names the "
     "ones that it was made of; percents are of its Gaussians",
     0},
    {"local", KEY_LOCAL, NULL, 0,
     "write positions from the first context camera's centre instead of the world's origin", 0},
    {"up", KEY_UP, "AXIS", 0,
     "axis of the recording's world that points up, x, -x, y, -y, z or -z: the file is turned so that y does, for "
     "viewers that want it (not turned; .spz and .glb as for -y)",
     0},
    {"comments", KEY_COMMENTS, NULL, 0,
     "name bits epoch, scene frame and head in header comments (some readers fail on them)", 0},
    {"profile", OPTION_TO(build_options, profile), NULL, 0,
     "print the time of each stage: processor time of one thread, or with more of them elapsed time", 0},
    {"json", OPTION_TO(build_options, json), NULL, 0, "print one JSON object on stdout", 0},
    {0},
};

static error_t parse(int key, char *arg, struct argp_state *state)
{
    build_options *o = state->input;
    switch (key) {
    case ARGP_KEY_INIT:
        state->child_inputs[0] = &o->settings;
        state->child_inputs[1] = &o->settings.poses;
        state->child_inputs[2] = &o->settings.scene_flags;
        return 0;
    case 'o':
        o->output = arg;
        return 0;
    case KEY_LOCAL:
        o->flags |= T3R_SCENE_LOCAL;
        return 0;
    case KEY_UP:
        o->flags |= SCENE_FILE_UP * (int)scene_up_option(state, arg);
        return 0;
    case KEY_COMMENTS:
        o->flags |= T3R_SCENE_COMMENTS;
        return 0;
    case ARGP_KEY_ARG:
        option_argument(state, arg, (const char **[]){&o->recording}, 1);
        return 0;
    case ARGP_KEY_END:
        scene_output_option(state, "-o", o->output);
        if (o->recording == NULL) {
            argp_error(state, "REC.mcap is missing");
        } else if (o->output == NULL && o->colmap == NULL) {
            argp_error(state, "-o SCENE.ply is missing");
        } else if (o->settings.context_kind == CONTEXT_AUTO && o->settings.poses != POSES_GIVEN) {
            argp_error(state, "--context auto chooses by poses: first trim3r import %s --poses %s -o POSED.mcap",
                       o->recording, poses_name(o->settings.poses));
        } else if (o->settings.gaussians == 0 && o->settings.keep_percent <= 0 &&
                   !reconstruction_chooses(&o->settings)) {
            argp_error(state, "the budget is missing: --gaussians Z, --keep P%%, --auto or --min-psnr DB");
        }
        return 0;
    default:
        return option_field(key, arg, state);
    }
}

static const struct argp_child children[] = {
    {.argp = &reconstruction_argp}, {.argp = &poses_argp}, {.argp = &scene_input_argp}, {0}};
const struct argp build_argp = {
    .options = options,
    .parser = parse,
    .args_doc = "REC.mcap",
    .doc = "Make exactly Z Gaussians of a recording's context frames, or with --auto or --min-psnr as few as they need."
           "\vExamples:\n"
           "  trim3r build room.mcap --context 0,2 --keep 10% -o scene.ply\n"
           "  trim3r build room.mcap --context auto --gaussians 13107 -o scene.ply\n"
           "  trim3r build room.mcap --gaussians 13107 --head analytic -o scene.ply\n"
           "  trim3r build room.mcap --head tiny --refine 4 --fit-passes off -o s.ply\n"
           "  trim3r build room.mcap --keep 5% --allocate paper --arena min -o s.ply\n"
           "  trim3r build room.mcap --auto --max-loss 0.5 -o scene.ply\n"
           "  trim3r build room.mcap --min-psnr 28 -o scene.ply\n"
           "  trim3r build room.mcap --keep 5% --allocate given --importance dir -o s.ply\n"
           "  trim3r build room.mcap --prune theirs.ply --context 0,2 --keep 20% -o s.ply\n"
           "  trim3r build room.mcap --keep 10% --colmap start\n"
           "  trim3r build room.mcap --keep 10% --poses estimate -o scene.ply\n\n"
           "The scene stands in the recording's world frame unless --local is given.\n\n"
           "--prune: the means of the file's Gaussians, seen from each context view, are its depth. They are in the "
           "same world, and those of an opacity below 0.05 do not count. trim3r makes new Gaussians of points among "
           "them. The recording's own depth is ignored.\n"
           "\n"
           "--poses estimate: the first context view keeps its recorded pose, or is the origin. Each other view is "
           "joined to the best earlier one. With depth in both views, lengths come from the depth; from colour "
           "alone, the first two cameras are 1 apart, unless some depth gives their distance. Frames too unlike, a "
           "camera that only turned, and features on one plane are refused. `trim3r import --poses estimate` keeps "
           "the poses in the recording.\n"
           "\n"
           "--colmap: DIR/images/ holds the context views at the working size, undistorted. DIR/sparse/0/ holds "
           "cameras.txt, images.txt and points3D.txt, where 3D Gaussian Splatting (-s DIR) and gsplat (--data_dir "
           "DIR) look for them. InstantSplat's place for N views is DIR/sparse_N/0/. A point is observed in the "
           "view that it came from. With --head none --refine 0 the points are the retained pixels themselves, "
           "otherwise they are where the head and refinement put them.",
    .children = children,
};

/* Facts about the views that a scene was built from. */
typedef struct found {
    pose_account estimated[T3R_MAX_VIEWS]; /* of --poses, where it is not `given` */
    pose_correction aligned[T3R_MAX_VIEWS];
    tile_lists lists; /* of the view whose tiles list most */
} found;

/* Whether the last step was our refinement. */
static bool refines(const build_options *o)
{
    return o->settings.config.refine > 0 && o->settings.method->refines;
}

/* Adds the frames that stereo could match with no other. */
static void add_unmatched(cJSON *root, const build_options *o, const reconstruction_account *account,
                          const reconstruction *r)
{
    cJSON *list = o->settings.config.depth == T3R_DEPTH_STEREO ? cJSON_AddArrayToObject(root, "unmatched") : NULL;
    for (uint32_t v = 0; v < account->context_count && list != NULL; v++) {
        if (t3r_stereo_pair(r->runtime, v, NULL) != T3R_PAIR_OK) {
            cJSON_AddItemToArray(list, cJSON_CreateNumber(account->context[v]));
        }
    }
}

/* Adds how much --auto loses, and how often its bound held; null: the loss is predicted. */
static void add_loss(cJSON *root, const reconstruction_options *settings, const measured_loss *loss)
{
    cJSON_AddNumberToObject(root, "max_loss", settings->max_loss);
    if (loss->builds > 0) {
        cJSON_AddNumberToObject(root, "loss", loss->loss);
    } else {
        cJSON_AddNullToObject(root, "loss");
    }
    cJSON_AddNumberToObject(root, "held_percent", measured_loss_held(loss, settings->max_loss));
    json_add_integer(root, "builds", loss->builds);
}

static void print_json(const build_options *o, const reconstruction_account *account, const reconstruction *r,
                       const t3r_recording *recording, const found *f, const work_times *times)
{
    cJSON *root = cJSON_CreateObject();
    if (o->output != NULL) {
        cJSON_AddStringToObject(root, "scene", o->output);
    }
    if (o->colmap != NULL) {
        cJSON_AddStringToObject(root, "colmap", o->colmap);
    }
    cJSON_AddStringToObject(root, "method", o->settings.method->name);
    json_add_integer(root, "gaussians", r->scene.count);
    json_add_integer(root, "requested", account->requested);
    if (o->settings.automatic) {
        add_loss(root, &o->settings, &r->loss);
    }
    if (o->settings.min_psnr > 0) {
        cJSON_AddNumberToObject(root, "min_psnr", o->settings.min_psnr);
        cJSON_AddNumberToObject(root, "context_psnr", r->least.psnr_q8 / 256.0);
        json_add_integer(root, "builds", r->least.builds);
    }
    json_add_integer(root, "valid_points", account->valid_points);
    if (refines(o)) {
        json_add_integer(root, "passes", t3r_refinement_passes(r->runtime));
    }
    json_add_integers(root, "context", account->context, account->context_count);
    if (o->settings.points_of == NULL) {
        cJSON_AddStringToObject(root, "depth", t3r_depth_name(o->settings.config.depth));
        add_unmatched(root, o, account, r);
    }
    cJSON_AddNumberToObject(root, "width", account->width);
    cJSON_AddNumberToObject(root, "height", account->height);
    if (o->settings.method->allocates) {
        cJSON_AddStringToObject(root, "allocate", t3r_allocation_name(o->settings.config.allocate));
    }
    if (o->settings.points_of != NULL) {
        cJSON_AddStringToObject(root, "pruned", o->settings.points_of);
    }
    if (account->head[0] != '\0') {
        cJSON_AddStringToObject(root, "head", account->head);
    }
    if (account->bits[0] != '\0') {
        cJSON_AddStringToObject(root, "head_bits", account->bits);
        cJSON_AddStringToObject(root, "head_crc", account->crc);
    }
    settings_add_json(cJSON_AddObjectToObject(root, "settings"), &o->settings.config);
    json_add_integer(root, "arena_bytes", (int64_t)account->arena_bytes);
    work_times_add_json(root, times);
    if (o->profile) {
        stage_times_add_json(root, "stages_ms", &r->stages);
    }
    cJSON *listed = cJSON_AddObjectToObject(root, "tile_lists");
    json_add_integer(listed, "entries", (int64_t)f->lists.entries);
    json_add_integer(listed, "usual", (int64_t)f->lists.usual);
    json_add_integer(listed, "widest", f->lists.widest);
    cJSON_AddNumberToObject(root, "bits_epoch", T3R_BITS_EPOCH);
    if (o->settings.poses != POSES_GIVEN) {
        poses_add_json(root, recording, account->context, account->context_count, f->estimated);
    }
    aligned_poses_add_json(root, account, f->aligned);
    /* where float32 positions lose the world's origin: --local and this */
    cJSON *origin = cJSON_AddArrayToObject(root, "origin");
    for (int i = 0; i < 3; i++) {
        cJSON_AddItemToArray(origin, cJSON_CreateNumber((double)r->scene.frame.origin_q32[i] / 4294967296.0));
    }
    cJSON_AddNumberToObject(root, "exponent", r->scene.frame.exponent);
    if (o->settings.method == &method_trim3r) { /* floats have no promise of identical bits */
        json_add_hash(root, "hash", reconstruction_hash(r));
    }
    json_print(root);
}

/* Writes "head small crc 1a2b3c4d"; "pruned" for a scene made elsewhere. */
static void note_head(const reconstruction_account *account, char *text, size_t bytes)
{
    int length = snprintf(text, bytes, account->head[0] != '\0' ? "head %s" : "pruned%s", account->head);
    if (account->crc[0] != '\0') {
        snprintf(text + length, bytes - (size_t)length, " crc %s", account->crc);
    }
}

static int write_all(const build_options *o, const t3r_recording *recording, const reconstruction *r,
                     const reconstruction_account *account, whole_folder *folder)
{
    char note[64], error[ERROR_BYTES] = "";
    note_head(account, note, sizeof note);
    if (o->output != NULL && scene_file_write(o->output, &r->scene, o->flags, note, error, sizeof error) != 0) {
        return cli_error(CLI_BAD_INPUT, "%s", error);
    }
    const colmap_start start = {
        .recording = recording,
        .path = o->recording,
        .scene = &r->scene,
        .account = account,
        .local = (o->flags & T3R_SCENE_LOCAL) != 0,
        .sourced = o->settings.points_of == NULL || o->settings.method->allocates,
    };
    return o->colmap != NULL ? colmap_start_write(&start, folder, o->colmap) : CLI_OK;
}

/* Computes the drawing cost of the context view whose tiles list most. */
static int account_for_lists(const build_options *o, const t3r_recording *recording, const t3r_scene *scene,
                             const reconstruction_account *account, tile_lists *most)
{
    *most = (tile_lists){0};
    for (uint32_t v = 0; v < account->context_count; v++) {
        t3r_capture_frame frame;
        const int code = recorded_frame_read(recording, o->recording, account->context[v], &frame);
        if (code != CLI_OK) {
            return code;
        }
        const t3r_camera camera = reconstruction_camera(&frame.camera, frame.frame.width, frame.frame.height,
                                                        account->width, account->height);
        tile_lists lists;
        if (!tile_lists_of(scene, &camera, account->width, account->height, o->settings.config.tile_splats, &lists)) {
            return cli_error(CLI_BAD_INPUT, "out of memory");
        }
        *most = lists.entries > most->entries ? lists : *most;
    }
    return CLI_OK;
}

static void print_lists(const tile_lists *lists)
{
    if (lists->entries > lists->usual) {
        printf("%swarning:%s the Gaussians are unusually wide, the widest %" PRIu32 " tiles: a view lists %" PRIu64
               " splats in its tiles, %" PRIu64 " are usual; it takes long to draw (--tile-splats)\n",
               style_begin(stdout, STYLE_WARNING), style_end(stdout), lists->widest, lists->entries, lists->usual);
    }
}

/* Prints how much --auto loses, and how often its bound held. */
static void print_loss(const reconstruction_options *settings, const measured_loss *loss)
{
    if (!settings->automatic) {
        return;
    }
    if (loss->builds > 0) {
        printf("new views lose %.2f dB against all points, as measured halfway between the context views in %" PRIu32
               " builds\n",
               loss->loss, loss->builds);
    } else {
        printf("no two context views share a surface to measure the loss on: it is predicted\n");
    }
    if (loss->loss > settings->max_loss) {
        printf("%swarning:%s that is more than --max-loss %g: the budget allows no more Gaussians\n",
               style_begin(stdout, STYLE_WARNING), style_end(stdout), settings->max_loss);
    } else {
        printf("on the training scenes %d %% of the new views stayed within the bound\n",
               measured_loss_held(loss, settings->max_loss));
    }
}

/* Prints how well the context views are drawn, for --min-psnr. */
static void print_least(const reconstruction_options *settings, const t3r_least *least)
{
    if (settings->min_psnr <= 0) {
        return;
    }
    printf("each context view is drawn at %.2f dB or more, in the last of %" PRIu32 " builds\n", least->psnr_q8 / 256.0,
           least->builds);
    if (least->psnr_q8 < settings->min_psnr * 256) {
        printf("%swarning:%s that is less than --min-psnr %g: it is the best of the numbers that were tried\n",
               style_begin(stdout, STYLE_WARNING), style_end(stdout), settings->min_psnr);
    }
}

static void print_text(const build_options *o, const reconstruction_account *account, const reconstruction *r,
                       const found *f, const work_times *times)
{
    char text[WORK_TIMES_BYTES];
    if (o->settings.poses != POSES_GIVEN) {
        poses_print(account->context, account->context_count, f->estimated);
    }
    aligned_poses_print(account, f->aligned);
    printf("%s: %" PRIu32 " Gaussians of %" PRIu32 " valid points, arena %zu bytes\n%s\n",
           o->output != NULL ? o->output : o->colmap, r->scene.count, account->valid_points, account->arena_bytes,
           work_times_text(times, text));
    if (refines(o) && o->settings.config.fit_passes) {
        const uint32_t passes = t3r_refinement_passes(r->runtime);
        printf("refined in %" PRIu32 " pass%s\n", passes, passes == 1 ? "" : "es");
    }
    print_loss(&o->settings, &r->loss);
    print_least(&o->settings, &r->least);
    for (uint32_t v = 0; v < account->context_count; v++) {
        uint32_t partner;
        t3r_pair pair = t3r_stereo_pair(r->runtime, v, &partner);
        if (pair != T3R_PAIR_OK) {
            printf("frame %" PRIu32 " has no depth; with frame %" PRIu32 ": %s\n", account->context[v],
                   account->context[partner], t3r_pair_text(pair));
        }
    }
    print_lists(&f->lists);
    if (o->profile) {
        stage_times_print(stdout, &r->stages);
    }
}

void build_defaults(build_options *o)
{
    *o = (build_options){0};
    reconstruction_defaults(&o->settings);
    o->settings.method = &method_trim3r;
}

int build_run(build_options *o)
{
    char error[ERROR_BYTES] = "";
    work_times times;
    work_times_begin(&times);
    t3r_recording *recording = import_source_open(o->recording);
    if (recording == NULL) {
        return CLI_BAD_INPUT;
    }
    work_times_end(&times, WORK_READ);
    int code = CLI_OK;
    whole_folder folder = {0};
    if (o->colmap != NULL && whole_folder_begin(&folder, o->colmap, error, sizeof error) != 0) {
        code = cli_error(CLI_BAD_INPUT, "%s", error);
    }
    found f = {0};
    code = code == CLI_OK ? context_resolve(&o->settings, recording, o->recording) : code;
    if (code == CLI_OK && o->settings.poses == POSES_GIVEN) {
        context_warn_of_strangers(recording, o->recording, &o->settings);
    } else if (code == CLI_OK) {
        code = recording_pose_views(recording, o->recording, o->settings.context, o->settings.context_count,
                                    o->settings.poses, f.estimated);
        work_times_end(&times, WORK_POSES);
    }
    reconstruction r;
    reconstruction_account account;
    method_source source = {0};
    if (code == CLI_OK) {
        code = o->settings.method->build(&source, recording, o->recording, &o->settings, &r, &account);
        method_source_close(&source);
    }
    if (code == CLI_OK) {
        reconstruction_warn_of_budget(&o->settings, account.requested, r.scene.count);
        times.seconds[WORK_BUILD] = account.seconds; /* without what was opened for it */
        work_times_pass(&times);
        code = write_all(o, recording, &r, &account, &folder);
        work_times_end(&times, WORK_WRITE);
        if (code == CLI_OK) {
            code = account_for_lists(o, recording, &r.scene, &account, &f.lists);
        }
        if (code == CLI_OK) {
            code = aligned_poses_of(recording, o->recording, &account, f.aligned);
        }
        if (code == CLI_OK && o->after != NULL) {
            code = o->after(o->user, recording, &r, &account);
        } else if (code == CLI_OK && o->json) {
            print_json(o, &account, &r, recording, &f, &times);
        } else if (code == CLI_OK) {
            print_text(o, &account, &r, &f, &times);
        }
        reconstruction_close(&r);
    }
    whole_folder_abandon(&folder); /* unless it was committed */
    t3r_recording_close(recording);
    return code;
}

int command_build(int argc, char **argv)
{
    build_options o;
    build_defaults(&o);
    file_options_parse(&build_argp, argc, argv, &o);
    return build_run(&o);
}
