/* SPDX-License-Identifier: Apache-2.0 */
// Converts ROS messages to and from the structures of platform/messages/ros_messages.h. The templates take the messages
// of ROS 1 and of ROS 2, whose fields differ in three names: nsec and nanosec, K and k, D and d. Only numbers are
// copied: texts and images stay in the message.
#ifndef TRIM3R_TOOLS_ROS_MAPPING_HPP
#define TRIM3R_TOOLS_ROS_MAPPING_HPP

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>

#include "ros/frame_feed.h"
#include "ros/point_cloud.h"

namespace trim3r_ros
{

constexpr int64_t second_ns = 1000000000;

inline t3r_text text_of(const std::string &text)
{
    return {text.data(), text.size()};
}

inline uint64_t bits_of(double value)
{
    uint64_t bits;
    std::memcpy(&bits, &value, sizeof bits);
    return bits;
}

template <class Stamp> auto nanoseconds_of(const Stamp &stamp, int) -> decltype(int64_t{stamp.nanosec})
{
    return stamp.nanosec;
}

template <class Stamp> auto nanoseconds_of(const Stamp &stamp, long) -> decltype(int64_t{stamp.nsec})
{
    return stamp.nsec;
}

template <class Stamp> int64_t stamp_of(const Stamp &stamp)
{
    return stamp.sec * second_ns + nanoseconds_of(stamp, 0);
}

template <class Header> t3r_ros_header header_of(const Header &header)
{
    return {stamp_of(header.stamp), text_of(header.frame_id)};
}

// Clamps a count of bytes to 32 bits, which no image reaches.
inline uint32_t count_of(size_t bytes)
{
    constexpr size_t most = std::numeric_limits<uint32_t>::max();
    return static_cast<uint32_t>(bytes < most ? bytes : most);
}

template <class Image> t3r_ros_image image_of(const Image &message)
{
    t3r_ros_image image = {};
    image.header = header_of(message.header);
    image.height = message.height;
    image.width = message.width;
    image.encoding = text_of(message.encoding);
    image.is_bigendian = message.is_bigendian != 0;
    image.step = message.step;
    image.data = message.data.data();
    image.data_bytes = count_of(message.data.size());
    return image;
}

template <class CompressedImage> t3r_ros_compressed compressed_of(const CompressedImage &message)
{
    t3r_ros_compressed image = {};
    image.header = header_of(message.header);
    image.format = text_of(message.format);
    image.data = message.data.data();
    image.data_bytes = count_of(message.data.size());
    return image;
}

template <class Info> auto matrix_of(const Info &info, int) -> decltype((info.k))
{
    return info.k;
}

template <class Info> auto matrix_of(const Info &info, long) -> decltype((info.K))
{
    return info.K;
}

template <class Info> auto distortion_of(const Info &info, int) -> decltype((info.d))
{
    return info.d;
}

template <class Info> auto distortion_of(const Info &info, long) -> decltype((info.D))
{
    return info.D;
}

template <class Info> auto projection_of(const Info &info, int) -> decltype((info.p))
{
    return info.p;
}

template <class Info> auto projection_of(const Info &info, long) -> decltype((info.P))
{
    return info.P;
}

template <class Info> t3r_ros_camera_info camera_info_of(const Info &message)
{
    t3r_ros_camera_info info = {};
    const auto &distortion = distortion_of(message, 0);
    info.header = header_of(message.header);
    info.height = message.height;
    info.width = message.width;
    info.distortion_model = text_of(message.distortion_model);
    info.binning_x = message.binning_x;
    info.binning_y = message.binning_y;
    info.roi_x = message.roi.x_offset;
    info.roi_y = message.roi.y_offset;
    info.roi_height = message.roi.height;
    info.roi_width = message.roi.width;
    info.roi_rectify = message.roi.do_rectify != 0;
    for (size_t i = 0; i < 9; i++) {
        info.k_f64[i] = bits_of(matrix_of(message, 0)[i]);
    }
    for (size_t i = 0; i < 12; i++) {
        info.p_f64[i] = bits_of(projection_of(message, 0)[i]);
    }
    info.d_count = static_cast<uint32_t>(std::min<size_t>(distortion.size(), T3R_ROS_MAX_D));
    for (size_t i = 0; i < distortion.size(); i++) {
        // with more coefficients than any model has, the last one is 0 only if all the others are
        if (i < T3R_ROS_MAX_D || distortion[i] != 0) {
            info.d_f64[std::min<size_t>(i, T3R_ROS_MAX_D - 1)] = bits_of(distortion[i]);
        }
    }
    return info;
}

// Position and rotation have the fields x y z and x y z w.
template <class Header, class Position, class Rotation>
t3r_ros_pose pose_from(const Header &header, const Position &position, const Rotation &rotation)
{
    t3r_ros_pose pose = {};
    pose.header = header_of(header);
    const double place[3] = {position.x, position.y, position.z};
    const double turn[4] = {rotation.x, rotation.y, rotation.z, rotation.w};
    for (int i = 0; i < 3; i++) {
        pose.position_f64[i] = bits_of(place[i]);
    }
    for (int i = 0; i < 4; i++) {
        pose.rotation_f64[i] = bits_of(turn[i]);
    }
    return pose;
}

// Normalises a rotation whose length tf2 would not take as 1.
template <class Rotation> void normalise(Rotation &r)
{
    const double length = std::sqrt(r.x * r.x + r.y * r.y + r.z * r.z + r.w * r.w);
    if (std::abs(length - 1) > 0.004) {
        r.x /= length;
        r.y /= length;
        r.z /= length;
        r.w /= length;
    }
}

template <class PoseStamped> t3r_ros_pose pose_of(const PoseStamped &message)
{
    return pose_from(message.header, message.pose.position, message.pose.orientation);
}

template <class Odometry> t3r_ros_pose odometry_pose_of(const Odometry &message)
{
    t3r_ros_pose pose = pose_from(message.header, message.pose.pose.position, message.pose.pose.orientation);
    pose.child_frame_id = text_of(message.child_frame_id);
    return pose;
}

template <class TransformStamped> t3r_ros_pose transform_pose_of(const TransformStamped &message)
{
    t3r_ros_pose pose = pose_from(message.header, message.transform.translation, message.transform.rotation);
    pose.child_frame_id = text_of(message.child_frame_id);
    return pose;
}

// Fills a cloud with the scene's points; the caller sets the header.
template <class PointCloud2> void cloud_from(const t3r_scene &scene, PointCloud2 &cloud)
{
    cloud.height = 1;
    cloud.width = scene.count;
    cloud.fields.resize(POINT_CLOUD_FIELD_COUNT);
    for (uint32_t i = 0; i < POINT_CLOUD_FIELD_COUNT; i++) {
        cloud.fields[i].name = point_cloud_fields[i];
        cloud.fields[i].offset = i * 4;
        cloud.fields[i].datatype = POINT_CLOUD_FLOAT32;
        cloud.fields[i].count = 1;
    }
    cloud.is_bigendian = false;
    cloud.is_dense = true;
    cloud.point_step = POINT_CLOUD_STEP;
    cloud.row_step = scene.count * POINT_CLOUD_STEP;
    cloud.data.resize(static_cast<size_t>(scene.count) * POINT_CLOUD_STEP);
    point_cloud_write(&scene, cloud.data.data());
}

} // namespace trim3r_ros

#endif
