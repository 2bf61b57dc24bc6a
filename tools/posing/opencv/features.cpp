/* SPDX-License-Identifier: Apache-2.0 */
#include "features.hpp"

#include <algorithm>
#include <vector>

#include <opencv2/features2d.hpp>

namespace
{

constexpr double CONTRAST_LEAST = 0.005; // SIFT's default, 0.04, finds too few features in small pictures
constexpr float NEXT_LEAST = 0.9f;       // distance of the best match relative to the next

cv::Mat descriptors_of(const pose_features *features)
{
    cv::Mat out;
    cv::Mat(static_cast<int>(features->count), DESCRIPTOR_BYTES, CV_8U, features->descriptors).convertTo(out, CV_32F);
    return out;
}

// Returns for each of a's features the one of b that is clearly most like it, or -1.
std::vector<int> likest(const cv::Mat &a, const cv::Mat &b)
{
    std::vector<std::vector<cv::DMatch>> nearest;
    std::vector<int> out(static_cast<size_t>(a.rows), -1);
    if (!a.empty() && !b.empty()) {
        cv::BFMatcher().knnMatch(a, b, nearest, 2);
    }
    for (const auto &two : nearest) {
        if (two.size() == 2 && two[0].distance < NEXT_LEAST * two[1].distance) {
            out[static_cast<size_t>(two[0].queryIdx)] = two[0].trainIdx;
        }
    }
    return out;
}

} // namespace

void find_features(const uint8_t *grey, uint32_t width, uint32_t height, pose_features *out)
{
    const cv::Mat picture(static_cast<int>(height), static_cast<int>(width), CV_8U, const_cast<uint8_t *>(grey));
    std::vector<cv::KeyPoint> found;
    cv::Mat descriptors;
    cv::SIFT::create(FEATURES_MOST, 3, CONTRAST_LEAST)->detectAndCompute(picture, cv::noArray(), found, descriptors);
    out->count = std::min(static_cast<uint32_t>(found.size()), FEATURES_MOST);
    for (uint32_t i = 0; i < out->count; i++) {
        out->rays[i][0] = found[i].pt.x;
        out->rays[i][1] = found[i].pt.y;
        // distances of roots compare histograms better (RootSIFT: Arandjelovic, Zisserman 2012)
        cv::Mat one = descriptors.row(static_cast<int>(i)), root;
        cv::sqrt(one / std::max(1.0, cv::norm(one, cv::NORM_L1)), root);
        root.convertTo(cv::Mat(1, DESCRIPTOR_BYTES, CV_8U, out->descriptors[i]), CV_8U, 512);
    }
}

uint32_t match_features(const pose_features *a, const pose_features *b, pose_match *matches)
{
    const cv::Mat from = descriptors_of(a), to = descriptors_of(b);
    const std::vector<int> there = likest(from, to), back = likest(to, from);
    uint32_t count = 0;
    for (size_t i = 0; i < there.size(); i++) {
        if (there[i] >= 0 && back[static_cast<size_t>(there[i])] == static_cast<int>(i)) {
            matches[count++] = {static_cast<uint32_t>(i), static_cast<uint32_t>(there[i])};
        }
    }
    return count;
}
