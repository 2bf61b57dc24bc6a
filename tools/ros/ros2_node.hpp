// The node for ROS 2: topics, parameters and services of rclcpp. docs/ros.md describes them.
#ifndef TRIM3R_TOOLS_ROS2_NODE_HPP
#define TRIM3R_TOOLS_ROS2_NODE_HPP

#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include <geometry_msgs/msg/pose_stamped.hpp>
#include <geometry_msgs/msg/transform_stamped.hpp>
#include <nav_msgs/msg/odometry.hpp>
#include <rclcpp/rclcpp.hpp>
#include <sensor_msgs/msg/camera_info.hpp>
#include <sensor_msgs/msg/compressed_image.hpp>
#include <sensor_msgs/msg/image.hpp>
#include <sensor_msgs/msg/point_cloud2.hpp>
#include <std_srvs/srv/trigger.hpp>
#include <tf2/buffer_core.h>
#include <tf2/exceptions.h>
#include <tf2_msgs/msg/tf_message.hpp>

#include "ros/node.hpp"

namespace trim3r_ros
{

class ros2_node : public rclcpp::Node, public outlet
{
  public:
    explicit ros2_node(const rclcpp::NodeOptions &options = rclcpp::NodeOptions());
    ~ros2_node() override;

  private:
    void subscribe_images(const rclcpp::QoS &qos);
    void subscribe_poses(const std::string &kind);
    void add(const tf2_msgs::msg::TFMessage &message, bool is_static);
    void save(std_srvs::srv::Trigger::Response &response) const;

    void cloud(const t3r_scene &scene, int64_t stamp_ns, const char *world) override;
    void info(const std::string &line) override;
    void warn(const std::string &line) override;
    frame_feed_found locate(int64_t stamp_ns, const std::string &world, const char *camera,
                            t3r_ros_pose &pose) override;

    // Keeps a subscription; its callback receives the message's shared pointer.
    template <class Message, class Callback>
    void subscribe(const std::string &topic, const rclcpp::QoS &qos, Callback callback)
    {
        topics_.push_back(create_subscription<Message>(
            topic, qos, [callback](const typename Message::ConstSharedPtr &message) { callback(message); }));
    }

    std::vector<rclcpp::SubscriptionBase::SharedPtr> topics_;
    rclcpp::Publisher<sensor_msgs::msg::PointCloud2>::SharedPtr clouds_;
    rclcpp::Service<std_srvs::srv::Trigger>::SharedPtr save_;
    rclcpp::TimerBase::SharedPtr timer_;
    tf2::BufferCore frames_;
    std::unique_ptr<node> node_;
};

} // namespace trim3r_ros

#endif
