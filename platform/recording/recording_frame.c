/* SPDX-License-Identifier: Apache-2.0 */
/* Reads one frame of a recording from its messages. */
#include "recording_index.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#include "core/camera.h"
#include "host/reason.h"
#include "messages/message_frame.h"
#include "messages/pixel_layout.h"

/* The frame being read, and where reasons go. */
typedef struct reading {
    const t3r_recording *recording;
    uint32_t index;
    char *error;
    size_t error_bytes;
} reading;

static int fail(const reading *r, const t3r_stream *stream, const t3r_indexed_message *message, const char *what)
{
    char place[T3R_RECORDING_PLACE_BYTES];
    return t3r_reason(r->error, r->error_bytes, "frame %" PRIu32 ", %.64s at %s: %s", r->index, stream->topic,
                      t3r_recording_place_text(r->recording, message->file, message->place, place), what);
}

/* Decodes a compressed image with the recording's decoder and checks its size. */
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
    return wrong == NULL ? 0 : fail(r, stream, message, wrong);
}

static bool is_large(const t3r_ros_image *image)
{
    return image->width > T3R_MAX_SIDE || image->height > T3R_MAX_SIDE;
}

/* Converts an image that is large, or whose encoding is no pixel format, with the recording's decoder. Returns NULL, or
 * what is wrong, which may be in what[]. */
static const char *convert(const reading *r, const t3r_ros_image *image, t3r_decoded_image *out, char *what,
                           size_t bytes)
{
    const t3r_image_decoder *decoder = &r->recording->decoder;
    if (decoder->convert != NULL) {
        return decoder->convert(decoder->user, image, out, what, bytes) == 0 ? NULL : what;
    }
    if (!is_large(image)) {
        return "images of this encoding are converted by trim3r import";
    }
    t3r_reason(what, bytes,
               "%" PRIu32 "x%" PRIu32 " pixels; sides of up to %u are supported, larger ones with --size of trim3r "
               "import",
               image->width, image->height, T3R_MAX_SIDE);
    return what;
}

/* Reads a raw image: as it is, or converted into *out. */
static int read_raw(const reading *r, const t3r_stream *stream, const t3r_indexed_message *message,
                    t3r_decoded_image *out, t3r_frame *frame)
{
    t3r_ros_image image;
    char what[160];
    const char *wrong = t3r_ros_read_image(message->data, message->bytes, &image);
    t3r_pixel_format format;
    if (wrong == NULL && stream->converted && !t3r_pixel_is_converted(image.encoding)) {
        wrong = "the encoding is another one than that of the first image";
    } else if (wrong == NULL &&
               (stream->converted || (is_large(&image) && t3r_pixel_format_of(image.encoding, &format)))) {
        wrong = convert(r, &image, out, what, sizeof what);
    } else if (wrong == NULL) {
        wrong = t3r_message_colour(&image, frame);
    }
    return wrong == NULL ? 0 : fail(r, stream, message, wrong);
}

/* Fills in the frame's colour; *decoded is all 0 if it is stored as pixels that can be used as they are. */
static int read_colour(const reading *r, t3r_frame *frame, t3r_decoded_image *decoded)
{
    const t3r_stream *stream = &r->recording->streams[r->recording->colour];
    const t3r_indexed_message *message = &stream->messages[r->index];
    *decoded = (t3r_decoded_image){0};
    const int status =
        stream->compressed ? decode(r, stream, message, false, decoded) : read_raw(r, stream, message, decoded, frame);
    if (status == 0 && decoded->rows != NULL) {
        frame->format = decoded->format;
        frame->width = decoded->width;
        frame->height = decoded->height;
        frame->planes[0] = decoded->rows;
        frame->stride_bytes[0] = t3r_pixel_row_bytes(decoded->format, decoded->width);
    }
    return status;
}

/* Whether depth is taken to be of the colour camera's view. */
static bool is_of_colour(const t3r_recording *recording)
{
    const t3r_text depth = recording->streams[recording->depth].frame_id,
                   colour = recording->streams[recording->colour].frame_id;
    return recording->depth_camera_info == T3R_NO_STREAM && (depth.count == 0 || t3r_text_same(depth, colour));
}

/* Whether depth that is taken to be of colour's lens has another aspect, by more than a pixel. trim3r's own recordings
 * hold what was captured. */
static bool is_stretched(const reading *r, const t3r_frame *frame)
{
    return r->recording->bits_epoch == 0 && is_of_colour(r->recording) && t3r_message_is_stretched(frame);
}

/* Checks the sides of depth beside those of colour. */
static int check_aspect(const reading *r, size_t link, const t3r_frame *frame)
{
    const t3r_stream *stream = &r->recording->streams[r->recording->depth];
    if (!is_stretched(r, frame)) {
        return 0;
    }
    char what[192];
    t3r_reason(what, sizeof what,
               "depth is %" PRIu32 "x%" PRIu32 " and colour %" PRIu32 "x%" PRIu32
               ": another aspect needs intrinsics of its own (--depth-camera-info-topic)",
               frame->depth_width, frame->depth_height, frame->width, frame->height);
    return fail(r, stream, &stream->messages[link], what);
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
    wrong = wrong != NULL ? wrong : t3r_message_depth(&image, frame);
    if (wrong != NULL) {
        return fail(r, stream, message, wrong);
    }
    if (frame->depth != NULL) {
        return 0;
    }
    uint8_t **z16 = &r->recording->depth_z16[link];
    if (*z16 == NULL) {
        *z16 = malloc((size_t)image.width * image.height * 2);
        if (*z16 == NULL) {
            return fail(r, stream, message, "out of memory");
        }
        *r->recording->depth_beyond += t3r_message_to_z16(&image, r->recording->depth_unit_q40, *z16);
    }
    frame->depth = *z16;
    return 0;
}

/* Reads a lens that no camera holds, and has the frame redrawn without it. Returns NULL, or what is wrong. */
static const char *straighten(const reading *r, t3r_ros_camera_info *info, t3r_capture_frame *frame, char *what,
                              size_t bytes)
{
    const t3r_image_decoder *decoder = &r->recording->decoder;
    const bool depth = frame->frame.depth != NULL && is_of_colour(r->recording);
    if (decoder->straighten(decoder->user, info, &frame->frame, depth, what, bytes) != 0) {
        return what;
    }
    frame->straightened = true;
    info->d_count = 0;
    return t3r_message_intrinsics(info, &frame->camera);
}

/* Reads the intrinsics of the image as it is stored. */
static int read_intrinsics(const reading *r, size_t link, const t3r_decoded_image *decoded, t3r_capture_frame *frame)
{
    const uint32_t width = decoded->reduction > 1 ? decoded->whole_width : frame->frame.width;
    const uint32_t height = decoded->reduction > 1 ? decoded->whole_height : frame->frame.height;
    const t3r_stream *stream = &r->recording->streams[r->recording->camera_info];
    const t3r_indexed_message *message = &stream->messages[link];
    t3r_ros_camera_info info;
    char what[192];
    const char *wrong = t3r_ros_read_camera_info(message->data, message->bytes, &info);
    if (wrong == NULL && r->recording->streams[r->recording->colour].rectified) {
        wrong = t3r_message_rectify(&info);
    }
    if (wrong == NULL && (info.width != width || info.height != height)) {
        t3r_reason(what, sizeof what,
                   "width x height is %" PRIu32 "x%" PRIu32 ", that of the image %" PRIu32 "x%" PRIu32, info.width,
                   info.height, width, height);
        wrong = what;
    }
    if (wrong == NULL) {
        wrong = t3r_message_intrinsics(&info, &frame->camera);
        if (wrong != NULL && r->recording->decoder.straighten != NULL && t3r_message_is_bent(&info)) {
            wrong = straighten(r, &info, frame, what, sizeof what);
        }
    }
    return wrong == NULL ? 0 : fail(r, stream, message, wrong);
}

static int read_pose(const reading *r, size_t link, t3r_camera *camera)
{
    const t3r_stream *stream = &r->recording->streams[r->recording->pose];
    const t3r_indexed_message *message = &stream->messages[link];
    t3r_ros_pose pose;
    const char *wrong = t3r_ros_read_pose(stream->type, message->data, message->bytes, &pose);
    wrong = wrong != NULL ? wrong : t3r_message_pose(&pose, camera);
    return wrong == NULL ? 0 : fail(r, stream, message, wrong);
}

/* Adds the last reason to lost[]. */
static void add_lost(char *lost, size_t lost_bytes, const char *error)
{
    const size_t used = strlen(lost);
    t3r_reason(lost + used, lost_bytes - used, "%s%s", used > 0 ? "; " : "", error);
}

/* Reads a frame. With `lost`, it goes without depth or pose where these cannot be read. */
static int read_frame(const reading *r, t3r_capture_frame *frame, char *lost, size_t lost_bytes)
{
    const t3r_recording *recording = r->recording;
    if (r->index >= recording->pairing.frames) {
        t3r_reason(r->error, r->error_bytes, "frame %" PRIu32 ": the recording holds %" PRIu32, r->index,
                   recording->pairing.frames);
        return T3R_CAPTURE_FAILED;
    }
    t3r_spill_rest(&recording->spill); /* of frames that were read before; their addresses stay valid */
    const t3r_frame_links *links = &recording->links[r->index];
    const t3r_set_pose *set =
        recording->set_poses != NULL && recording->set_poses[r->index].set ? &recording->set_poses[r->index] : NULL;
    const int64_t stamp_ns = recording->streams[recording->colour].messages[r->index].stamp_ns;
    t3r_capture_frame result = {
        .index = r->index,
        .sequence = r->index,
        .stamp_ns = stamp_ns,
        .depth_stamp_ns = stamp_ns,
        .has_pose = links->pose != T3R_NO_MESSAGE || set != NULL,
        .has_intrinsics = links->camera_info != T3R_NO_MESSAGE || recording->intrinsics_given,
        .camera = recording->intrinsics,
    };
    t3r_decoded_image decoded;
    if (read_colour(r, &result.frame, &decoded) != 0) {
        return T3R_CAPTURE_FAILED;
    }
    if (links->depth != T3R_NO_MESSAGE) {
        result.depth_stamp_ns = recording->streams[recording->depth].messages[links->depth].stamp_ns;
        if (read_depth(r, links->depth, &result.frame) != 0 || check_aspect(r, links->depth, &result.frame) != 0) {
            if (lost == NULL) {
                return T3R_CAPTURE_FAILED;
            }
            add_lost(lost, lost_bytes, r->error);
            result.depth_stamp_ns = stamp_ns;
            result.frame.depth = NULL;
            result.frame.depth_width = result.frame.depth_height = 0;
        }
    }
    if (links->camera_info != T3R_NO_MESSAGE && read_intrinsics(r, links->camera_info, &decoded, &result) != 0) {
        return T3R_CAPTURE_FAILED;
    }
    if (decoded.reduction > 1) {
        result.camera = t3r_camera_resized(&result.camera, decoded.width * decoded.reduction,
                                           decoded.height * decoded.reduction, decoded.width, decoded.height);
    }
    if (set != NULL) {
        memcpy(result.camera.position_q32, set->position_q32, sizeof set->position_q32);
        memcpy(result.camera.rotation_q30, set->rotation_q30, sizeof set->rotation_q30);
    } else if (result.has_pose && read_pose(r, links->pose, &result.camera) != 0) {
        if (lost == NULL) {
            return T3R_CAPTURE_FAILED;
        }
        add_lost(lost, lost_bytes, r->error);
        result.has_pose = false;
    }
    *frame = result;
    return T3R_CAPTURE_FRAME;
}

int t3r_recording_frame(const t3r_recording *recording, uint32_t index, t3r_capture_frame *frame, char *error,
                        size_t error_bytes)
{
    return read_frame(&(reading){recording, index, error, error_bytes}, frame, NULL, 0);
}

int t3r_recording_frame_readable(const t3r_recording *recording, uint32_t index, t3r_capture_frame *frame, char *lost,
                                 size_t lost_bytes, char *error, size_t error_bytes)
{
    lost[0] = '\0';
    return read_frame(&(reading){recording, index, error, error_bytes}, frame, lost, lost_bytes);
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
