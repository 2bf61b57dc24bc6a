/* SPDX-License-Identifier: Apache-2.0 */
#include "ros_messages.h"

#include <string.h>

#define NS_PER_S 1000000000

bool t3r_ros_is_named(t3r_ros_type type, t3r_text name)
{
    t3r_text full = t3r_text_of(t3r_ros_names[type]);
    size_t package = 0;
    while (full.chars[package] != '/') {
        package++;
    }
    size_t rest = full.count - package - 4; /* after "/msg" */
    return t3r_text_same(name, full) || (name.count == package + rest && memcmp(name.chars, full.chars, package) == 0 &&
                                         memcmp(name.chars + package, full.chars + package + 4, rest) == 0);
}

static const char *const bad_encapsulation = "the encapsulation is not plain CDR";

/* Returns why a message is not plain CDR. */
static const char *encapsulation_error(const uint8_t *bytes, size_t count)
{
    return count >= 4 && memcmp(bytes, "\x28\xb5\x2f\xfd", 4) == 0
               ? "each message is packed with zstd: ros2 bag convert unpacks them"
               : bad_encapsulation;
}

static const char *const data_cut_short = "data is cut short";

static const char *get_header(t3r_cdr_reader *in, t3r_ros_header *header)
{
    int32_t seconds = (int32_t)t3r_cdr_get_u32(in);
    uint32_t nanoseconds = t3r_cdr_get_u32(in);
    header->stamp_ns = (int64_t)seconds * NS_PER_S + nanoseconds;
    header->frame_id = t3r_cdr_get_string(in);
    if (in->failed) {
        return "header is malformed or cut short";
    }
    return nanoseconds < NS_PER_S ? NULL : "header.stamp.nanosec is over 999999999";
}

static const char *open_message(t3r_cdr_reader *in, const uint8_t *bytes, size_t count, t3r_ros_header *header)
{
    t3r_cdr_open(in, bytes, count);
    return in->failed ? encapsulation_error(bytes, count) : get_header(in, header);
}

static void get_f64s(t3r_cdr_reader *in, uint64_t *values, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        values[i] = t3r_cdr_get_u64(in);
    }
}

const char *t3r_ros_read_image_head(const uint8_t *bytes, size_t count, t3r_ros_image *image, size_t *data_at)
{
    t3r_cdr_reader in;
    const char *wrong = open_message(&in, bytes, count, &image->header);
    if (wrong != NULL) {
        return wrong;
    }
    image->height = t3r_cdr_get_u32(&in);
    image->width = t3r_cdr_get_u32(&in);
    image->encoding = t3r_cdr_get_string(&in);
    if (in.failed) {
        return "encoding is malformed or cut short";
    }
    image->is_bigendian = t3r_cdr_get_u8(&in) != 0;
    image->step = t3r_cdr_get_u32(&in);
    image->data = NULL;
    image->data_bytes = t3r_cdr_get_u32(&in);
    *data_at = in.at;
    return in.failed ? data_cut_short : NULL;
}

const char *t3r_ros_read_image(const uint8_t *bytes, size_t count, t3r_ros_image *image)
{
    size_t data_at;
    const char *wrong = t3r_ros_read_image_head(bytes, count, image, &data_at);
    if (wrong != NULL) {
        return wrong;
    }
    if (image->data_bytes > count - data_at) {
        return data_cut_short;
    }
    image->data = bytes + data_at;
    return NULL;
}

const char *t3r_ros_read_camera_info(const uint8_t *bytes, size_t count, t3r_ros_camera_info *info)
{
    t3r_cdr_reader in;
    const char *wrong = open_message(&in, bytes, count, &info->header);
    if (wrong != NULL) {
        return wrong;
    }
    info->height = t3r_cdr_get_u32(&in);
    info->width = t3r_cdr_get_u32(&in);
    info->distortion_model = t3r_cdr_get_string(&in);
    if (in.failed) {
        return "distortion_model is malformed or cut short";
    }
    info->d_count = t3r_cdr_get_u32(&in);
    if (info->d_count > T3R_ROS_MAX_D) {
        return "D has more than 16 coefficients";
    }
    get_f64s(&in, info->d_f64, info->d_count);
    get_f64s(&in, info->k_f64, 9);
    get_f64s(&in, info->r_f64, 9);
    get_f64s(&in, info->p_f64, 12);
    info->binning_x = t3r_cdr_get_u32(&in);
    info->binning_y = t3r_cdr_get_u32(&in);
    info->roi_x = t3r_cdr_get_u32(&in);
    info->roi_y = t3r_cdr_get_u32(&in);
    info->roi_height = t3r_cdr_get_u32(&in);
    info->roi_width = t3r_cdr_get_u32(&in);
    info->roi_rectify = t3r_cdr_get_u8(&in) != 0;
    return in.failed ? "D, K, R, P, binning or roi is cut short" : NULL;
}

const char *t3r_ros_read_compressed(const uint8_t *bytes, size_t count, t3r_ros_compressed *image)
{
    t3r_cdr_reader in;
    const char *wrong = open_message(&in, bytes, count, &image->header);
    if (wrong != NULL) {
        return wrong;
    }
    image->format = t3r_cdr_get_string(&in);
    image->data = t3r_cdr_get_bytes(&in, &image->data_bytes);
    return in.failed ? "format or data is cut short" : NULL;
}

/* The fields in order: h header, c child_frame_id, p position and rotation; the rest is not read. */
static const char *const pose_fields[T3R_ROS_TYPE_COUNT] = {
    [T3R_ROS_POSE] = "hp",
    [T3R_ROS_TRANSFORM] = "hcp",
    [T3R_ROS_ODOMETRY] = "hcp",
    [T3R_ROS_POSE_COVARIANCE] = "hp",
};

bool t3r_ros_is_pose(t3r_ros_type type)
{
    return type < T3R_ROS_TYPE_COUNT && pose_fields[type] != NULL;
}

static const char *get_fields(t3r_cdr_reader *in, const char *fields, t3r_ros_pose *pose)
{
    const char *wrong = NULL;
    pose->child_frame_id = (t3r_text){"", 0};
    for (; *fields != '\0' && wrong == NULL; fields++) {
        if (*fields == 'h') {
            wrong = get_header(in, &pose->header);
        } else if (*fields == 'c') {
            pose->child_frame_id = t3r_cdr_get_string(in);
            wrong = in->failed ? "child_frame_id is malformed or cut short" : NULL;
        } else {
            get_f64s(in, pose->position_f64, 3);
            get_f64s(in, pose->rotation_f64, 4);
            wrong = in->failed ? "position or orientation is cut short" : NULL;
        }
    }
    return wrong;
}

const char *t3r_ros_read_pose(t3r_ros_type type, const uint8_t *bytes, size_t count, t3r_ros_pose *pose)
{
    t3r_cdr_reader in;
    t3r_cdr_open(&in, bytes, count);
    return in.failed ? bad_encapsulation : get_fields(&in, pose_fields[type], pose);
}

const char *t3r_ros_open_tf(const uint8_t *bytes, size_t count, t3r_ros_tf *tf)
{
    t3r_cdr_open(&tf->in, bytes, count);
    if (tf->in.failed) {
        return bad_encapsulation;
    }
    tf->left = t3r_cdr_get_u32(&tf->in);
    return tf->in.failed ? "transforms is cut short" : NULL;
}

const char *t3r_ros_next_tf(t3r_ros_tf *tf, t3r_ros_pose *transform)
{
    tf->left--;
    return get_fields(&tf->in, pose_fields[T3R_ROS_TRANSFORM], transform);
}

static void put_stamp(t3r_cdr_writer *out, int64_t stamp_ns)
{
    t3r_cdr_put_u32(out, (uint32_t)(stamp_ns / NS_PER_S));
    t3r_cdr_put_u32(out, (uint32_t)(stamp_ns % NS_PER_S));
}

static void put_header(t3r_cdr_writer *out, const t3r_ros_header *header)
{
    put_stamp(out, header->stamp_ns);
    t3r_cdr_put_string(out, header->frame_id);
}

static void put_f64s(t3r_cdr_writer *out, const uint64_t *values, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        t3r_cdr_put_u64(out, values[i]);
    }
}

void t3r_ros_write_image_head(t3r_cdr_writer *out, const t3r_ros_image *image)
{
    put_header(out, &image->header);
    t3r_cdr_put_u32(out, image->height);
    t3r_cdr_put_u32(out, image->width);
    t3r_cdr_put_string(out, image->encoding);
    t3r_cdr_put_u8(out, image->is_bigendian);
    t3r_cdr_put_u32(out, image->step);
    t3r_cdr_put_u32(out, image->data_bytes);
}

void t3r_ros_write_camera_info(t3r_cdr_writer *out, const t3r_ros_camera_info *info)
{
    put_header(out, &info->header);
    t3r_cdr_put_u32(out, info->height);
    t3r_cdr_put_u32(out, info->width);
    t3r_cdr_put_string(out, info->distortion_model);
    t3r_cdr_put_u32(out, info->d_count);
    put_f64s(out, info->d_f64, info->d_count);
    put_f64s(out, info->k_f64, 9);
    put_f64s(out, info->r_f64, 9);
    put_f64s(out, info->p_f64, 12);
    t3r_cdr_put_u32(out, info->binning_x);
    t3r_cdr_put_u32(out, info->binning_y);
    t3r_cdr_put_u32(out, info->roi_x);
    t3r_cdr_put_u32(out, info->roi_y);
    t3r_cdr_put_u32(out, info->roi_height);
    t3r_cdr_put_u32(out, info->roi_width);
    t3r_cdr_put_u8(out, info->roi_rectify);
}

void t3r_ros_write_pose(t3r_cdr_writer *out, const t3r_ros_pose *pose)
{
    put_header(out, &pose->header);
    put_f64s(out, pose->position_f64, 3);
    put_f64s(out, pose->rotation_f64, 4);
}

void t3r_ros_write_tf(t3r_cdr_writer *out, const t3r_ros_pose *pose)
{
    t3r_cdr_put_u32(out, 1); /* transforms */
    put_header(out, &pose->header);
    t3r_cdr_put_string(out, pose->child_frame_id);
    put_f64s(out, pose->position_f64, 3);
    put_f64s(out, pose->rotation_f64, 4);
}

void t3r_ros_write_log(t3r_cdr_writer *out, const t3r_ros_log *log)
{
    put_stamp(out, log->stamp_ns);
    t3r_cdr_put_u8(out, log->level);
    t3r_cdr_put_string(out, log->name);
    t3r_cdr_put_string(out, log->message);
    t3r_cdr_put_string(out, (t3r_text){"", 0}); /* file */
    t3r_cdr_put_string(out, (t3r_text){"", 0}); /* function */
    t3r_cdr_put_u32(out, 0);                    /* line */
}
