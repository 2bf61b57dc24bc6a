/* SPDX-License-Identifier: Apache-2.0 */
// The module's table; exceptions stay in here.
#include "posing/opencv_module.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include <opencv2/calib3d.hpp>
#include <opencv2/core/quaternion.hpp>

#include "features.hpp"
#include "relate.hpp"

namespace
{

constexpr double DIRECTION_DEGREES = 6.0; // standard deviation of a direction that is refused
constexpr double TURN_DEGREES = 2.0;      // of a rotation

rigid rigid_of(const Motion &m)
{
    const cv::Vec3d t = m.translation();
    const cv::Quatd q = cv::Quatd::createFromRvec(m.rvec());
    return {{t[0], t[1], t[2]}, {q.w, q.x, q.y, q.z}};
}

// Runs `work` with the same random numbers each time. Returns -1 with a reason where it refuses, or OpenCV does.
template <typename Work> int guarded(char *error, size_t error_bytes, Work work)
{
    try {
        cv::setNumThreads(1);
        cv::setRNGSeed(0);
        work();
        return 0;
    } catch (const Refusal &refusal) {
        std::snprintf(error, error_bytes, "%s", refusal.why.c_str());
    } catch (const std::exception &exception) {
        std::snprintf(error, error_bytes, "OpenCV: %s", exception.what());
    }
    return -1;
}

int find(const uint8_t *grey, uint32_t width, uint32_t height, pose_features *out, char *error, size_t error_bytes)
{
    return guarded(error, error_bytes, [&] { find_features(grey, width, height, out); });
}

int match(const pose_features *a, const pose_features *b, pose_match *matches, uint32_t *count, char *error,
          size_t error_bytes)
{
    return guarded(error, error_bytes, [&] { *count = match_features(a, b, matches); });
}

int relate(const pose_features *a, const pose_features *b, const pose_match *matches, uint32_t count, bool metric,
           relative_pose *out, char *error, size_t error_bytes)
{
    return guarded(error, error_bytes, [&] {
        if (count < MATCHES_LEAST) {
            refuse("only %u features match, %u are needed", count, MATCHES_LEAST);
        }
        Pair pair{{}, {}, (a->focal + b->focal) / 2, std::max(a->enlarged, b->enlarged), metric};
        for (const pose_match *m = matches; m < matches + count; m++) {
            pair.rays[0].push_back({a->rays[m->a][0], a->rays[m->a][1]});
            pair.rays[1].push_back({b->rays[m->b][0], b->rays[m->b][1]});
            pair.depth[0].push_back(a->depth[m->a]);
            pair.depth[1].push_back(b->depth[m->b]);
        }
        const Motion best = metric ? relate_by_depth(pair) : relate_by_colour(pair);
        const std::vector<size_t> inliers = inliers_of(pair, best);
        check_number(pair, inliers);
        const Uncertainty sure = uncertainty_of(pair, best, inliers);
        if (!metric && !(sure.direction_degrees < DIRECTION_DEGREES)) {
            refuse("the direction of motion is known to %.0f degrees only: too little parallax, or features too few or "
                   "too close together",
                   sure.direction_degrees);
        }
        if (metric && !(sure.turn_degrees < TURN_DEGREES)) {
            refuse("the rotation is known to %.1f degrees only: features too close together", sure.turn_degrees);
        }
        *out = {rigid_of(best), metric, out->matches, 0, sure.pixels, sure.turn_degrees, sure.direction_degrees};
        for (size_t i : inliers) {
            out->matches[out->count++] = matches[i];
        }
    });
}

int resect(const double (*points)[3], const double (*rays)[2], uint32_t count, double band, rigid *camera, double *off,
           char *error, size_t error_bytes)
{
    return guarded(error, error_bytes, [&] {
        const cv::Mat places(static_cast<int>(count), 3, CV_64F, const_cast<double(*)[3]>(points)),
            seen(static_cast<int>(count), 2, CV_64F, const_cast<double(*)[2]>(rays));
        cv::Mat r, t, inliers, some_places, some_seen, projected;
        if (count < MATCHES_LEAST ||
            !cv::solvePnPRansac(places, seen, UNIT, cv::noArray(), r, t, false, 2000, static_cast<float>(band),
                                CONFIDENCE, inliers, cv::SOLVEPNP_AP3P) ||
            static_cast<uint32_t>(inliers.rows) < count / 2) {
            refuse("the points do not lie on the pixels' rays from any place: intrinsics are wrong or missing, or the "
                   "points are wrong");
        }
        for (int i = 0; i < inliers.rows; i++) {
            some_places.push_back(places.row(inliers.at<int>(i)));
            some_seen.push_back(seen.row(inliers.at<int>(i)));
        }
        cv::solvePnPRefineLM(some_places, some_seen, UNIT, cv::noArray(), r, t);
        cv::projectPoints(some_places, r, t, UNIT, cv::noArray(), projected);
        *off = cv::norm(projected.reshape(1), some_seen) / std::sqrt(inliers.rows);
        *camera = rigid_of(Motion(cv::Vec3d(r), cv::Vec3d(t)).inv());
    });
}

} // namespace

void check_number(const Pair &pair, const std::vector<size_t> &inliers)
{
    if (inliers.size() < MATCHES_LEAST) {
        refuse("only %zu of %zu matching features agree on a motion, %u are needed", inliers.size(), pair.size(),
               MATCHES_LEAST);
    }
}

const pose_module t3r_shim = {"OpenCV " CV_VERSION, find, match, relate, resect};
