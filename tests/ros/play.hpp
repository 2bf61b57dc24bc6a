/* SPDX-License-Identifier: Apache-2.0 */
// Converts a recording's messages to messages of ROS 1 or ROS 2, and describes clouds for the tests.
#ifndef TRIM3R_TESTS_ROS_PLAY_HPP
#define TRIM3R_TESTS_ROS_PLAY_HPP

#include <cstdint>
#include <cstdio>
#include <cstring>
#include <stdexcept>
#include <string>

extern "C" {
#include "messages/ros_messages.h"
#include "recording/recording.h"
}

namespace play
{

class recording
{
  public:
    explicit recording(const char *path)
    {
        char error[512];
        recording_ = t3r_recording_open(path, error, sizeof error);
        if (recording_ == nullptr) {
            throw std::runtime_error(error);
        }
    }
    ~recording()
    {
        t3r_recording_close(recording_);
    }
    recording(const recording &) = delete;
    recording &operator=(const recording &) = delete;

    uint32_t frames() const
    {
        return t3r_recording_frame_count(recording_);
    }
    t3r_recorded_message message(uint32_t frame, t3r_stream_use use) const
    {
        return t3r_recording_frame_message(recording_, frame, use);
    }

  private:
    t3r_recording *recording_;
};

inline void need(const char *wrong)
{
    if (wrong != nullptr) {
        throw std::runtime_error(wrong);
    }
}

inline std::string string_of(t3r_text text)
{
    return std::string(text.chars, text.count);
}

inline double double_of(uint64_t bits)
{
    double value;
    std::memcpy(&value, &bits, sizeof value);
    return value;
}

// `stamp(target, nanoseconds)` sets a stamp of that version of ROS.
template <class Header, class Stamp> void fill_header(Header &header, const t3r_ros_header &from, Stamp stamp)
{
    stamp(header.stamp, from.stamp_ns);
    header.frame_id = string_of(from.frame_id);
}

template <class Image, class Stamp> Image image_of(const t3r_recorded_message &message, Stamp stamp)
{
    t3r_ros_image from;
    need(t3r_ros_read_image(message.data, message.bytes, &from));
    Image to;
    fill_header(to.header, from.header, stamp);
    to.height = from.height;
    to.width = from.width;
    to.encoding = string_of(from.encoding);
    to.is_bigendian = from.is_bigendian;
    to.step = from.step;
    to.data.assign(from.data, from.data + from.data_bytes);
    return to;
}

// `arrays(message, k, d)` fills the arrays, whose names depend on the version of ROS.
template <class Info, class Stamp, class Arrays>
Info camera_info_of(const t3r_recorded_message &message, Stamp stamp, Arrays arrays)
{
    t3r_ros_camera_info from;
    need(t3r_ros_read_camera_info(message.data, message.bytes, &from));
    Info to;
    fill_header(to.header, from.header, stamp);
    to.height = from.height;
    to.width = from.width;
    to.distortion_model = string_of(from.distortion_model);
    double k[9], d[T3R_ROS_MAX_D];
    for (int i = 0; i < 9; i++) {
        k[i] = double_of(from.k_f64[i]);
    }
    for (uint32_t i = 0; i < from.d_count; i++) {
        d[i] = double_of(from.d_f64[i]);
    }
    arrays(to, k, d, from.d_count);
    return to;
}

inline t3r_ros_pose recorded_pose(const t3r_recorded_message &message)
{
    t3r_ros_pose pose;
    need(t3r_ros_read_pose(T3R_ROS_POSE, message.data, message.bytes, &pose));
    return pose;
}

template <class Position, class Rotation>
void fill_pose(const t3r_ros_pose &from, Position &position, Rotation &rotation)
{
    position.x = double_of(from.position_f64[0]);
    position.y = double_of(from.position_f64[1]);
    position.z = double_of(from.position_f64[2]);
    rotation.x = double_of(from.rotation_f64[0]);
    rotation.y = double_of(from.rotation_f64[1]);
    rotation.z = double_of(from.rotation_f64[2]);
    rotation.w = double_of(from.rotation_f64[3]);
}

// Prints a line of JSON for a cloud and writes its points to the file.
template <class Cloud> void tell(const Cloud &cloud, int64_t stamp_ns, const char *path)
{
    std::printf(
        "{\"cloud\": %u, \"height\": %u, \"step\": %u, \"row\": %u, \"bytes\": %zu, \"big\": %d, \"dense\": %d, "
        "\"stamp_ns\": %lld, \"frame\": \"%s\", \"fields\": [",
        cloud.width, cloud.height, cloud.point_step, cloud.row_step, cloud.data.size(), int{cloud.is_bigendian},
        int{cloud.is_dense}, static_cast<long long>(stamp_ns), cloud.header.frame_id.c_str());
    const char *comma = "";
    for (const auto &field : cloud.fields) {
        std::printf("%s[\"%s\", %u, %d, %u]", comma, field.name.c_str(), field.offset, int{field.datatype},
                    field.count);
        comma = ", ";
    }
    std::printf("]}\n");
    std::fflush(stdout);
    std::FILE *file = std::fopen(path, "wb");
    const bool done =
        file != nullptr && std::fwrite(cloud.data.data(), 1, cloud.data.size(), file) == cloud.data.size();
    if (file == nullptr || std::fclose(file) != 0 || !done) {
        throw std::runtime_error(std::string(path) + ": the cloud cannot be written");
    }
}

} // namespace play

#endif
