/* Names and definitions of the ROS 2 messages in use: the fields of ros2/common_interfaces (foxy and later), without
 * comments. */
#include "ros_messages.h"

#define RULER "================================================================================\n"

#define HEADER                                                                                                         \
    RULER "MSG: std_msgs/Header\n"                                                                                     \
          "builtin_interfaces/Time stamp\n"                                                                            \
          "string frame_id\n" RULER "MSG: builtin_interfaces/Time\n"                                                   \
          "int32 sec\n"                                                                                                \
          "uint32 nanosec\n"

#define QUATERNION                                                                                                     \
    RULER "MSG: geometry_msgs/Quaternion\n"                                                                            \
          "float64 x 0\n"                                                                                              \
          "float64 y 0\n"                                                                                              \
          "float64 z 0\n"                                                                                              \
          "float64 w 1\n"

#define TRANSFORM                                                                                                      \
    RULER "MSG: geometry_msgs/Transform\n"                                                                             \
          "geometry_msgs/Vector3 translation\n"                                                                        \
          "geometry_msgs/Quaternion rotation\n" RULER "MSG: geometry_msgs/Vector3\n" XYZ QUATERNION

#define XYZ "float64 x\nfloat64 y\nfloat64 z\n"

const char *const t3r_ros_names[T3R_ROS_TYPE_COUNT] = {
    [T3R_ROS_IMAGE] = "sensor_msgs/msg/Image",
    [T3R_ROS_CAMERA_INFO] = "sensor_msgs/msg/CameraInfo",
    [T3R_ROS_POSE] = "geometry_msgs/msg/PoseStamped",
    [T3R_ROS_TRANSFORM] = "geometry_msgs/msg/TransformStamped",
    [T3R_ROS_TF] = "tf2_msgs/msg/TFMessage",
    [T3R_ROS_ODOMETRY] = "nav_msgs/msg/Odometry",
    [T3R_ROS_POSE_COVARIANCE] = "geometry_msgs/msg/PoseWithCovarianceStamped",
    [T3R_ROS_COMPRESSED_IMAGE] = "sensor_msgs/msg/CompressedImage",
};

const char *const t3r_ros_schemas[T3R_ROS_TYPE_COUNT] = {
    [T3R_ROS_IMAGE] = "std_msgs/Header header\n"
                      "uint32 height\n"
                      "uint32 width\n"
                      "string encoding\n"
                      "uint8 is_bigendian\n"
                      "uint32 step\n"
                      "uint8[] data\n" HEADER,
    [T3R_ROS_CAMERA_INFO] = "std_msgs/Header header\n"
                            "uint32 height\n"
                            "uint32 width\n"
                            "string distortion_model\n"
                            "float64[] d\n"
                            "float64[9] k\n"
                            "float64[9] r\n"
                            "float64[12] p\n"
                            "uint32 binning_x\n"
                            "uint32 binning_y\n"
                            "sensor_msgs/RegionOfInterest roi\n" HEADER RULER "MSG: sensor_msgs/RegionOfInterest\n"
                            "uint32 x_offset\n"
                            "uint32 y_offset\n"
                            "uint32 height\n"
                            "uint32 width\n"
                            "bool do_rectify\n",
    [T3R_ROS_POSE] = "std_msgs/Header header\n"
                     "geometry_msgs/Pose pose\n" HEADER RULER "MSG: geometry_msgs/Pose\n"
                     "geometry_msgs/Point position\n"
                     "geometry_msgs/Quaternion orientation\n" RULER "MSG: geometry_msgs/Point\n" XYZ QUATERNION,
    [T3R_ROS_TRANSFORM] = "std_msgs/Header header\n"
                          "string child_frame_id\n"
                          "geometry_msgs/Transform transform\n" HEADER TRANSFORM,
    [T3R_ROS_TF] = "geometry_msgs/TransformStamped[] transforms\n" RULER "MSG: geometry_msgs/TransformStamped\n"
                   "std_msgs/Header header\n"
                   "string child_frame_id\n"
                   "geometry_msgs/Transform transform\n" HEADER TRANSFORM,
};

const char *const t3r_ros_log_name = "rcl_interfaces/msg/Log";
const char *const t3r_ros_log_schema = "byte DEBUG=10\n"
                                       "byte INFO=20\n"
                                       "byte WARN=30\n"
                                       "byte ERROR=40\n"
                                       "byte FATAL=50\n"
                                       "builtin_interfaces/Time stamp\n"
                                       "uint8 level\n"
                                       "string name\n"
                                       "string msg\n"
                                       "string file\n"
                                       "string function\n"
                                       "uint32 line\n" RULER "MSG: builtin_interfaces/Time\n"
                                       "int32 sec\n"
                                       "uint32 nanosec\n";
