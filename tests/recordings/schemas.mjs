/* SPDX-License-Identifier: Apache-2.0 */
// The ROS 2 messages as a ROS 2 installation defines them (ros2/common_interfaces), for files of the reference writer.
const header = `
================================================================================
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
================================================================================
MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec`;

const quaternion = `
================================================================================
MSG: geometry_msgs/Quaternion
float64 x 0
float64 y 0
float64 z 0
float64 w 1`;

export const SCHEMAS = {
  "sensor_msgs/msg/Image": `# This message contains an uncompressed image
std_msgs/Header header # Header timestamp should be acquisition time of image
uint32 height                # image height, that is, number of rows
uint32 width                 # image width, that is, number of columns
string encoding       # Encoding of pixels -- channel meaning, ordering, size
uint8 is_bigendian    # is this data bigendian?
uint32 step           # Full row length in bytes
uint8[] data          # actual matrix data, size is (step * rows)${header}`,
  "sensor_msgs/msg/CameraInfo": `std_msgs/Header header
uint32 height
uint32 width
string distortion_model
float64[] d
float64[9]  k # 3x3 row-major matrix
float64[9]  r # 3x3 row-major matrix
float64[12] p # 3x4 row-major matrix
uint32 binning_x
uint32 binning_y
RegionOfInterest roi${header}
================================================================================
MSG: sensor_msgs/RegionOfInterest
uint32 x_offset
uint32 y_offset
uint32 height
uint32 width
bool do_rectify`,
  "geometry_msgs/msg/TransformStamped": `std_msgs/Header header
string child_frame_id
Transform transform${header}
================================================================================
MSG: geometry_msgs/Transform
Vector3 translation
Quaternion rotation
================================================================================
MSG: geometry_msgs/Vector3
float64 x
float64 y
float64 z${quaternion}`,
};
