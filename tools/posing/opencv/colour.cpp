/* SPDX-License-Identifier: Apache-2.0 */
// Colour alone: essential matrices and planes by MAGSAC, each refined; the best one, unless a rival is about as good.
#include <algorithm>
#include <utility>

#include <opencv2/calib3d.hpp>

#include "relate.hpp"

namespace
{

constexpr double BAND_ESSENTIAL = 1.0; // pixels, in which samples look for inliers
constexpr double BAND_PLANE = 3.0;
constexpr double PARALLAX_LEAST = 1.0; // pixels, of the median match
constexpr double APART = 10.0;         // degrees of direction, or half of them of rotation: another motion
constexpr double LEAD_LEAST = 3.0;     // matches that the best motion explains and no other, where most agree with it,
constexpr double LEAD_CERTAIN = 9.0;   // and where fewer do: an epipolar line lets one in thirty by chance

struct Candidate {
    Motion motion;
    double cost;
};

// Adds the motion of the essential matrix of every step-th match.
void add_essential(const Pair &pair, size_t first, size_t step, std::vector<Motion> &out)
{
    std::vector<cv::Point2d> rays[2];
    for (size_t i = first; i < pair.size(); i += step) {
        rays[0].push_back(pair.rays[0][i]);
        rays[1].push_back(pair.rays[1][i]);
    }
    const cv::Mat e =
        cv::findEssentialMat(rays[0], rays[1], UNIT, cv::USAC_MAGSAC, CONFIDENCE, BAND_ESSENTIAL / pair.focal);
    if (e.rows == 3) { // none for matches that any motion explains
        cv::Matx33d r, twisted;
        cv::Vec3d t;
        cv::decomposeEssentialMat(e, r, twisted, t);
        out.push_back(Motion(r, t)); // any of the four has the same errors
    }
}

// Adds the motions of a plane on which the points may lie.
void add_plane(const Pair &pair, std::vector<Motion> &out)
{
    const cv::Mat plane = cv::findHomography(pair.rays[0], pair.rays[1], cv::USAC_MAGSAC, BAND_PLANE / pair.focal);
    std::vector<cv::Mat> r, t, normals;
    if (!plane.empty()) {
        cv::decomposeHomographyMat(plane, UNIT, r, t, normals);
    }
    for (size_t i = 0; i < r.size(); i++) { // of a camera that only turned any direction will do
        out.push_back(Motion(r[i], cv::norm(t[i]) > 0 ? cv::normalize(cv::Vec3d(t[i])) : cv::Vec3d(1, 0, 0)));
    }
}

// Returns the one of the four motions with m's essential matrix that has the inliers' points in front of both cameras.
// Its rotation leaves the smaller parallax, which holds for points however far; most points are in front of the first
// camera.
Motion faced(const Pair &pair, const Motion &m)
{
    const std::vector<size_t> inliers = inliers_of(pair, m);
    cv::Matx33d rotations[2];
    cv::Vec3d t;
    double parallax[2] = {0, 0};
    cv::decomposeEssentialMat(essential_of(m), rotations[0], rotations[1], t);
    for (size_t i : inliers) {
        for (int k = 0; k < 2; k++) {
            parallax[k] += angle(rotations[k] * homogeneous(pair.rays[0][i]), homogeneous(pair.rays[1][i]));
        }
    }
    const cv::Matx33d r = parallax[0] <= parallax[1] ? rotations[0] : rotations[1];
    int before = 0;
    for (size_t i : inliers) {
        const cv::Vec3d a = r * homogeneous(pair.rays[0][i]), b = homogeneous(pair.rays[1][i]);
        before += t.cross(b).dot(a.cross(b)) < 0 ? 1 : -1; // the depth in a has the other sign
    }
    return Motion(r, before >= 0 ? t : -t);
}

// Returns refined motions, the cheapest first: of all matches, of halves of them, and of a plane.
std::vector<Candidate> ranked(const Pair &pair)
{
    std::vector<Motion> starts;
    add_essential(pair, 0, 1, starts);
    add_essential(pair, 0, 2, starts);
    add_essential(pair, 1, 2, starts);
    add_plane(pair, starts);
    std::vector<Candidate> out;
    for (const Motion &start : starts) {
        const Motion m = faced(pair, refined(pair, start));
        out.push_back({m, cost_of(pair, m)});
    }
    std::stable_sort(out.begin(), out.end(), [](const Candidate &a, const Candidate &b) { return a.cost < b.cost; });
    return out;
}

double degrees_apart(const Motion &a, const Motion &b)
{
    const double turn = cv::norm((a.inv() * b).rvec()) / DEGREE;
    return std::max(2 * turn, angle(a.translation(), b.translation()));
}

// Returns the median angle between the rays of the inliers, the rotation undone, in pixels.
double parallax_of(const Pair &pair, const std::vector<size_t> &inliers, const Motion &m)
{
    std::vector<double> moved;
    for (size_t i : inliers) {
        moved.push_back(angle(m.rotation() * homogeneous(pair.rays[0][i]), homogeneous(pair.rays[1][i])));
    }
    std::nth_element(moved.begin(), moved.begin() + moved.size() / 2, moved.end());
    return pair.focal * DEGREE * moved[moved.size() / 2];
}

} // namespace

Motion relate_by_colour(const Pair &pair)
{
    const std::vector<Candidate> found = ranked(pair);
    const std::vector<size_t> inliers = found.empty() ? std::vector<size_t>() : inliers_of(pair, found[0].motion);
    check_number(pair, inliers);
    const Motion &best = found[0].motion;
    const double parallax = parallax_of(pair, inliers, best);
    if (parallax < PARALLAX_LEAST) {
        refuse("no parallax: without the cameras' turning, features move by %.1f pixels; a direction cannot be known "
               "from colour, move the camera or give depth",
               parallax);
    }
    const auto rival = std::find_if(found.begin(), found.end(),
                                    [&](const Candidate &c) { return degrees_apart(best, c.motion) > APART; });
    const double lead = 2 * inliers.size() >= pair.size() ? LEAD_LEAST : LEAD_CERTAIN;
    if (rival != found.end() && rival->cost - found[0].cost < lead) {
        refuse("two motions %.0f degrees apart explain the features about equally (%zu of %zu agree with the better "
               "one): they may lie on one plane, or too few are seen in both",
               degrees_apart(best, rival->motion), inliers.size(), pair.size());
    }
    return best;
}
