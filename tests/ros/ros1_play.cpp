/* SPDX-License-Identifier: Apache-2.0 */
// ros1_play RECORDING KEYFRAMES CLOUD [tf]: publishes the recording's frames to a running node, waits for that many
// clouds, prints each as a line of JSON, writes the points of the last one to the file CLOUD, then calls the node's
// service `save`. Poses are messages of their own, or with `tf` transforms of a body that carries the camera.
#include <cstdlib>

#include <geometry_msgs/PoseStamped.h>
#include <ros/ros.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/PointCloud2.h>
#include <std_srvs/Trigger.h>
#include <tf2_msgs/TFMessage.h>

#include "play.hpp"

namespace
{

constexpr double patience_s = 60;

void set_stamp(ros::Time &stamp, int64_t nanoseconds)
{
    stamp.fromNSec(static_cast<uint64_t>(nanoseconds));
}

void set_arrays(sensor_msgs::CameraInfo &info, const double k[9], const double *d, uint32_t d_count)
{
    std::copy(k, k + 9, info.K.begin());
    info.D.assign(d, d + d_count);
}

template <class Done> void wait_for(const char *what, Done done)
{
    const ros::WallTime until = ros::WallTime::now() + ros::WallDuration(patience_s);
    while (!done()) {
        if (!ros::ok() || ros::WallTime::now() > until) {
            throw std::runtime_error(std::string("waited in vain for ") + what);
        }
        ros::spinOnce();
        ros::WallDuration(0.005).sleep();
    }
}

class player
{
  public:
    player(const char *path, const char *cloud, bool by_tf) : recording_(path), cloud_(cloud), by_tf_(by_tf)
    {
        image_ = node_.advertise<sensor_msgs::Image>("/image", 100);
        depth_ = node_.advertise<sensor_msgs::Image>("/depth", 100);
        info_ = node_.advertise<sensor_msgs::CameraInfo>("/camera_info", 100);
        pose_ = by_tf ? node_.advertise<tf2_msgs::TFMessage>("/tf", 100)
                      : node_.advertise<geometry_msgs::PoseStamped>("/pose", 100);
        clouds_ = node_.subscribe<sensor_msgs::PointCloud2>(
            "/trim3r/cloud", 100, [this](const sensor_msgs::PointCloud2ConstPtr &message) {
                play::tell(*message, static_cast<int64_t>(message->header.stamp.toNSec()), cloud_);
                heard_++;
            });
    }

    void run(uint32_t keyframes)
    {
        wait_for("the node", [this] {
            return image_.getNumSubscribers() > 0 && depth_.getNumSubscribers() > 0 && info_.getNumSubscribers() > 0 &&
                   pose_.getNumSubscribers() > 0 && clouds_.getNumPublishers() > 0;
        });
        for (uint32_t i = 0; i < recording_.frames(); i++) {
            send(i);
            ros::spinOnce();
            ros::WallDuration(0.02).sleep();
        }
        wait_for("clouds", [this, keyframes] { return heard_ >= keyframes; });
        std_srvs::Trigger saved;
        if (!ros::service::call("/trim3r/save", saved) || !saved.response.success) {
            throw std::runtime_error("the scene is not saved: " + saved.response.message);
        }
    }

  private:
    void send(uint32_t frame)
    {
        send_pose(play::recorded_pose(recording_.message(frame, T3R_USE_POSE)),
                  recording_.message(frame, T3R_USE_COLOUR));
        info_.publish(play::camera_info_of<sensor_msgs::CameraInfo>(recording_.message(frame, T3R_USE_CAMERA_INFO),
                                                                    set_stamp, set_arrays));
        depth_.publish(play::image_of<sensor_msgs::Image>(recording_.message(frame, T3R_USE_DEPTH), set_stamp));
        image_.publish(play::image_of<sensor_msgs::Image>(recording_.message(frame, T3R_USE_COLOUR), set_stamp));
    }

    void send_pose(const t3r_ros_pose &pose, const t3r_recorded_message &image)
    {
        if (!by_tf_) {
            geometry_msgs::PoseStamped message;
            play::fill_header(message.header, pose.header, set_stamp);
            play::fill_pose(pose, message.pose.position, message.pose.orientation);
            pose_.publish(message);
            return;
        }
        // the world holds the body, at the camera's place; the body carries the camera
        tf2_msgs::TFMessage message;
        message.transforms.resize(2);
        play::fill_header(message.transforms[0].header, pose.header, set_stamp);
        message.transforms[0].child_frame_id = "body";
        play::fill_pose(pose, message.transforms[0].transform.translation, message.transforms[0].transform.rotation);
        message.transforms[1].header.stamp = message.transforms[0].header.stamp;
        message.transforms[1].header.frame_id = "body";
        message.transforms[1].child_frame_id = play::image_of<sensor_msgs::Image>(image, set_stamp).header.frame_id;
        message.transforms[1].transform.rotation.w = 1;
        pose_.publish(message);
    }

    play::recording recording_;
    const char *cloud_;
    bool by_tf_;
    uint32_t heard_ = 0;
    ros::NodeHandle node_;
    ros::Publisher image_, depth_, info_, pose_;
    ros::Subscriber clouds_;
};

} // namespace

int main(int argc, char **argv)
{
    ros::init(argc, argv, "play");
    try {
        if (argc < 4) {
            throw std::runtime_error("usage: ros1_play RECORDING KEYFRAMES CLOUD [tf]");
        }
        player(argv[1], argv[3], argc > 4).run(static_cast<uint32_t>(std::atoi(argv[2])));
    } catch (const std::exception &error) {
        std::fprintf(stderr, "ros1_play: %s\n", error.what());
        return 1;
    }
    return 0;
}
