/* SPDX-License-Identifier: Apache-2.0 */
// Depth in either view: perspective from its points, then least squares over both views.
#include <opencv2/calib3d.hpp>

#include "relate.hpp"

Motion relate_by_depth(const Pair &pair)
{
    constexpr double BAND = 4.0; // pixels, in which samples look for inliers
    Motion best;
    int most = 0;
    for (int side = 0; side < 2; side++) {
        std::vector<cv::Point3d> points;
        std::vector<cv::Point2d> rays;
        for (size_t i = 0; i < pair.size(); i++) {
            if (pair.depth[side][i] > 0) {
                points.push_back(pair.depth[side][i] * cv::Point3d(homogeneous(pair.rays[side][i])));
                rays.push_back(pair.rays[1 - side][i]);
            }
        }
        cv::Mat r, t, inliers;
        if (points.size() >= MATCHES_LEAST / 2 &&
            cv::solvePnPRansac(points, rays, UNIT, cv::noArray(), r, t, false, 2000,
                               static_cast<float>(BAND / pair.focal), CONFIDENCE, inliers, cv::SOLVEPNP_AP3P) &&
            inliers.rows > most) {
            const Motion m{cv::Vec3d(r), cv::Vec3d(t)};
            most = inliers.rows;
            best = side == 0 ? m : m.inv();
        }
    }
    return most > 0 ? refined(pair, best) : best;
}
