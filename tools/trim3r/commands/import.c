/* SPDX-License-Identifier: Apache-2.0 */
/* trim3r import: a posed folder to a recording. */
#include "trim3r/commands/import.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/cli.h"
#include "cli/files/whole_file.h"
#include "cli/options/file_options.h"
#include "cli/options/option_values.h"
#include "cli/tables/json_output.h"
#include "cli/text/wrapped.h"
#include "host/reason.h"
#include "import/bags/recording_import.h"
#include "import/estimation/poses.h"
#include "import/estimation/poses_output.h"
#include "import/folders/posed_folder.h"
#include "import/frames/folder_border.h"
#include "import/frames/frame.h"
#include "import/frames/left_out.h"
#include "import/frames/rejected.h"
#include "import/import_source.h"
#include "recording/recording.h"
#include "trim3r.h"
#include "trim3r/commands/commands.h"

#define ERROR_BYTES 1024

/* The data to write: the folder's frames and derived data. */
typedef struct material {
    posed_folder folder;
    pointmap_source pointmaps;
    picture_inner inner;    /* what is used of each picture; width 0: all of it */
    pose_account *accounts; /* a frame, when poses were estimated from pictures; else NULL */
} material;

typedef struct totals {
    uint32_t width, height; /* of every frame */
    uint32_t depth_frames, unposed;
    uint64_t bytes;
} totals;

enum { KEY_INTRINSICS = 0x100, KEY_POSES, KEY_CONFIDENCE, KEY_UNIT };

static void check_options(struct argp_state *state, const import_options *o)
{
    if (o->directory == NULL) {
        argp_error(state, "DIR is missing");
    }
    if (o->output == NULL) {
        argp_error(state, "-o REC.mcap is missing");
    }
}

static error_t parse_option(int key, char *argument, struct argp_state *state)
{
    import_options *o = state->input;
    switch (key) {
    case ARGP_KEY_INIT:
        state->child_inputs[0] = &o->bag;
        state->child_inputs[1] = &o->stored;
        return 0;
    case 's':
        option_size(state, "size", argument, T3R_MIN_SIDE, &o->width, &o->height);
        return 0;
    case KEY_INTRINSICS:
        o->intrinsics_count = intrinsics_of_text(argument, o->intrinsics);
        if (o->intrinsics_count == 0) {
            argp_error(state, "--intrinsics %s: not " INTRINSICS_FORM, argument);
        }
        return 0;
    case KEY_POSES:
        if (!poses_named(argument, &o->poses)) {
            argp_error(state, "--poses does not know '%s'; there are %s", argument, POSES_NAMES);
        }
        return 0;
    case KEY_CONFIDENCE:
        o->pointmaps.confidence_least = option_decimal(state, "min-confidence", argument, -1e30, 1e30);
        return 0;
    case KEY_UNIT:
        o->pointmaps.depth_unit = option_decimal(state, "depth-unit", argument, 0x1p-39, 0x1p6);
        return 0;
    case 'o':
        o->output = argument;
        return 0;
    case ARGP_KEY_ARG:
        option_argument(state, argument, (const char **[]){&o->directory}, 1);
        return 0;
    case ARGP_KEY_END:
        check_options(state, o);
        return 0;
    default:
        return option_field(key, argument, state);
    }
}

static const struct argp_option argp_options[] = {
    OPTION_ARGUMENTS("DIR", OPTION_READS | OPTION_FOLDER),
    {"output", 'o', "REC.mcap", OPTION_WRITES(FILE_RECORDING),
     "recording to write; it appears when it is whole (needed)", 0},
    {"size", 's', "WxH", 0,
     "size of the frames: each picture is cropped to the largest centred part of that aspect, then resized, colour by "
     "area average and depth by the pixel at the centre of each box (as the pictures are)",
     0},
    {"intrinsics", KEY_INTRINSICS, "LIST", 0,
     "colour camera of a TUM RGB-D folder, of a folder of pose texts, of pictures alone or of a bag: " INTRINSICS_FORM
     " in pixels, (0, 0) being the centre of the top-left pixel (known where the name of the folder has freiburg1, "
     "freiburg2 or freiburg3 in it; with --poses estimate that of EXIF, else an estimate)",
     0},
    {"poses", KEY_POSES, POSES_PLACEHOLDER, 0,
     "source of the poses: given (default), those of the folder; estimate, from features that frames share, with depth "
     "where two of them have it, or of all frames from pointmaps; estimate-colour, from colour alone, without "
     "pointmaps",
     0},
    {"pointmaps", OPTION_TO(import_options, pointmaps.file), "FILE.npz", OPTION_READS,
     "depth of all frames: one pointmap each, in the frames' order", 0},
    {"min-confidence", KEY_CONFIDENCE, "C", 0,
     "least confidence of a pointmap's point; points below it get no depth (all points are kept)", 0},
    {"depth-unit", KEY_UNIT, "U", 0,
     "length of one step of depth: of depth beside a model of COLMAP (needed), of depth in floats or in a bag (0.001), "
     "or of depth made from pointmaps "
     "(integer_depth_scale of the folder, else a power of two with which the median has 4096 to 8192 steps)",
     0},
    {"keep-border", OPTION_TO(import_options, keeps_border), NULL, 0,
     "keep a border of one colour that surrounds all pictures alike, as undistorted pictures have (it is left out)", 0},
    {"json", OPTION_TO(import_options, json), NULL, 0, "print one JSON object on stdout", 0},
    {0},
};

static const struct argp_child children[] = {{&bag_argp, 0, NULL, 0}, {&recording_argp, 0, NULL, 0}, {0}};

const struct argp import_argp = {
    .options = argp_options,
    .children = children,
    .parser = parse_option,
    .args_doc = "DIR\nBAG.mcap",
    .doc =
        "Turn a posed folder, or a bag of ROS 2, into a recording. A recording that was cut off is mended.\v"
        "DIR holds one of\n"
        "  transforms.json (instant-ngp, NeRFCapture, nerfstudio): camera_model OPENCV\n"
        "    or OPENCV_FISHEYE, depth_path with integer_depth_scale, depth_file_path\n"
        "    with depth_unit_scale_factor, trim3r_triplets\n"
        "  rgb.txt, groundtruth.txt and optionally depth.txt (TUM RGB-D); pictures\n"
        "    without a pose are left out\n"
        "  sparse/0 or sparse with a model of COLMAP, text or binary, and images; depth\n"
        "    with 16-bit PNG of their names, if --depth-unit is given, else\n"
        "    stereo/depth_maps as COLMAP's patch_match_stereo leaves them\n"
        "  metadata and rgbd, an unpacked .r3d of Record3D; depth must not be packed\n"
        "  metadata.json, rgb and depth, its export with EXR\n"
        "  pose, color, intrinsic and optionally depth (ScanNet): a text for each pose\n"
        "  frame-N.pose.txt, .color.png, .depth.png (7-Scenes, 3DMatch)\n"
        "  pictures alone, in the order of their names, with --poses estimate or\n"
        "    --pointmaps\n"
        "In all of them depth may be .exr in the place of .png: OpenEXR of one channel.\n"
        "Frames get stamps 1/30 s apart. Pictures that cannot be read are left out and named.\n"
        "\n"
        "A pointmap, as DUSt3R, MASt3R and VGGT make them, is a point for each pixel of a frame, in the first "
        "frame's camera, x right, y down, z forward. It is the file pointmap_path of a frame, or one of N in the "
        "file of --pointmaps. A .npz may hold\n"
        "  pts3d (or world_points, points, pointmap)   float32, H x W x 3\n"
        "  conf (or world_points_conf)                 H x W\n"
        "  poses, or extrinsic                         camera to points, 4x4;\n"
        "                                              its inverse, 3x4\n"
        "  intrinsics, or focals                       3x3, in pixels of the map\n"
        "A .npy holds the points alone, with confidence_path beside it. Cameras of a .npz win over those of the "
        "folder, and missing poses are taken from the points. Numbers that are not finite are refused. So are poses "
        "of which some are in the folder's world and others in that of the points.\n"
        "\n"
        "Estimated poses are rounded into the recording: what is made of it later is the same everywhere. A frame "
        "that cannot be posed is kept without a pose, and the reason is printed. With --poses estimate DIR may also be "
        "a bag or a recording.\n"
        "\n"
        "Of a bag (MCAP) the frames are written anew: compressed images (JPEG, PNG, compressedDepth) decoded, poses "
        "interpolated between two of their topic or composed of /tf and /tf_static, depth of another camera "
        "registered to colour. DIR may be a folder of rosbag2: the MCAP files that its metadata.yaml names, packed "
        "with "
        "zstd or not, are one recording. A recording that lost its end is read as far as it goes. Messages and frames "
        "that cannot be read are left out, counted and named. "
        "Topics that were not used are named with the reason.\n\n"
        "Examples:\n"
        "  trim3r import scene --size 256x256 -o scene.mcap\n"
        "  trim3r import rgbd_dataset_freiburg1_desk -o desk.mcap\n"
        "  trim3r import desk --intrinsics 525,525,319.5,239.5 -o desk.mcap\n"
        "  trim3r import photos --size 640x480 --poses estimate -o p.mcap\n"
        "  trim3r import photos --intrinsics 900,900,640,480 --poses estimate -o p.mcap\n"
        "  trim3r import photos --pointmaps dust3r.npz --min-confidence 3 -o p.mcap\n"
        "  trim3r import bag.mcap --fixed-frame map -o rec.mcap\n"
        "  trim3r import broken.mcap -o whole.mcap",
};

/* Returns the folder's own name, the recording's source. */
static char *source_name(const char *directory, const char *kind)
{
    char *full = realpath(directory, NULL);
    const char *slash = full == NULL ? NULL : strrchr(full, '/');
    const char *base = slash != NULL && slash[1] != '\0' ? slash + 1 : directory;
    size_t bytes = strlen(base) + strlen(kind) + 16;
    char *name = malloc(bytes);
    if (name != NULL) {
        snprintf(name, bytes, "%s (%s)", base, kind);
    }
    free(full);
    return name;
}

static int write_frame(t3r_recorder *recorder, const import_options *o, material *m, uint32_t index, totals *t,
                       char *error)
{
    const posed_frame *frame = &m->folder.frames[index];
    picture depth = {0};
    char reason[ERROR_BYTES];
    import_buffers buffers;
    t3r_recorded_frame recorded;
    if (m->pointmaps.count > 0 && pointmap_source_depth(&m->pointmaps, index, &depth, error, ERROR_BYTES) != 0) {
        return -1;
    }
    int status =
        import_frame(o->directory, frame, &depth, o->width, o->height, &buffers, &recorded, reason, sizeof reason);
    if (status != 0) {
        (void)t3r_reason(error, ERROR_BYTES, "%s: frame %u: %.700s", o->directory, index, reason);
    } else if (index > 0 && (recorded.width != t->width || recorded.height != t->height)) {
        status = t3r_reason(error, ERROR_BYTES, "%s: frame %u: %s: %ux%u pixels, but frame 0 has %ux%u; give --size",
                            o->directory, index, frame->image, recorded.width, recorded.height, t->width, t->height);
    } else {
        recorded.unposed = m->accounts != NULL && !frame->posed;
        t->unposed += recorded.unposed;
        recorded.stamp_ns = (int64_t)index * 1000000000 / 30;
        t->width = recorded.width;
        t->height = recorded.height;
        t->depth_frames += recorded.depth != NULL;
        if (t3r_recorder_frame(recorder, &recorded) != 0) {
            status = t3r_reason(error, ERROR_BYTES, "%s: frame %u cannot be written", o->output, index);
        }
    }
    import_buffers_free(&buffers);
    return status;
}

static int write_frames(t3r_recorder *recorder, FILE *stream, const import_options *o, material *m,
                        const t3r_recording_header *header, totals *t, char *error)
{
    const posed_folder *folder = &m->folder;
    if (t3r_recorder_begin(recorder, t3r_file_sink(stream), header) != 0) {
        return t3r_reason(error, ERROR_BYTES, "%s: cannot be written", o->output);
    }
    for (uint32_t i = 0; i < folder->frame_count; i++) {
        cli_progress("importing", i, folder->frame_count);
        const int status = write_frame(recorder, o, m, i, t, error);
        if (status != 0) {
            return status;
        }
    }
    if (t3r_recorder_end(recorder) != 0) {
        return t3r_reason(error, ERROR_BYTES, "%s: cannot be written", o->output);
    }
    return 0;
}

static int write_recording(const import_options *o, material *m, totals *t, char *error)
{
    t3r_whole_file file;
    char *source = source_name(o->directory, m->folder.kind);
    t3r_recorder *recorder = malloc(t3r_recorder_bytes());
    t3r_recording_header header = {.camera = "camera",
                                   .source = source,
                                   .clock = "synthetic",
                                   .depth_unit = m->folder.depth_unit,
                                   .triplets = m->folder.triplets,
                                   .triplet_count = m->folder.triplet_count};
    int status = -1;
    if (source == NULL || recorder == NULL || recording_options_apply(&o->stored, &header) != 0) {
        t3r_reason(error, ERROR_BYTES, "out of memory");
    } else if (whole_file_begin(&file, o->output, error, ERROR_BYTES) == 0) {
        status = write_frames(recorder, file.stream, o, m, &header, t, error);
        if (status == 0) {
            status = t3r_whole_file_commit(&file, &t->bytes, error, ERROR_BYTES);
        } else {
            t3r_whole_file_abandon(&file);
        }
    }
    t3r_chunk_packer_close(header.packer);
    free(recorder);
    free(source);
    return status;
}

static void print_json(const material *m, const totals *t)
{
    const posed_folder *folder = &m->folder;
    cJSON *json = cJSON_CreateObject();
    cJSON_AddNumberToObject(json, "frames", folder->frame_count);
    cJSON_AddNumberToObject(json, "depth_frames", t->depth_frames);
    cJSON_AddNumberToObject(json, "posed_frames", folder->frame_count - t->unposed);
    cJSON_AddNumberToObject(json, "triplets", folder->triplet_count);
    cJSON_AddNumberToObject(json, "width", t->width);
    cJSON_AddNumberToObject(json, "height", t->height);
    json_add_integer(json, "bytes", (int64_t)t->bytes);
    if (folder->focal[0] != '\0') {
        cJSON_AddStringToObject(json, "focal_length", folder->focal);
    }
    picture_border_add_json(&m->inner, json);
    left_out_add_json(&folder->left_out, json);
    text_list_add_json(&folder->remarks, json, "remarks");
    if (m->pointmaps.count > 0) {
        cJSON_AddNumberToObject(json, "pointmaps", m->pointmaps.count);
        cJSON_AddNumberToObject(json, "depth_unit", folder->depth_unit);
        cJSON_AddNumberToObject(json, "resection_pixels", m->pointmaps.worst_px);
    }
    cJSON *poses = m->accounts != NULL ? cJSON_AddArrayToObject(json, "poses") : NULL;
    for (uint32_t i = 0; poses != NULL && i < folder->frame_count; i++) {
        cJSON_AddItemToArray(poses, pose_account_json(NULL, i, m->accounts));
    }
    json_print(json);
}

static void print_text(const import_options *o, const material *m, const totals *t)
{
    const posed_folder *folder = &m->folder;
    wrapped_printf(2, o->output, ": %u frames of %ux%u (%u with depth), %u triplets, %llu bytes", folder->frame_count,
                   t->width, t->height, t->depth_frames, folder->triplet_count, (unsigned long long)t->bytes);
    if (t->unposed > 0) {
        printf("without a pose: %u frames\n", t->unposed);
    }
    if (folder->focal[0] != '\0') {
        wrapped_printf(2, "focal length: ", "%s", folder->focal);
    }
    picture_border_print(&m->inner);
    left_out_print(&folder->left_out);
    text_list_print(&folder->remarks, "remark");
    if (m->pointmaps.count > 0) {
        printf("pointmaps: %u, depth in steps of %g", m->pointmaps.count, folder->depth_unit);
        if (m->pointmaps.worst_px > 0) {
            printf("; poses from points, %.2f pixels off", m->pointmaps.worst_px);
        }
        putchar('\n');
    }
    if (m->accounts != NULL) {
        poses_print(NULL, folder->frame_count, m->accounts);
    }
}

/* Reads the folder's lists, then applies the options: pointmaps, poses. */
static int prepare(const import_options *o, material *m, char *error)
{
    bool estimate = o->poses != POSES_GIVEN;
    posed_folder_options how = {.intrinsics = o->intrinsics_count != 0 ? o->intrinsics : NULL,
                                .depth_unit = o->pointmaps.depth_unit,
                                .without_poses = estimate || o->pointmaps.file != NULL,
                                .without_intrinsics = estimate || o->pointmaps.file != NULL};
    if (posed_folder_open(o->directory, &how, &m->folder, error, ERROR_BYTES) != 0) {
        return -1;
    }
    bool maps = o->pointmaps.file != NULL, depth = false;
    for (uint32_t i = 0; i < m->folder.frame_count; i++) {
        maps = maps || m->folder.frames[i].pointmap != NULL;
        depth = depth || m->folder.frames[i].depth != NULL;
    }
    if (maps && o->poses == POSES_ESTIMATE_COLOUR) {
        return t3r_reason(error, ERROR_BYTES,
                          "%s: --poses estimate-colour does not go with pointmaps; estimate takes poses from them",
                          o->directory);
    }
    if (maps) {
        pointmap_options points = o->pointmaps;
        points.resect = estimate;
        return pointmap_source_open(&m->pointmaps, o->directory, &points, &m->folder, error, ERROR_BYTES);
    }
    if (o->pointmaps.confidence_least != -HUGE_VAL) {
        return t3r_reason(error, ERROR_BYTES, "%s: --min-confidence is for pointmaps, but no frame has one",
                          o->directory);
    }
    if (o->pointmaps.depth_unit != 0 && !(depth && o->pointmaps.depth_unit == m->folder.depth_unit)) {
        return t3r_reason(error, ERROR_BYTES,
                          "%s: --depth-unit is for pointmaps and for depth whose unit the folder does not give",
                          o->directory);
    }
    return 0;
}

/* Poses, where they are to be estimated, and the recording: a status of import_frame(). */
static int make(const import_options *o, material *m, totals *t, char *error)
{
    char reason[ERROR_BYTES - 300];
    *t = (totals){0};
    if (o->poses != POSES_GIVEN && m->pointmaps.count == 0) {
        free(m->accounts);
        m->accounts = calloc(m->folder.frame_count, sizeof *m->accounts);
        if (m->accounts == NULL) {
            return t3r_reason(error, ERROR_BYTES, "out of memory");
        }
        const int status = import_estimate_poses(o->directory, &m->folder, o->width, o->height, o->poses, m->accounts,
                                                 reason, sizeof reason);
        if (status != 0) {
            (void)t3r_reason(error, ERROR_BYTES, "%s: %s", o->directory, reason);
            return status;
        }
    }
    return write_recording(o, m, t, error);
}

/* Refuses what --strict refuses. */
static int check_strict(const import_options *o, const material *m, char *error)
{
    char reason[ERROR_BYTES - 300];
    return !o->bag.topics.strict || left_out_refuse(&m->folder.left_out, reason, sizeof reason) == 0
               ? 0
               : t3r_reason(error, ERROR_BYTES, "%s: %s", o->directory, reason);
}

/* The same without frames that cannot be used, where there are such. Pointmaps go with all pictures. */
static int make_of_what_can_be_used(const import_options *o, material *m, totals *t, char *error)
{
    char reason[ERROR_BYTES - 300];
    const int status = check_strict(o, m, error) == 0 ? make(o, m, t, error) : -1;
    if (status <= 0 || m->pointmaps.count > 0) {
        return status;
    }
    if (rejected_find(o->directory, &m->folder, o->width, o->height, reason, sizeof reason) != 0) {
        return t3r_reason(error, ERROR_BYTES, "%s: %s", o->directory, reason);
    }
    return check_strict(o, m, error) == 0 ? make(o, m, t, error) : -1;
}

/* ---- a recording or a bag --------------------------------------------------------------------------------------- */

/* Makes the lens of --intrinsics for all colour images. Returns 0, or -1 with a reason. */
static int given_lens(const import_options *o, t3r_camera *camera, char *error)
{
    const double *n = o->intrinsics;
    const t3r_recorded_camera given = {
        .fx = n[0],
        .fy = n[1],
        .cx = n[2],
        .cy = n[3],
        .distortion = o->intrinsics_count > 4 ? T3R_DISTORTION_RADTAN : T3R_DISTORTION_NONE,
        .coefficients = {n[4], n[5], n[6], n[7], n[8]},
        .rotation = {1, 0, 0, 0},
    };
    const char *wrong = o->intrinsics_count == INTRINSICS_NUMBERS
                            ? "k4, k5 and k6 of a bag are read from its CameraInfo alone"
                            : t3r_fixed_camera(&given, camera);
    return wrong == NULL ? 0 : t3r_reason(error, ERROR_BYTES, "--intrinsics: %s", wrong);
}

static int import_recording(const import_options *o)
{
    if (o->pointmaps.file != NULL || o->pointmaps.confidence_least != -HUGE_VAL) {
        return cli_error(CLI_BAD_USAGE, "%s is a recording: pointmaps belong to folders", o->directory);
    }
    char error[ERROR_BYTES];
    t3r_camera camera;
    uint64_t unit_q40 = 0;
    if (o->intrinsics_count != 0 && given_lens(o, &camera, error) != 0) {
        return cli_error(CLI_BAD_USAGE, "%s", error);
    }
    if (o->pointmaps.depth_unit != 0 && !t3r_fixed_depth_unit(o->pointmaps.depth_unit, &unit_q40)) {
        return cli_error(CLI_BAD_USAGE, "--depth-unit %g is out of range", o->pointmaps.depth_unit);
    }
    char *source = source_name(o->directory, "recording");
    if (source == NULL) {
        return cli_error(CLI_BAD_INPUT, "out of memory");
    }
    int code = recording_import(&(recording_import_request){.input = o->directory,
                                                            .output = o->output,
                                                            .source = source,
                                                            .width = o->width,
                                                            .height = o->height,
                                                            .poses = o->poses,
                                                            .intrinsics = o->intrinsics_count != 0 ? &camera : NULL,
                                                            .depth_unit_q40 = unit_q40,
                                                            .bag = &o->bag,
                                                            .stored = &o->stored,
                                                            .json = o->json,
                                                            .keeps_border = o->keeps_border,
                                                            .quiet = o->after != NULL});
    if (code == CLI_OK && o->after != NULL) {
        o->after(o->user, NULL, NULL);
    }
    free(source);
    return code;
}

static int import_folder(const import_options *o)
{
    if (o->bag.given != NULL) {
        return cli_error(CLI_BAD_USAGE, "%s is for bags and recordings, and %s is none", o->bag.given, o->directory);
    }
    material m = {0};
    totals t = {0};
    char error[ERROR_BYTES] = "";
    int status = prepare(o, &m, error);
    if (status == 0 && !o->keeps_border) {
        m.inner = folder_border_find(o->directory, &m.folder);
    }
    if (status == 0) {
        status = make_of_what_can_be_used(o, &m, &t, error);
    }
    cli_progress_end();
    if (status == 0 && t.depth_frames == 0) {
        (void)text_list_add(&m.folder.remarks, "no frame has depth: build and replay need --depth stereo");
    } else if (status == 0 && t.depth_frames < m.folder.frame_count) {
        (void)text_list_add(&m.folder.remarks, "%u of %u frames have no depth", m.folder.frame_count - t.depth_frames,
                            m.folder.frame_count);
    }
    if (status != 0) {
        status = cli_error(CLI_BAD_INPUT, "%s", error);
    } else if (o->after != NULL) {
        o->after(o->user, &m.folder, m.accounts);
    } else if (o->json) {
        print_json(&m, &t);
    } else {
        print_text(o, &m, &t);
    }
    free(m.accounts);
    pointmap_source_close(&m.pointmaps);
    posed_folder_close(&m.folder);
    return status;
}

void import_defaults(import_options *o)
{
    *o = (import_options){0};
    o->pointmaps.confidence_least = -HUGE_VAL;
}

int import_run(const import_options *o)
{
    const char *advice;
    switch (import_source_of(o->directory, &advice)) {
    case IMPORT_RECORDING:
        return import_recording(o);
    case IMPORT_FOREIGN:
        return cli_error(CLI_BAD_INPUT, "%s: %s", o->directory, advice);
    case IMPORT_FOLDER:
    default:
        return import_folder(o);
    }
}

int command_import(int argc, char **argv)
{
    import_options o;
    import_defaults(&o);
    file_options_parse(&import_argp, argc, argv, &o);
    return import_run(&o);
}
