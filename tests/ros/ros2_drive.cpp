/* SPDX-License-Identifier: Apache-2.0 */
// ros2_drive RECORDING CLOUD SCENE KIND: runs the node for ROS 2 in one process, on real messages of ROS 2 and the
// stand-in of rclcpp. Publishes the recording's frames, prints each cloud as a line of JSON and each log line on
// stderr, and writes the points of the last cloud. KIND: the source of poses (pose, odometry, transform, tf), or
// `faults`, where some messages are wrong.
#include <algorithm>
#include <cmath>
#include <limits>

#include "play.hpp"
#include "ros/ros2_node.hpp"

namespace
{

using sensor_msgs::msg::CameraInfo;
using sensor_msgs::msg::Image;

void set_stamp(builtin_interfaces::msg::Time &stamp, int64_t nanoseconds)
{
    stamp.sec = static_cast<int32_t>(nanoseconds / 1000000000);
    stamp.nanosec = static_cast<uint32_t>(nanoseconds % 1000000000);
}

void set_arrays(CameraInfo &info, const double k[9], const double *d, uint32_t d_count)
{
    std::copy(k, k + 9, info.k.begin());
    info.d.assign(d, d + d_count);
}

class player
{
  public:
    player(const char *path, const std::string &kind) : node_("play"), recording_(path), kind_(kind)
    {
        image_ = node_.create_publisher<Image>("image", rclcpp::SensorDataQoS());
        depth_ = node_.create_publisher<Image>("depth", rclcpp::SensorDataQoS());
        info_ = node_.create_publisher<CameraInfo>("camera_info", rclcpp::SensorDataQoS());
        pose_ = node_.create_publisher<geometry_msgs::msg::PoseStamped>("pose", rclcpp::QoS(1));
        odometry_ = node_.create_publisher<nav_msgs::msg::Odometry>("odometry", rclcpp::QoS(1));
        transform_ = node_.create_publisher<geometry_msgs::msg::TransformStamped>("transform", rclcpp::QoS(1));
        tf_ = node_.create_publisher<tf2_msgs::msg::TFMessage>("/tf", rclcpp::QoS(1));
    }

    void run()
    {
        for (uint32_t i = 0; i < recording_.frames(); i++) {
            if (kind_ == "faults" && i > 0) {
                send_wrong(i);
            }
            send(i, [](Image &, Image &, CameraInfo &, t3r_ros_pose &) {});
        }
    }

  private:
    // images: whether the pose comes with images and camera_info.
    template <class Change> void send(uint32_t frame, Change change, bool images = true)
    {
        auto image = play::image_of<Image>(recording_.message(frame, T3R_USE_COLOUR), set_stamp);
        auto depth = play::image_of<Image>(recording_.message(frame, T3R_USE_DEPTH), set_stamp);
        auto info =
            play::camera_info_of<CameraInfo>(recording_.message(frame, T3R_USE_CAMERA_INFO), set_stamp, set_arrays);
        auto pose = play::recorded_pose(recording_.message(frame, T3R_USE_POSE));
        change(image, depth, info, pose);
        send_pose(pose, image.header.frame_id);
        if (images) {
            info_->publish(info);
            depth_->publish(depth);
            image_->publish(image);
        }
    }

    void send_pose(const t3r_ros_pose &pose, const std::string &camera)
    {
        geometry_msgs::msg::TransformStamped transform;
        play::fill_header(transform.header, pose.header, set_stamp);
        transform.child_frame_id = camera;
        play::fill_pose(pose, transform.transform.translation, transform.transform.rotation);
        if (kind_ == "odometry") {
            nav_msgs::msg::Odometry message;
            message.header = transform.header;
            message.child_frame_id = camera;
            play::fill_pose(pose, message.pose.pose.position, message.pose.pose.orientation);
            odometry_->publish(message);
        } else if (kind_ == "transform") {
            transform_->publish(transform);
        } else if (kind_ == "tf") {
            tf2_msgs::msg::TFMessage message;
            message.transforms.push_back(transform);
            transform.transform.rotation.w = std::numeric_limits<double>::quiet_NaN(); // is left out
            message.transforms.push_back(transform);
            tf_->publish(message);
        } else {
            geometry_msgs::msg::PoseStamped message;
            message.header = transform.header;
            play::fill_pose(pose, message.pose.position, message.pose.orientation);
            pose_->publish(message);
        }
    }

    // Sends a wrong copy of the frame of that number, stamped a millisecond earlier, before the true one.
    void send_wrong(uint32_t frame)
    {
        constexpr int64_t earlier_ns = 1000000;
        send(
            frame,
            [frame](Image &image, Image &depth, CameraInfo &info, t3r_ros_pose &pose) {
                pose.header.stamp_ns -= earlier_ns;
                set_stamp(image.header.stamp, pose.header.stamp_ns);
                set_stamp(depth.header.stamp, pose.header.stamp_ns);
                switch (frame) {
                case 1:
                    image.encoding = "mono\033[2J";
                    break;
                case 2:
                    image.step = image.width;
                    break;
                case 3:
                    image.data.resize(image.data.size() / 2);
                    break;
                case 4:
                    depth.header.frame_id = "elsewhere";
                    break;
                case 5:
                    depth.encoding = "32SC1";
                    break;
                case 6:
                    info.k[0] = std::nan("");
                    break;
                case 7:
                    pose.position_f64[1] = trim3r_ros::bits_of(std::nan(""));
                    break;
                case 8:
                    info.d.assign(40, 0.25);
                    info.distortion_model = "plumb_bob";
                    break;
                case 9:
                    image.width = 1u << 31;
                    break;
                default:
                    break;
                }
            },
            frame != 7); // a pose that is left out costs no image
    }

    rclcpp::Node node_;
    play::recording recording_;
    std::string kind_;
    rclcpp::Publisher<Image>::SharedPtr image_, depth_;
    rclcpp::Publisher<CameraInfo>::SharedPtr info_;
    rclcpp::Publisher<geometry_msgs::msg::PoseStamped>::SharedPtr pose_;
    rclcpp::Publisher<nav_msgs::msg::Odometry>::SharedPtr odometry_;
    rclcpp::Publisher<geometry_msgs::msg::TransformStamped>::SharedPtr transform_;
    rclcpp::Publisher<tf2_msgs::msg::TFMessage>::SharedPtr tf_;
};

void drive(char **argv)
{
    const std::string kind = argv[4];
    const auto options =
        rclcpp::NodeOptions().parameter_overrides({{"width", 64},
                                                   {"height", 64},
                                                   {"gaussians", 1000},
                                                   {"every", 1},
                                                   {"scene", std::string(argv[3])},
                                                   {"pose", kind == "faults" ? std::string("pose") : kind},
                                                   {"world", std::string("world")}});
    const auto node = std::make_shared<trim3r_ros::ros2_node>(options);
    rclcpp::Node listener("listen");
    const auto clouds = listener.create_subscription<sensor_msgs::msg::PointCloud2>(
        "/trim3r/cloud", rclcpp::QoS(1), [&](const sensor_msgs::msg::PointCloud2::ConstSharedPtr &message) {
            const auto &stamp = message->header.stamp;
            play::tell(*message, stamp.sec * INT64_C(1000000000) + stamp.nanosec, argv[2]);
        });
    player(argv[1], kind).run();
    using service = rclcpp::Service<std_srvs::srv::Trigger>;
    const auto save = std::any_cast<service::SharedPtr>(rclcpp::services().at("/trim3r/save"));
    const auto response = std::make_shared<std_srvs::srv::Trigger::Response>();
    save->call(std::make_shared<std_srvs::srv::Trigger::Request>(), response);
    if (!response->success) {
        throw std::runtime_error("the scene is not saved: " + response->message);
    }
}

} // namespace

int main(int argc, char **argv)
{
    try {
        if (argc != 5) {
            throw std::runtime_error("usage: ros2_drive RECORDING CLOUD SCENE KIND");
        }
        drive(argv);
    } catch (const std::exception &error) {
        std::fprintf(stderr, "ros2_drive: %s\n", error.what());
        return 1;
    }
    return 0;
}
