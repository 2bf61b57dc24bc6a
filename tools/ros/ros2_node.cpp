/* SPDX-License-Identifier: Apache-2.0 */
#include "ros/ros2_node.hpp"

#include <utility>

namespace trim3r_ros
{

namespace
{

int64_t now_ns()
{
    const auto time = std::chrono::steady_clock::now().time_since_epoch();
    return std::chrono::duration_cast<std::chrono::nanoseconds>(time).count();
}

} // namespace

ros2_node::ros2_node(const rclcpp::NodeOptions &options) : rclcpp::Node("trim3r", options)
{
    parameters given;
    visit_parameters(given, [this](const char *name, auto &field) { field = declare_parameter(name, field); });
    clouds_ = create_publisher<sensor_msgs::msg::PointCloud2>("~/cloud", rclcpp::QoS(1).transient_local());
    node_ = std::make_unique<node>(given, *this);
    const auto depth = static_cast<size_t>(given.queue);
    const rclcpp::QoS sensor = rclcpp::SensorDataQoS().keep_last(depth);
    subscribe_images(sensor);
    node_->colour_topic(topics_.front()->get_topic_name());
    subscribe<sensor_msgs::msg::CameraInfo>("camera_info", sensor,
                                            [this](const auto &message) { node_->camera_info(*message, now_ns()); });
    subscribe_poses(given.pose);
    save_ = create_service<std_srvs::srv::Trigger>(
        "~/save", [this](std_srvs::srv::Trigger::Request::SharedPtr,
                         std_srvs::srv::Trigger::Response::SharedPtr response) { save(*response); });
    timer_ = create_wall_timer(std::chrono::milliseconds(50), [this] { node_->tick(now_ns()); });
}

ros2_node::~ros2_node()
{
    std_srvs::srv::Trigger::Response response;
    save(response);
    info((response.success ? "saved " : "not saved: ") + response.message);
    info(node_->summary());
}

void ros2_node::subscribe_images(const rclcpp::QoS &qos)
{
    for (const frame_feed_topic topic : {FRAME_FEED_COLOUR, FRAME_FEED_DEPTH}) {
        const std::string name = topic == FRAME_FEED_COLOUR ? "image" : "depth";
        subscribe<sensor_msgs::msg::Image>(
            name, qos, [this, topic](const auto &message) { node_->image(topic, message, now_ns()); });
        subscribe<sensor_msgs::msg::CompressedImage>(name + "/compressed", qos, [this, topic](const auto &message) {
            node_->compressed(topic, message, now_ns());
        });
    }
}

void ros2_node::subscribe_poses(const std::string &kind)
{
    const rclcpp::QoS qos = rclcpp::QoS(100);
    if (kind == "pose") {
        subscribe<geometry_msgs::msg::PoseStamped>(
            "pose", qos, [this](const auto &message) { node_->pose(pose_of(*message), now_ns()); });
    } else if (kind == "odometry") {
        subscribe<nav_msgs::msg::Odometry>(
            "odometry", qos, [this](const auto &message) { node_->pose(odometry_pose_of(*message), now_ns()); });
    } else if (kind == "transform") {
        subscribe<geometry_msgs::msg::TransformStamped>(
            "transform", qos, [this](const auto &message) { node_->pose(transform_pose_of(*message), now_ns()); });
    } else {
        subscribe<tf2_msgs::msg::TFMessage>("/tf", qos, [this](const auto &message) { add(*message, false); });
        subscribe<tf2_msgs::msg::TFMessage>("/tf_static", rclcpp::QoS(100).transient_local(),
                                            [this](const auto &message) { add(*message, true); });
    }
}

void ros2_node::add(const tf2_msgs::msg::TFMessage &message, bool is_static)
{
    node_->transforms(message, frames_, is_static, now_ns());
}

void ros2_node::save(std_srvs::srv::Trigger::Response &response) const
{
    response.success = node_->save(response.message);
}

void ros2_node::cloud(const t3r_scene &scene, int64_t stamp_ns, const char *world)
{
    auto message = std::make_unique<sensor_msgs::msg::PointCloud2>();
    message->header.frame_id = world;
    message->header.stamp.sec = static_cast<int32_t>(stamp_ns / second_ns);
    message->header.stamp.nanosec = static_cast<uint32_t>(stamp_ns % second_ns);
    cloud_from(scene, *message);
    clouds_->publish(std::move(message));
}

void ros2_node::info(const std::string &line)
{
    RCLCPP_INFO(get_logger(), "%s", line.c_str());
}

void ros2_node::warn(const std::string &line)
{
    RCLCPP_WARN(get_logger(), "%s", line.c_str());
}

frame_feed_found ros2_node::locate(int64_t stamp_ns, const std::string &world, const char *camera, t3r_ros_pose &pose)
{
    try {
        const tf2::TimePoint time{std::chrono::nanoseconds(stamp_ns)};
        pose = transform_pose_of(frames_.lookupTransform(world, camera, time));
        pose.header.frame_id = pose.child_frame_id = {};
        return FRAME_FEED_FOUND;
    } catch (const tf2::TransformException &) {
        return FRAME_FEED_NOT_YET;
    }
}

} // namespace trim3r_ros
