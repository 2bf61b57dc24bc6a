/* SPDX-License-Identifier: Apache-2.0 */
// The node for ROS 1: topics, parameters and services of roscpp. docs/ros.md describes them.
#include <csignal>
#include <cstdio>
#include <memory>

#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/TransformStamped.h>
#include <nav_msgs/Odometry.h>
#include <ros/ros.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/CompressedImage.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/PointCloud2.h>
#include <std_srvs/Trigger.h>
#include <tf2/buffer_core.h>
#include <tf2/exceptions.h>
#include <tf2_msgs/TFMessage.h>

#include "ros/node.hpp"

namespace
{

int64_t now_ns()
{
    return static_cast<int64_t>(ros::SteadyTime::now().toNSec());
}

class shell : public trim3r_ros::outlet
{
  public:
    shell() : own_("~")
    {
        trim3r_ros::parameters given;
        trim3r_ros::visit_parameters(given, [&](const char *name, auto &field) { own_.getParam(name, field); });
        clouds_ = own_.advertise<sensor_msgs::PointCloud2>("cloud", 1, true);
        node_ = std::make_unique<trim3r_ros::node>(given, *this);
        const auto queue = static_cast<uint32_t>(given.queue);
        subscribe_images(queue);
        topics_.push_back(any_.subscribe("camera_info", queue, &shell::camera_info, this));
        subscribe_poses(given.pose);
        save_ = own_.advertiseService("save", &shell::save, this);
        timer_ = own_.createWallTimer(ros::WallDuration(0.05),
                                      [this](const ros::WallTimerEvent &) { node_->tick(now_ns()); });
    }

    ~shell() override
    {
        std_srvs::Trigger::Request request;
        std_srvs::Trigger::Response response;
        save(request, response);
        info((response.success ? "saved " : "not saved: ") + response.message);
        info(node_->summary());
    }

  private:
    void subscribe_images(uint32_t queue)
    {
        using plain = sensor_msgs::ImageConstPtr;
        using packed = sensor_msgs::CompressedImageConstPtr;
        node_->colour_topic(any_.resolveName("image"));
        for (const frame_feed_topic topic : {FRAME_FEED_COLOUR, FRAME_FEED_DEPTH}) {
            const std::string name = topic == FRAME_FEED_COLOUR ? "image" : "depth";
            topics_.push_back(any_.subscribe<sensor_msgs::Image>(
                name, queue, [this, topic](const plain &message) { node_->image(topic, message, now_ns()); }));
            topics_.push_back(any_.subscribe<sensor_msgs::CompressedImage>(
                name + "/compressed", queue,
                [this, topic](const packed &message) { node_->compressed(topic, message, now_ns()); }));
        }
    }

    void subscribe_poses(const std::string &kind)
    {
        constexpr uint32_t queue = 100;
        if (kind == "pose") {
            topics_.push_back(any_.subscribe("pose", queue, &shell::pose, this));
        } else if (kind == "odometry") {
            topics_.push_back(any_.subscribe("odometry", queue, &shell::odometry, this));
        } else if (kind == "transform") {
            topics_.push_back(any_.subscribe("transform", queue, &shell::transform, this));
        } else {
            topics_.push_back(any_.subscribe("/tf", queue, &shell::moving, this));
            topics_.push_back(any_.subscribe("/tf_static", queue, &shell::standing, this));
        }
    }

    void camera_info(const sensor_msgs::CameraInfoConstPtr &message)
    {
        node_->camera_info(*message, now_ns());
    }
    void pose(const geometry_msgs::PoseStampedConstPtr &message)
    {
        node_->pose(trim3r_ros::pose_of(*message), now_ns());
    }
    void odometry(const nav_msgs::OdometryConstPtr &message)
    {
        node_->pose(trim3r_ros::odometry_pose_of(*message), now_ns());
    }
    void transform(const geometry_msgs::TransformStampedConstPtr &message)
    {
        node_->pose(trim3r_ros::transform_pose_of(*message), now_ns());
    }
    void moving(const tf2_msgs::TFMessageConstPtr &message)
    {
        add(*message, false);
    }
    void standing(const tf2_msgs::TFMessageConstPtr &message)
    {
        add(*message, true);
    }
    void add(const tf2_msgs::TFMessage &message, bool is_static)
    {
        node_->transforms(message, frames_, is_static, now_ns());
    }

    bool save(std_srvs::Trigger::Request &, std_srvs::Trigger::Response &response)
    {
        std::string told;
        response.success = node_->save(told);
        response.message = told;
        return true;
    }

    void cloud(const t3r_scene &scene, int64_t stamp_ns, const char *world) override
    {
        sensor_msgs::PointCloud2 message;
        message.header.frame_id = world;
        message.header.stamp.fromNSec(static_cast<uint64_t>(stamp_ns));
        trim3r_ros::cloud_from(scene, message);
        clouds_.publish(message);
    }
    // roscpp prints nothing while it shuts down, but the scene saved then is worth a line.
    void info(const std::string &line) override
    {
        if (ros::ok()) {
            ROS_INFO("%s", line.c_str());
        } else {
            std::fprintf(stderr, "%s\n", line.c_str());
        }
    }
    void warn(const std::string &line) override
    {
        ROS_WARN("%s", line.c_str());
    }
    frame_feed_found locate(int64_t stamp_ns, const std::string &world, const char *camera, t3r_ros_pose &pose) override
    {
        ros::Time time;
        time.fromNSec(static_cast<uint64_t>(stamp_ns));
        try {
            pose = trim3r_ros::transform_pose_of(frames_.lookupTransform(world, camera, time));
            pose.header.frame_id = pose.child_frame_id = {};
            return FRAME_FEED_FOUND;
        } catch (const tf2::TransformException &) {
            return FRAME_FEED_NOT_YET;
        }
    }

    ros::NodeHandle any_, own_;
    ros::Publisher clouds_;
    std::vector<ros::Subscriber> topics_;
    ros::ServiceServer save_;
    ros::WallTimer timer_;
    tf2::BufferCore frames_;
    std::unique_ptr<trim3r_ros::node> node_;
};

} // namespace

int main(int argc, char **argv)
{
    ros::init(argc, argv, "trim3r");
    std::signal(SIGTERM, [](int) { ros::requestShutdown(); }); // as roscpp does for SIGINT: the scene is saved
    try {
        const shell here;
        ros::spin();
    } catch (const std::exception &error) {
        ROS_ERROR("%s", error.what());
        return 1;
    }
    return 0;
}
