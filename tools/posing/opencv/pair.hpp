/* SPDX-License-Identifier: Apache-2.0 */
// Matches of two views, how far a motion misses them, and the motion that misses them least.
#ifndef TRIM3R_TOOLS_POSING_OPENCV_PAIR_HPP
#define TRIM3R_TOOLS_POSING_OPENCV_PAIR_HPP

#include <vector>

#include <opencv2/core.hpp>
#include <opencv2/core/affine.hpp>

using Motion = cv::Affine3d; // from the first camera's axes to the second's

constexpr double DEGREE = CV_PI / 180;
constexpr double CONFIDENCE = 0.9999;        // that one sample has no outlier
const cv::Matx33d UNIT = cv::Matx33d::eye(); // the camera matrix of rays

// Matches as rays and depths in the first and the second camera; depth 0 is unknown.
struct Pair {
    std::vector<cv::Point2d> rays[2];
    std::vector<double> depth[2];
    double focal;
    double enlarged; // pixels of the pictures to one of the frames
    bool metric;     // errors are those of reprojected points where a depth is known, else all are epipolar

    size_t size() const
    {
        return rays[0].size();
    }
};

inline cv::Vec3d homogeneous(const cv::Point2d &ray)
{
    return {ray.x, ray.y, 1};
}

// Returns the degrees between two directions.
double angle(const cv::Vec3d &a, const cv::Vec3d &b);

// Returns the motion's essential matrix, of norm sqrt(2).
cv::Matx33d essential_of(const Motion &m);

// Returns the matches that the motion explains.
std::vector<size_t> inliers_of(const Pair &pair, const Motion &m);

// Returns the sum over all matches of the squared error relative to the inliers' band, at most 1 each.
double cost_of(const Pair &pair, const Motion &m);

// Returns the motion with the least squared error of its inliers (Cauchy's loss); without metric, |t| is 1.
Motion refined(const Pair &pair, Motion m);

// The inliers' remaining error, and standard deviations of the motion's parameters.
struct Uncertainty {
    double pixels, turn_degrees, direction_degrees;
};

Uncertainty uncertainty_of(const Pair &pair, const Motion &m, const std::vector<size_t> &inliers);

#endif
