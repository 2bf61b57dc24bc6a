/* SPDX-License-Identifier: Apache-2.0 */
#include "message_frame.h"

#include "core/little_endian.h"
#include "fixed_camera.h"
#include "fixed_double.h"
#include "messages/pixel_layout.h"

/* Checks that rows of row_bytes, image->step apart, lie inside the data. */
static const char *rows_error(const t3r_ros_image *image, uint32_t row_bytes, uint32_t rows)
{
    if (image->step < row_bytes) {
        return "step is less than a row's bytes";
    }
    return (uint64_t)image->step * rows > image->data_bytes ? "data hold fewer than step x rows bytes" : NULL;
}

bool t3r_message_is_metres(const t3r_ros_image *image)
{
    return t3r_text_is(image->encoding, "32FC1");
}

bool t3r_message_is_z16(const t3r_ros_image *image)
{
    return !t3r_message_is_metres(image) && !image->is_bigendian;
}

bool t3r_message_is_depth(const t3r_ros_image *image)
{
    return t3r_message_is_metres(image) || t3r_text_is(image->encoding, "16UC1") ||
           t3r_text_is(image->encoding, "mono16");
}

const char *t3r_message_colour_shape(const t3r_ros_image *image, t3r_frame *frame)
{
    t3r_pixel_format format;
    if (!t3r_pixel_format_of(image->encoding, &format)) {
        return "encoding is none of rgb8, bgr8, mono8, yuv422_yuy2, yuv422, nv12";
    }
    const char *wrong = t3r_pixel_size_error(format, image->width, image->height);
    if (wrong == NULL) {
        const uint32_t rows = image->height + t3r_pixel_rows(format, 1, image->height);
        wrong = rows_error(image, t3r_pixel_row_bytes(format, image->width), rows);
    }
    if (wrong != NULL) {
        return wrong;
    }
    frame->format = format;
    frame->width = image->width;
    frame->height = image->height;
    frame->stride_bytes[0] = image->step;
    frame->stride_bytes[1] = format == T3R_PIXEL_NV12 ? image->step : 0;
    return NULL;
}

const char *t3r_message_colour(const t3r_ros_image *image, t3r_frame *frame)
{
    const char *wrong = t3r_message_colour_shape(image, frame);
    if (wrong == NULL) {
        frame->planes[0] = image->data;
        frame->planes[1] = frame->stride_bytes[1] != 0 ? image->data + (size_t)image->step * image->height : NULL;
    }
    return wrong;
}

const char *t3r_message_depth(const t3r_ros_image *image, t3r_frame *frame)
{
    if (!t3r_message_is_depth(image)) {
        return "encoding is none of 16UC1, mono16, 32FC1";
    }
    if (image->width < 2 || image->height < 2 || image->width > T3R_MAX_SIDE || image->height > T3R_MAX_SIDE) {
        return "width or height is outside 2..4096";
    }
    const char *wrong = rows_error(image, image->width * (t3r_message_is_metres(image) ? 4 : 2), image->height);
    if (wrong != NULL) {
        return wrong;
    }
    const bool steps = t3r_message_is_z16(image);
    frame->depth_width = image->width;
    frame->depth_height = image->height;
    frame->depth = steps ? image->data : NULL;
    frame->depth_stride_bytes = steps ? image->step : image->width * 2;
    return NULL;
}

bool t3r_message_is_stretched(const t3r_frame *frame)
{
    const int64_t difference =
        (int64_t)frame->depth_width * frame->height - (int64_t)frame->depth_height * frame->width;
    return (difference < 0 ? -difference : difference) > (frame->width > frame->height ? frame->width : frame->height);
}

/* Converts metres, a float's bits, to steps of the unit: to Q40, then divided, both round-half-even. 0 = no
 * measurement: NaN, infinity, zero, behind the camera, or more than 65535 steps. */
static uint16_t steps_of_metres(uint32_t bits, uint64_t unit_q40, uint32_t *beyond)
{
    int64_t depth_q40;
    if (t3r_fixed_from_float(bits, 40, &depth_q40) != 0 || depth_q40 <= 0) {
        return 0;
    }
    uint64_t steps = (uint64_t)depth_q40 / unit_q40, rest = (uint64_t)depth_q40 % unit_q40;
    steps += rest > unit_q40 - rest || (rest == unit_q40 - rest && (steps & 1) != 0);
    *beyond += steps > UINT16_MAX;
    return steps <= UINT16_MAX ? (uint16_t)steps : 0;
}

static uint16_t load16(const t3r_ros_image *image, const uint8_t *sample)
{
    const uint16_t value = t3r_load_le16(sample);
    return image->is_bigendian ? __builtin_bswap16(value) : value;
}

static uint32_t load32(const t3r_ros_image *image, const uint8_t *sample)
{
    const uint32_t value = t3r_load_le32(sample);
    return image->is_bigendian ? __builtin_bswap32(value) : value;
}

uint32_t t3r_message_to_z16(const t3r_ros_image *image, uint64_t unit_q40, uint8_t *out)
{
    const bool metres = t3r_message_is_metres(image);
    uint32_t beyond = 0;
    for (uint32_t y = 0; y < image->height; y++) {
        const uint8_t *row = image->data + (size_t)y * image->step;
        for (uint32_t x = 0; x < image->width;
             x++, out += 2) { /* in place: a sample is read before it is overwritten */
            const uint8_t *sample = row + (size_t)x * (metres ? 4 : 2);
            t3r_store_le16(out,
                           metres ? steps_of_metres(load32(image, sample), unit_q40, &beyond) : load16(image, sample));
        }
    }
    return beyond;
}

static bool is_zero(uint64_t f64)
{
    return f64 << 1 == 0;
}

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
                       : "D has terms beyond k1 k2 p1 p2 k3: trim3r import reads k4 to k6 as well, and no further ones";
    }
    for (uint32_t i = 0; i < used; i++) {
        if (!t3r_fixed_coefficient(info->d_f64[i], camera->distortion, i, &camera->distortion_q24[i])) {
            return "D has a coefficient that is not a number within -128..128 (p1, p2: -16..16)";
        }
    }
    return NULL;
}

/* Refuses binning and regions of interest, which would need an adapted K; recordings of whole images have neither. */
static const char *window_error(const t3r_ros_camera_info *info)
{
    if (info->binning_x > 1 || info->binning_y > 1) {
        return "binning is not supported";
    }
    bool whole = info->roi_x == 0 && info->roi_y == 0 && (info->roi_width == 0 || info->roi_width == info->width) &&
                 (info->roi_height == 0 || info->roi_height == info->height);
    return whole ? NULL : "a region of interest is not supported";
}

const char *t3r_message_intrinsics(const t3r_ros_camera_info *info, t3r_camera *camera)
{
#define FOCAL_RANGE " is not a number in [8, 16384)"
#define CENTRE_RANGE " is not a number in (-16384, 16384)"
    const char *wrong = window_error(info);
    if (wrong != NULL) {
        return wrong;
    }
    if (!is_zero(info->k_f64[1]) || !is_zero(info->k_f64[3]) || !is_zero(info->k_f64[6]) || !is_zero(info->k_f64[7])) {
        return "K has a skew, or entries where a camera matrix has none";
    }
    if (!t3r_fixed_focal(info->k_f64[0], &camera->fx_q16)) {
        return "K[0] (fx)" FOCAL_RANGE;
    }
    if (!t3r_fixed_focal(info->k_f64[4], &camera->fy_q16)) {
        return "K[4] (fy)" FOCAL_RANGE;
    }
    if (!t3r_fixed_centre(info->k_f64[2], &camera->cx_q16)) {
        return "K[2] (cx)" CENTRE_RANGE;
    }
    if (!t3r_fixed_centre(info->k_f64[5], &camera->cy_q16)) {
        return "K[5] (cy)" CENTRE_RANGE;
    }
    camera->width = info->width;
    camera->height = info->height;
    return read_distortion(info, camera);
}

bool t3r_message_is_bent(const t3r_ros_camera_info *info)
{
    bool bent =
        t3r_text_is(info->distortion_model, "plumb_bob") || t3r_text_is(info->distortion_model, "rational_polynomial");
    for (uint32_t i = 0; i < info->d_count; i++) {
        int64_t part;
        bent = bent && t3r_fixed_from_double(info->d_f64[i], 24, &part) == 0 && (i < 8 || part == 0);
    }
    return bent;
}

const char *t3r_message_rectify(t3r_ros_camera_info *info)
{
    bool distorted = false;
    for (uint32_t i = 0; i < info->d_count; i++) {
        distorted = distorted || !is_zero(info->d_f64[i]);
    }
    if (is_zero(info->p_f64[0])) { /* P is not filled in */
        return distorted ? "P is 0, but images of a rectified topic need it" : NULL;
    }
    for (uint32_t i = 0; i < 9; i++) {
        info->k_f64[i] = info->p_f64[i / 3 * 4 + i % 3];
    }
    info->d_count = 0;
    info->distortion_model = (t3r_text){"", 0};
    return NULL;
}

static const char *const no_direction = "a rotation has no direction: it is zero or not a number";

/* Whether a quaternion's largest part is between 2^-20 and 2^19, so that it can be normalised. */
static bool has_direction(const uint64_t rotation_f64[4])
{
    const int64_t least = INT64_C(1) << 10, most = INT64_C(1) << 49;
    bool any = false;
    for (uint32_t i = 0; i < 4; i++) {
        int64_t part;
        if (t3r_fixed_from_double(rotation_f64[i], 30, &part) != 0 || part > most || part < -most) {
            return false;
        }
        any = any || part >= least || part <= -least;
    }
    return any;
}

/* Converts a quaternion to fixed point. Returns -1 or 1 if its norm is below 1/2 or above 3/2, the range of t3r_camera,
 * else 0. */
static int convert_rotation(const uint64_t rotation_f64[4], uint32_t fraction_bits, int32_t xyzw[4])
{
    const int64_t most = INT64_C(3) << 29; /* 3/2, so that the sum below is at most 9 x 2^60 */
    uint64_t norm2_q60 = 0;
    for (uint32_t i = 0; i < 4; i++) {
        int64_t part;
        if (t3r_fixed_from_double(rotation_f64[i], fraction_bits, &part) != 0 || part > most || part < -most) {
            return 1;
        }
        xyzw[i] = (int32_t)part;
        norm2_q60 += (uint64_t)(part * part);
    }
    return norm2_q60 < UINT64_C(1) << 58 ? -1 : norm2_q60 > UINT64_C(9) << 58 ? 1 : 0;
}

const char *t3r_message_pose_error(const t3r_ros_pose *pose)
{
    for (uint32_t i = 0; i < 3; i++) {
        int64_t part;
        if (t3r_fixed_from_double(pose->position_f64[i], 32, &part) != 0) {
            return "a position is not a number within -2^31..2^31";
        }
    }
    return has_direction(pose->rotation_f64) ? NULL : no_direction;
}

const char *t3r_message_transform_error(const t3r_ros_pose *transform)
{
    if (transform->header.frame_id.count == 0 || transform->child_frame_id.count == 0) {
        return "a frame has no name";
    }
    if (t3r_text_same(transform->header.frame_id, transform->child_frame_id)) {
        return "a frame is above itself";
    }
    return t3r_message_pose_error(transform);
}

const char *t3r_message_pose(const t3r_ros_pose *pose, t3r_camera *camera)
{
#define POSITION_RANGE " is not a number within -2^30..2^30"
    static const char *const positions[3] = {"position.x" POSITION_RANGE, "position.y" POSITION_RANGE,
                                             "position.z" POSITION_RANGE};
    for (uint32_t i = 0; i < 3; i++) {
        if (!t3r_fixed_position(pose->position_f64[i], &camera->position_q32[i])) {
            return positions[i];
        }
    }
    if (!has_direction(pose->rotation_f64)) {
        return no_direction;
    }
    int32_t xyzw[4] = {0};
    uint32_t fraction_bits = 30; /* others scale by powers of two, since only the direction counts */
    int order = convert_rotation(pose->rotation_f64, fraction_bits, xyzw);
    for (uint32_t steps = 0; order != 0 && steps < 20; steps++) { /* 2^20 is the most that has_direction() allows */
        fraction_bits = order > 0 ? fraction_bits - 1 : fraction_bits + 1;
        order = convert_rotation(pose->rotation_f64, fraction_bits, xyzw);
    }
    for (uint32_t i = 0; i < 4; i++) {
        camera->rotation_q30[(i + 1) % 4] = xyzw[i];
    }
    return NULL;
}
