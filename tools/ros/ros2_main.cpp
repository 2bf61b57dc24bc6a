/* SPDX-License-Identifier: Apache-2.0 */
#include "ros/ros2_node.hpp"

int main(int argc, char **argv)
{
    rclcpp::init(argc, argv);
    int code = 0;
    try {
        rclcpp::spin(std::make_shared<trim3r_ros::ros2_node>());
    } catch (const std::exception &error) {
        RCLCPP_ERROR(rclcpp::get_logger("trim3r"), "%s", error.what());
        code = 1;
    }
    rclcpp::shutdown();
    return code;
}
