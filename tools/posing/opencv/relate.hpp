/* SPDX-License-Identifier: Apache-2.0 */
// The motion that a pair's matches show; what cannot be known is refused.
#ifndef TRIM3R_TOOLS_POSING_OPENCV_RELATE_HPP
#define TRIM3R_TOOLS_POSING_OPENCV_RELATE_HPP

#include <string>

#include "pair.hpp"

constexpr unsigned MATCHES_LEAST = 20; // that agree with a motion

struct Refusal {
    std::string why;
};

template <typename... Arguments> [[noreturn]] void refuse(const char *format, Arguments... arguments)
{
    throw Refusal{cv::format(format, arguments...)};
}

// Refuses fewer than MATCHES_LEAST inliers.
void check_number(const Pair &pair, const std::vector<size_t> &inliers);

Motion relate_by_colour(const Pair &pair);
Motion relate_by_depth(const Pair &pair);

#endif
