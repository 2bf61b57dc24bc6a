/* SPDX-License-Identifier: Apache-2.0 */
// A stand-in for ROS 2's tf2, for tests only: Debian has ROS 1's. It finds transforms from a child to its parent at
// exactly the requested time, or static ones, and composes none.
#ifndef TRIM3R_STAND_IN_TF2_BUFFER_CORE_H
#define TRIM3R_STAND_IN_TF2_BUFFER_CORE_H

#include <chrono>
#include <map>
#include <string>
#include <tuple>

#include <geometry_msgs/msg/transform_stamped.hpp>
#include <tf2/exceptions.h>

namespace tf2
{

using TimePoint = std::chrono::time_point<std::chrono::system_clock, std::chrono::nanoseconds>;

class BufferCore
{
  public:
    bool setTransform(const geometry_msgs::msg::TransformStamped &transform, const std::string &,
                      bool is_static = false)
    {
        const int64_t time =
            is_static ? 0 : transform.header.stamp.sec * INT64_C(1000000000) + transform.header.stamp.nanosec;
        transforms_[{transform.header.frame_id, transform.child_frame_id, time}] = transform;
        return true;
    }
    geometry_msgs::msg::TransformStamped lookupTransform(const std::string &target, const std::string &source,
                                                         const TimePoint &time) const
    {
        for (const int64_t at : {int64_t{time.time_since_epoch().count()}, int64_t{0}}) {
            const auto found = transforms_.find({target, source, at});
            if (found != transforms_.end()) {
                return found->second;
            }
        }
        throw LookupException("there is no such transform");
    }

  private:
    std::map<std::tuple<std::string, std::string, int64_t>, geometry_msgs::msg::TransformStamped> transforms_;
};

} // namespace tf2

#endif
