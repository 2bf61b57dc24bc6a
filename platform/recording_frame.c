/* One frame of a recording: its messages checked, and their doubles turned into fixed point. */
#include "recording_index.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#include "bytes.h"
#include "fixed_camera.h"
#include "fixed_double.h"
#include "pixel_layout.h"
#include "reason.h"

/* Which frame is being read, and where its reasons go. */
typedef struct reading {
    const t3r_recording *recording;
    uint32_t index;
    char *error;
    size_t error_bytes;
} reading;

static int fail(const reading *r, const t3r_stream *stream, const t3r_indexed_message *message, const char *field,
                const char *what)
{
    char place[T3R_MCAP_PLACE_BYTES];
    return t3r_reason(r->error, r->error_bytes, "frame %" PRIu32 ", %.64s at %s: %s%s%s", r->index, stream->topic,
                      t3r_mcap_place_text(message->place, place), field, field[0] != '\0' ? " " : "", what);
}

/* ---- images ---- */

/* Rows of row_bytes at image->step must lie inside the data. NULL, or what is wrong. */
static const char *rows_error(const t3r_ros_image *image, uint32_t row_bytes, uint32_t rows)
{
    if (image->step < row_bytes) {
        return "step is less than a row's bytes";
    }
    return (uint64_t)image->step * rows > image->data_bytes ? "data hold fewer than step x rows bytes" : NULL;
}

/* A compressed image by the recording's decoder, whose sides are checked as those of others are. */
static int decode(const reading *r, const t3r_stream *stream, const t3r_indexed_message *message, bool depth,
                  t3r_decoded_image *out)
{
    const t3r_image_decoder *decoder = &r->recording->decoder;
    t3r_ros_compressed image;
    const char *wrong = t3r_ros_read_compressed(message->data, message->bytes, &image);
    char what[160];
    if (wrong == NULL && decoder->decode == NULL) {
        wrong = "compressed images are decoded by trim3r import";
    }
    if (wrong == NULL && decoder->decode(decoder->user, image.format, image.data, image.data_bytes, depth,
                                         r->recording->depth_unit_q40, out, what, sizeof what) != 0) {
        wrong = what;
    }
    if (wrong == NULL) {
        wrong = t3r_pixel_size_error(depth ? T3R_PIXEL_GREY : out->format, out->width, out->height);
    }
    return wrong == NULL ? 0 : fail(r, stream, message, "", wrong);
}

static int read_colour(const reading *r, t3r_frame *frame)
{
    const t3r_stream *stream = &r->recording->streams[r->recording->colour];
    const t3r_indexed_message *message = &stream->messages[r->index];
    if (stream->compressed) {
        t3r_decoded_image decoded;
        if (decode(r, stream, message, false, &decoded) != 0) {
            return -1;
        }
        frame->format = decoded.format;
        frame->width = decoded.width;
        frame->height = decoded.height;
        frame->planes[0] = decoded.rows;
        frame->stride_bytes[0] = t3r_pixel_row_bytes(decoded.format, decoded.width);
        return 0;
    }
    t3r_ros_image image;
    const char *wrong = t3r_ros_read_image(message->data, message->bytes, &image);
    if (wrong == NULL && !t3r_pixel_format_of(image.encoding, &frame->format)) {
        wrong = "encoding is none of rgb8, bgr8, mono8, yuv422_yuy2, yuv422, nv12";
    }
    if (wrong == NULL) {
        wrong = t3r_pixel_size_error(frame->format, image.width, image.height);
    }
    if (wrong == NULL) {
        uint32_t rows = image.height + t3r_pixel_rows(frame->format, 1, image.height);
        wrong = rows_error(&image, t3r_pixel_row_bytes(frame->format, image.width), rows);
    }
    if (wrong != NULL) {
        return fail(r, stream, message, "", wrong);
    }
    frame->width = image.width;
    frame->height = image.height;
    frame->planes[0] = image.data;
    frame->stride_bytes[0] = image.step;
    if (frame->format == T3R_PIXEL_NV12) {
        frame->planes[1] = image.data + (size_t)image.step * image.height;
        frame->stride_bytes[1] = image.step;
    }
    return 0;
}

/* Metres as a float's bits to steps of the unit: to Q40, then divided, both round-half-even. 0 = no measurement: NaN,
 * infinity, nothing, behind the camera, or more than 65535 steps. */
static uint16_t steps_of_metres(uint32_t bits, uint64_t unit_q40)
{
    int64_t depth_q40;
    if (t3r_fixed_from_float(bits, 40, &depth_q40) != 0 || depth_q40 <= 0) {
        return 0;
    }
    uint64_t steps = (uint64_t)depth_q40 / unit_q40, rest = (uint64_t)depth_q40 % unit_q40;
    steps += rest > unit_q40 - rest || (rest == unit_q40 - rest && (steps & 1) != 0);
    return steps <= UINT16_MAX ? (uint16_t)steps : 0;
}

static void to_z16(const t3r_ros_image *image, bool metres, uint64_t unit_q40, uint8_t *out)
{
    for (uint32_t y = 0; y < image->height; y++) {
        const uint8_t *row = image->data + (size_t)y * image->step;
        for (uint32_t x = 0; x < image->width; x++, out += 2) {
            if (metres) {
                const uint8_t *sample = row + (size_t)x * 4;
                uint32_t bits = image->is_bigendian ? t3r_load_be32(sample) : t3r_load_le32(sample);
                t3r_store_le16(out, steps_of_metres(bits, unit_q40));
            } else { /* big-endian samples */
                out[0] = row[(size_t)x * 2 + 1];
                out[1] = row[(size_t)x * 2];
            }
        }
    }
}

static int read_depth(const reading *r, size_t link, t3r_frame *frame)
{
    const t3r_stream *stream = &r->recording->streams[r->recording->depth];
    const t3r_indexed_message *message = &stream->messages[link];
    frame->depth_unit_q40 = r->recording->depth_unit_q40;
    if (stream->compressed) {
        t3r_decoded_image decoded;
        if (decode(r, stream, message, true, &decoded) != 0) {
            return -1;
        }
        frame->depth_width = decoded.width;
        frame->depth_height = decoded.height;
        frame->depth = decoded.rows;
        frame->depth_stride_bytes = decoded.width * 2;
        return 0;
    }
    t3r_ros_image image;
    const char *wrong = t3r_ros_read_image(message->data, message->bytes, &image);
    if (wrong != NULL) {
        return fail(r, stream, message, "", wrong);
    }
    bool metres = t3r_text_is(image.encoding, "32FC1");
    if (!metres && !t3r_text_is(image.encoding, "16UC1") && !t3r_text_is(image.encoding, "mono16")) {
        return fail(r, stream, message, "", "encoding is none of 16UC1, mono16, 32FC1");
    }
    if (image.width < 2 || image.height < 2 || image.width > T3R_MAX_SIDE || image.height > T3R_MAX_SIDE) {
        return fail(r, stream, message, "", "width or height is outside 2..4096");
    }
    wrong = rows_error(&image, image.width * (metres ? 4 : 2), image.height);
    if (wrong != NULL) {
        return fail(r, stream, message, "", wrong);
    }
    frame->depth_width = image.width;
    frame->depth_height = image.height;
    if (!metres && !image.is_bigendian) {
        frame->depth = image.data;
        frame->depth_stride_bytes = image.step;
        return 0;
    }
    uint8_t **z16 = &r->recording->depth_z16[link];
    if (*z16 == NULL) {
        *z16 = malloc((size_t)image.width * image.height * 2);
        if (*z16 == NULL) {
            return fail(r, stream, message, "", "out of memory");
        }
        to_z16(&image, metres, r->recording->depth_unit_q40, *z16);
    }
    frame->depth = *z16;
    frame->depth_stride_bytes = image.width * 2;
    return 0;
}

/* ---- the camera ---- */

static bool is_zero(uint64_t f64)
{
    return f64 << 1 == 0;
}

/* NULL, or what is wrong with D and distortion_model. */
static const char *read_distortion(const t3r_ros_camera_info *info, t3r_camera *camera)
{
    uint32_t used = 0; /* coefficients up to the last one that is not 0 */
    for (uint32_t i = 0; i < info->d_count; i++) {
        used = is_zero(info->d_f64[i]) ? used : i + 1;
    }
    bool fisheye = t3r_text_is(info->distortion_model, "equidistant");
    bool radtan =
        t3r_text_is(info->distortion_model, "plumb_bob") || t3r_text_is(info->distortion_model, "rational_polynomial");
    if (used == 0 && !fisheye) {
        camera->distortion = T3R_DISTORTION_NONE;
        return NULL;
    }
    if (!fisheye && !radtan) {
        return "distortion_model is none of plumb_bob, equidistant, rational_polynomial";
    }
    camera->distortion = fisheye ? T3R_DISTORTION_FISHEYE : T3R_DISTORTION_RADTAN;
    if (used > (fisheye ? 4 : 5)) {
        return fisheye ? "D has more than the 4 coefficients of equidistant"
                       : "D has terms beyond k1 k2 p1 p2 k3, which are not supported";
    }
    for (uint32_t i = 0; i < used; i++) {
        if (!t3r_fixed_coefficient(info->d_f64[i], camera->distortion, i, &camera->distortion_q24[i])) {
            return "D has a coefficient that is not a number within -128..128 (p1, p2: -16..16)";
        }
    }
    return NULL;
}

/* Binning and regions of interest would need K adapted; recordings of whole images have neither. */
static const char *window_error(const t3r_ros_camera_info *info)
{
    if (info->binning_x > 1 || info->binning_y > 1) {
        return "binning is not supported";
    }
    bool whole = info->roi_x == 0 && info->roi_y == 0 && (info->roi_width == 0 || info->roi_width == info->width) &&
                 (info->roi_height == 0 || info->roi_height == info->height);
    return whole ? NULL : "a region of interest is not supported";
}

static int read_intrinsics(const reading *r, size_t link, const t3r_frame *frame, t3r_camera *camera)
{
    static const struct {
        const char *name;
        uint32_t k;
        bool (*fixed)(uint64_t f64, int32_t *q16);
    } fields[4] = {{"K[0] (fx)", 0, t3r_fixed_focal},
                   {"K[4] (fy)", 4, t3r_fixed_focal},
                   {"K[2] (cx)", 2, t3r_fixed_centre},
                   {"K[5] (cy)", 5, t3r_fixed_centre}};
    const t3r_stream *stream = &r->recording->streams[r->recording->camera_info];
    const t3r_indexed_message *message = &stream->messages[link];
    t3r_ros_camera_info info;
    const char *wrong = t3r_ros_read_camera_info(message->data, message->bytes, &info);
    wrong = wrong != NULL ? wrong : window_error(&info);
    if (wrong != NULL) {
        return fail(r, stream, message, "", wrong);
    }
    if (info.width != frame->width || info.height != frame->height) {
        char what[96];
        t3r_reason(what, sizeof what,
                   "width x height is %" PRIu32 "x%" PRIu32 ", that of the image %" PRIu32 "x%" PRIu32, info.width,
                   info.height, frame->width, frame->height);
        return fail(r, stream, message, "", what);
    }
    if (!is_zero(info.k_f64[1]) || !is_zero(info.k_f64[3]) || !is_zero(info.k_f64[6]) || !is_zero(info.k_f64[7])) {
        return fail(r, stream, message, "", "K has a skew, or entries where a camera matrix has none");
    }
    int32_t *const out[4] = {&camera->fx_q16, &camera->fy_q16, &camera->cx_q16, &camera->cy_q16};
    for (uint32_t i = 0; i < 4; i++) {
        if (!fields[i].fixed(info.k_f64[fields[i].k], out[i])) {
            return fail(r, stream, message, fields[i].name,
                        i < 2 ? "is not a number in [8, 16384)" : "is not a number in (-16384, 16384)");
        }
    }
    wrong = read_distortion(&info, camera);
    return wrong == NULL ? 0 : fail(r, stream, message, "", wrong);
}

static int read_pose(const reading *r, size_t link, t3r_camera *camera)
{
    static const char *const positions[3] = {"position.x", "position.y", "position.z"};
    static const char *const rotations[4] = {"orientation.x", "orientation.y", "orientation.z", "orientation.w"};
    const t3r_stream *stream = &r->recording->streams[r->recording->pose];
    const t3r_indexed_message *message = &stream->messages[link];
    t3r_ros_pose pose;
    const char *wrong = t3r_ros_read_pose(stream->type, message->data, message->bytes, &pose);
    if (wrong != NULL) {
        return fail(r, stream, message, "", wrong);
    }
    for (uint32_t i = 0; i < 3; i++) {
        if (!t3r_fixed_position(pose.position_f64[i], &camera->position_q32[i])) {
            return fail(r, stream, message, positions[i], "is not a number within -2^30..2^30");
        }
    }
    for (uint32_t i = 0; i < 4; i++) {
        if (!t3r_fixed_rotation(pose.rotation_f64[i], &camera->rotation_q30[(i + 1) % 4])) {
            return fail(r, stream, message, rotations[i], "is not a number within -1.5..1.5");
        }
    }
    return 0;
}

int t3r_recording_frame(const t3r_recording *recording, uint32_t index, t3r_capture_frame *frame, char *error,
                        size_t error_bytes)
{
    if (index >= recording->pairing.frames) {
        t3r_reason(error, error_bytes, "frame %" PRIu32 ": the recording holds %" PRIu32, index,
                   recording->pairing.frames);
        return T3R_CAPTURE_FAILED;
    }
    const reading r = {recording, index, error, error_bytes};
    const t3r_frame_links *links = &recording->links[index];
    const t3r_set_pose *set =
        recording->set_poses != NULL && recording->set_poses[index].set ? &recording->set_poses[index] : NULL;
    t3r_capture_frame result = {
        .index = index,
        .sequence = index,
        .stamp_ns = recording->streams[recording->colour].messages[index].stamp_ns,
        .depth_stamp_ns = recording->streams[recording->colour].messages[index].stamp_ns,
        .has_pose = links->pose != T3R_NO_MESSAGE || set != NULL,
        .has_intrinsics = links->camera_info != T3R_NO_MESSAGE,
    };
    if (read_colour(&r, &result.frame) != 0 ||
        (links->depth != T3R_NO_MESSAGE && read_depth(&r, links->depth, &result.frame) != 0) ||
        (result.has_intrinsics && read_intrinsics(&r, links->camera_info, &result.frame, &result.camera) != 0) ||
        (result.has_pose && set == NULL && read_pose(&r, links->pose, &result.camera) != 0)) {
        return T3R_CAPTURE_FAILED;
    }
    if (links->depth != T3R_NO_MESSAGE) {
        result.depth_stamp_ns = recording->streams[recording->depth].messages[links->depth].stamp_ns;
    }
    if (set != NULL) {
        memcpy(result.camera.position_q32, set->position_q32, sizeof set->position_q32);
        memcpy(result.camera.rotation_q30, set->rotation_q30, sizeof set->rotation_q30);
    }
    *frame = result;
    return T3R_CAPTURE_FRAME;
}

int t3r_recording_set_pose(t3r_recording *recording, uint32_t index, const int64_t position_q32[3],
                           const int32_t rotation_q30[4])
{
    if (index >= recording->pairing.frames) {
        return -1;
    }
    if (recording->set_poses == NULL) {
        recording->set_poses = calloc(recording->pairing.frames, sizeof *recording->set_poses);
        if (recording->set_poses == NULL) {
            return -1;
        }
    }
    t3r_set_pose *pose = &recording->set_poses[index];
    pose->set = true;
    memcpy(pose->position_q32, position_q32, sizeof pose->position_q32);
    memcpy(pose->rotation_q30, rotation_q30, sizeof pose->rotation_q30);
    return 0;
}
