/* SPDX-License-Identifier: Apache-2.0 */
#include "ros/node.hpp"

#include <cmath>

namespace trim3r_ros
{

namespace
{

constexpr size_t error_bytes = 512;

uint32_t count_from(int value, const char *name)
{
    if (value < 0) {
        throw std::runtime_error(std::string(name) + " is negative");
    }
    return static_cast<uint32_t>(value);
}

int64_t nanoseconds_from(double milliseconds, const char *name)
{
    if (!(milliseconds >= 0 && milliseconds <= 1e6)) {
        throw std::runtime_error(std::string(name) + " is outside 0..1000000");
    }
    return std::llround(milliseconds * 1e6);
}

uint64_t unit_from(double unit)
{
    if (!(unit >= 1e-9 && unit <= 64)) {
        throw std::runtime_error("depth_unit is outside 0.000000001..64");
    }
    return static_cast<uint64_t>(std::llround(std::ldexp(unit, 40)));
}

// The path in a parameter; empty: none.
const char *path_from(const std::string &value)
{
    return value.empty() ? nullptr : value.c_str();
}

keyframe_map_settings map_settings(const parameters &p)
{
    keyframe_map_settings s = keyframe_map_defaults();
    s.width = count_from(p.width, "width");
    s.height = count_from(p.height, "height");
    s.gaussians = count_from(p.gaussians, "gaussians");
    s.at_hand = count_from(p.at_hand, "at_hand");
    s.every = count_from(p.every, "every");
    s.overlap_percent = count_from(p.overlap, "overlap");
    s.half_life = count_from(p.half_life, "half_life");
    s.remember = count_from(p.remember, "remember");
    s.refine = count_from(p.refine, "refine");
    s.threads = count_from(p.threads, "threads");
    s.warm = p.warm ? 1 : 0;
    s.gate = p.gate ? 1 : 0;
    s.head = p.head.c_str();
    s.max_ms = p.max_ms;
    s.snapshot = count_from(p.snapshot, "snapshot");
    s.resume = p.resume;
    s.scene = path_from(p.scene);
    s.state = path_from(p.state);
    s.lines = path_from(p.lines);
    return s;
}

frame_feed_settings feed_settings(const parameters &p)
{
    frame_feed_settings s = frame_feed_defaults();
    s.queue = count_from(p.queue, "queue");
    s.pair_ns = nanoseconds_from(p.pair_ms, "pair_ms");
    s.patience_ns = nanoseconds_from(p.patience_ms, "patience_ms");
    s.depth_unit_q40 = unit_from(p.depth_unit);
    s.world = p.world.c_str();
    return s;
}

std::string printed(const char *format, double value)
{
    char text[64];
    std::snprintf(text, sizeof text, format, value);
    return text;
}

std::string hexadecimal(uint64_t value)
{
    char text[17];
    std::snprintf(text, sizeof text, "%016" PRIx64, value);
    return text;
}

} // namespace

node::node(const parameters &given, outlet &out) : parameters_(given), out_(out)
{
    if (given.pose != "pose" && given.pose != "odometry" && given.pose != "transform" && given.pose != "tf") {
        throw std::runtime_error("pose is none of pose, odometry, transform, tf");
    }
    if (given.pose == "tf" && given.world.empty()) {
        throw std::runtime_error("poses by tf need the parameter world, the frame that does not move");
    }
    char error[error_bytes] = "";
    const keyframe_map_settings of_map = map_settings(parameters_);
    frame_feed_settings of_feed = feed_settings(parameters_);
    of_feed.user = this;
    of_feed.frame = [](void *self, int64_t stamp_ns, const char *world, const t3r_frame *frame,
                       const t3r_camera *camera,
                       int64_t now_ns) { static_cast<node *>(self)->frame(stamp_ns, world, *frame, *camera, now_ns); };
    of_feed.warn = [](void *self, frame_feed_topic topic, const char *reason) {
        static_cast<node *>(self)->warn(topic, reason);
    };
    of_feed.release = [](void *, void *owner) { delete static_cast<kept *>(owner); };
    if (given.pose == "tf") {
        of_feed.locate = [](void *self, int64_t stamp_ns, const char *camera, t3r_ros_pose *pose) {
            node *it = static_cast<node *>(self);
            return it->out_.locate(stamp_ns, it->parameters_.world, camera, *pose);
        };
    }
    feed_ = frame_feed_open(&of_feed, error, sizeof error);
    map_ = feed_ == nullptr ? nullptr : keyframe_map_open(&of_map, error, sizeof error);
    if (map_ == nullptr) {
        frame_feed_close(feed_);
        throw std::runtime_error(error);
    }
    out_.info("arena " + std::to_string(keyframe_map_arena_bytes(map_)) + " bytes, at most " +
              std::to_string(parameters_.gaussians) + " Gaussians");
}

node::~node()
{
    frame_feed_close(feed_);
    keyframe_map_close(map_);
}

void node::frame(int64_t stamp_ns, const char *world, const t3r_frame &frame, const t3r_camera &camera, int64_t now_ns)
{
    keyframe_map_report report;
    char error[error_bytes];
    const t3r_status status = keyframe_map_frame(map_, stamp_ns, &frame, &camera, &report, error, sizeof error);
    if (error[0] != '\0') {
        out_.warn(error);
    }
    if (status != T3R_OK) {
        const std::string reason = std::string("a frame is no keyframe: ") + t3r_error_text(status);
        frame_feed_warn(feed_, FRAME_FEED_COLOUR, reason.c_str(), now_ns);
        return;
    }
    t3r_scene scene;
    if (!report.keyframe || keyframe_map_scene(map_, &scene) != T3R_OK) {
        return;
    }
    out_.info("keyframe " + std::to_string(report.taken.keyframes) + ": " + std::to_string(report.taken.gaussians) +
              " Gaussians, " + std::to_string(report.taken.added) + " added, " + std::to_string(report.taken.removed) +
              " removed, " + printed("%.1f", report.milliseconds) + " ms, hash " + hexadecimal(report.hash));
    out_.cloud(scene, stamp_ns, world);
}

void node::warn(frame_feed_topic topic, const char *reason) const
{
    static const char *const names[FRAME_FEED_TOPICS] = {"colour", "depth", "camera_info", "pose"};
    out_.warn(std::string(names[topic]) + ": " + reason);
}

bool node::save(std::string &told) const
{
    if (parameters_.scene.empty()) {
        told = "the parameter scene names no file";
        return false;
    }
    char error[error_bytes];
    const bool done = keyframe_map_save(map_, error, sizeof error) == 0;
    told = done ? parameters_.scene : error;
    return done;
}

std::string node::summary() const
{
    const frame_feed_counts counts = frame_feed_counts_of(feed_);
    return std::to_string(counts.images) + " colour images, " + std::to_string(counts.frames) + " frames, " +
           std::to_string(counts.refused) + " refused; " + std::to_string(counts.poses_left_out) + " poses left out";
}

} // namespace trim3r_ros
