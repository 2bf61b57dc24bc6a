/* SPDX-License-Identifier: Apache-2.0 */
// The node without ROS: messages of a camera in, the map and its clouds out. A wrapper for a version of ROS calls it
// from one thread and handles clouds and lines.
#ifndef TRIM3R_TOOLS_ROS_NODE_HPP
#define TRIM3R_TOOLS_ROS_NODE_HPP

#include <cinttypes>
#include <cstdio>
#include <memory>
#include <stdexcept>
#include <string>

#include "ros/frame_feed.h"
#include "ros/keyframe_map.h"
#include "ros/mapping.hpp"

namespace trim3r_ros
{

// Parameters of a user, with their defaults.
struct parameters {
    int width = 256, height = 256; // the working size
    int gaussians = 10000;         // most Gaussians in the map
    int at_hand = 4, every = 3, overlap = 0, half_life = 32, remember = 0, refine = T3R_STREAM_REFINE, threads = 1;
    bool warm = false, gate = true;
    std::string head = "small";
    int queue = 8;
    double pair_ms = 20, patience_ms = 500;
    double depth_unit = 0.001; // step of 16-bit depth
    std::string pose = "pose"; // or odometry, transform, tf: the message type of poses
    std::string world;         // the frame of poses; empty: the first pose's, which tf does not have
    std::string scene;         // file for the scene at the end and for the service; empty: none
    int snapshot = 0;          // keyframes between two writes of scene and state; 0: at the end and by the service
    std::string state;         // file of the whole stream; empty: none
    bool resume = false;       // continue from it, if it exists
    std::string lines;         // file of JSON lines; empty: none
    double max_ms = 0;         // time of a keyframe; 0: no limit
};

// Calls `visit(name, field)` for each, so that all wrappers have the same parameters.
template <class Visit> void visit_parameters(parameters &p, Visit visit)
{
    visit("width", p.width);
    visit("height", p.height);
    visit("gaussians", p.gaussians);
    visit("at_hand", p.at_hand);
    visit("every", p.every);
    visit("overlap", p.overlap);
    visit("half_life", p.half_life);
    visit("remember", p.remember);
    visit("refine", p.refine);
    visit("threads", p.threads);
    visit("warm", p.warm);
    visit("gate", p.gate);
    visit("head", p.head);
    visit("queue", p.queue);
    visit("pair_ms", p.pair_ms);
    visit("patience_ms", p.patience_ms);
    visit("depth_unit", p.depth_unit);
    visit("pose", p.pose);
    visit("world", p.world);
    visit("scene", p.scene);
    visit("snapshot", p.snapshot);
    visit("state", p.state);
    visit("resume", p.resume);
    visit("lines", p.lines);
    visit("max_ms", p.max_ms);
}

// The wrapper's services for the node.
class outlet
{
  public:
    virtual ~outlet() = default;
    virtual void cloud(const t3r_scene &scene, int64_t stamp_ns, const char *world) = 0;
    virtual void info(const std::string &line) = 0;
    virtual void warn(const std::string &line) = 0;
    // With poses by tf only: finds the pose of `camera` in the world at that time.
    virtual frame_feed_found locate(int64_t stamp_ns, const std::string &world, const char *camera,
                                    t3r_ros_pose &pose) = 0;
};

class node
{
  public:
    // Throws std::runtime_error with the reason if parameters are unusable.
    node(const parameters &given, outlet &out);
    ~node();
    node(const node &) = delete;
    node &operator=(const node &) = delete;

    // `message`: a shared pointer, boost's or the standard library's; now_ns: of any steady clock.
    template <class Pointer> void image(frame_feed_topic topic, const Pointer &message, int64_t now_ns)
    {
        const t3r_ros_image image = image_of(*message);
        frame_feed_image(feed_, topic, &image, own(message), now_ns);
    }
    template <class Pointer> void compressed(frame_feed_topic topic, const Pointer &message, int64_t now_ns)
    {
        const t3r_ros_compressed image = compressed_of(*message);
        frame_feed_compressed(feed_, topic, &image, own(message), now_ns);
    }
    // The full name of the topic of colour, after remapping.
    void colour_topic(const std::string &name)
    {
        frame_feed_colour_topic(feed_, name.c_str());
    }
    template <class Info> void camera_info(const Info &message, int64_t now_ns)
    {
        const t3r_ros_camera_info info = camera_info_of(message);
        frame_feed_camera_info(feed_, &info, now_ns);
    }
    void pose(const t3r_ros_pose &pose, int64_t now_ns)
    {
        frame_feed_pose(feed_, &pose, now_ns);
    }
    // Adds the transforms of a TFMessage to a buffer of tf2, which refuses rotations that are not normalised.
    template <class Message, class Buffer>
    void transforms(const Message &message, Buffer &frames, bool is_static, int64_t now_ns)
    {
        for (auto transform : message.transforms) {
            const t3r_ros_pose pose = transform_pose_of(transform);
            if (frame_feed_transform(feed_, &pose, now_ns)) {
                normalise(transform.transform.rotation);
                frames.setTransform(transform, "tf", is_static);
            }
        }
        tick(now_ns);
    }
    void tick(int64_t now_ns)
    {
        frame_feed_tick(feed_, now_ns);
    }

    // Writes the scene to the parameter's file; returns false with the reason in `told`.
    bool save(std::string &told) const;
    std::string summary() const;

  private:
    // Keeps a message alive until the feed releases it.
    struct kept {
        virtual ~kept() = default;
    };
    template <class Pointer> struct kept_message : kept {
        explicit kept_message(const Pointer &message) : pointer(message)
        {
        }
        Pointer pointer;
    };
    template <class Pointer> static void *own(const Pointer &message)
    {
        return static_cast<kept *>(new kept_message<Pointer>(message));
    }

    void frame(int64_t stamp_ns, const char *world, const t3r_frame &frame, const t3r_camera &camera, int64_t now_ns);
    void warn(frame_feed_topic topic, const char *reason) const;

    parameters parameters_;
    outlet &out_;
    keyframe_map *map_ = nullptr;
    frame_feed *feed_ = nullptr;
};

} // namespace trim3r_ros

#endif
