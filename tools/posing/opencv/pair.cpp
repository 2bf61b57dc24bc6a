/* SPDX-License-Identifier: Apache-2.0 */
#include "pair.hpp"

#include <algorithm>
#include <cmath>

#include <opencv2/calib3d.hpp>

namespace
{

constexpr double BAND_COLOUR = 1.2; // pixels, of an inlier
constexpr double BAND_DEPTH = 3.0;

// A motion, its inverse and its essential matrix.
struct Hypothesis {
    Motion to[2];
    cv::Matx33d essential;

    explicit Hypothesis(const Motion &m) : to{m, m.inv()}, essential(essential_of(m))
    {
    }
};

using Errors = cv::Vec4d; // pixels: x and y in either view, or the epipolar error

double band_of(const Pair &pair)
{
    return pair.metric ? BAND_DEPTH : BAND_COLOUR;
}

// Returns Sampson's distance of match i.
double epipolar_error(const Pair &pair, size_t i, const cv::Matx33d &essential)
{
    const cv::Vec3d a = homogeneous(pair.rays[0][i]), b = homogeneous(pair.rays[1][i]);
    const cv::Vec3d line = essential * a, back = essential.t() * b;
    const double slope = std::sqrt(line[0] * line[0] + line[1] * line[1] + back[0] * back[0] + back[1] * back[1]);
    return slope > 0 ? pair.focal * b.dot(line) / slope : 0;
}

Errors errors_of(const Pair &pair, size_t i, const Hypothesis &h)
{
    Errors e;
    int projected = 0;
    for (int side = 0; side < 2 && pair.metric; side++) {
        const double z = pair.depth[side][i];
        if (z > 0) {
            const cv::Vec3d p = h.to[side] * (z * homogeneous(pair.rays[side][i]));
            const cv::Point2d seen = pair.rays[1 - side][i];
            const bool before = p[2] > 1e-6 * z;
            e[2 * side] = before ? pair.focal * (p[0] / p[2] - seen.x) : 2 * BAND_DEPTH;
            e[2 * side + 1] = before ? pair.focal * (p[1] / p[2] - seen.y) : 2 * BAND_DEPTH;
            projected++;
        }
    }
    if (projected == 0) {
        e[0] = epipolar_error(pair, i, h.essential);
    }
    return projected == 2 ? e / std::sqrt(2.0) : e;
}

cv::Mat parameters_of(const Motion &m)
{
    const cv::Vec3d r = m.rvec(), t = m.translation();
    return (cv::Mat_<double>(6, 1) << r[0], r[1], r[2], t[0], t[1], t[2]);
}

Motion motion_of(const cv::Mat &p)
{
    const double *v = p.ptr<double>();
    return Motion(cv::Vec3d(v[0], v[1], v[2]), cv::Vec3d(v[3], v[4], v[5]));
}

// Errors e of the inliers, whose squares become log(1 + e^2) (Cauchy).
class Robust : public cv::LMSolver::Callback
{
  public:
    Robust(const Pair &matches, const std::vector<size_t> &chosen) : pair(matches), inliers(chosen)
    {
    }

    bool compute(cv::InputArray parameters, cv::OutputArray errors, cv::OutputArray slopes) const override
    {
        const cv::Mat at = parameters.getMat();
        errors_at(at).copyTo(errors);
        if (slopes.needed()) {
            constexpr double STEP = 1e-6;
            slopes.create(static_cast<int>(4 * inliers.size()), at.rows, CV_64F);
            for (int k = 0; k < at.rows; k++) {
                cv::Mat plus = at.clone(), minus = at.clone();
                plus.at<double>(k) += STEP;
                minus.at<double>(k) -= STEP;
                cv::Mat((errors_at(plus) - errors_at(minus)) / (2 * STEP)).copyTo(slopes.getMat().col(k));
            }
        }
        return true;
    }

  private:
    const Pair &pair;
    const std::vector<size_t> &inliers;

    cv::Mat errors_at(const cv::Mat &parameters) const
    {
        const Hypothesis h(motion_of(parameters));
        cv::Mat out(static_cast<int>(4 * inliers.size()), 1, CV_64F);
        for (size_t k = 0; k < inliers.size(); k++) {
            const Errors e = errors_of(pair, inliers[k], h);
            const double square = e.dot(e), weight = square > 0 ? std::sqrt(std::log1p(square) / square) : 1;
            out.ptr<Errors>()[k] = weight * e;
        }
        return out;
    }
};

double largest_deviation(const cv::Mat &covariance)
{
    cv::Mat values;
    cv::eigen(covariance, values);
    return std::sqrt(std::max(0.0, values.at<double>(0)));
}

} // namespace

double angle(const cv::Vec3d &a, const cv::Vec3d &b)
{
    return std::atan2(cv::norm(a.cross(b)), a.dot(b)) / DEGREE;
}

cv::Matx33d essential_of(const Motion &m)
{
    const cv::Vec3d t = cv::normalize(m.translation());
    return cv::Matx33d(0, -t[2], t[1], t[2], 0, -t[0], -t[1], t[0], 0) * m.rotation();
}

std::vector<size_t> inliers_of(const Pair &pair, const Motion &m)
{
    const Hypothesis h(m);
    std::vector<size_t> inliers;
    for (size_t i = 0; i < pair.size(); i++) {
        if (cv::norm(errors_of(pair, i, h)) < band_of(pair)) {
            inliers.push_back(i);
        }
    }
    return inliers;
}

double cost_of(const Pair &pair, const Motion &m)
{
    const Hypothesis h(m);
    double cost = 0;
    for (size_t i = 0; i < pair.size(); i++) {
        cost += std::min(1.0, cv::norm(errors_of(pair, i, h), cv::NORM_L2SQR) / (band_of(pair) * band_of(pair)));
    }
    return cost;
}

Motion refined(const Pair &pair, Motion m)
{
    constexpr int ROUNDS = 3, STEPS = 10; // of choosing inliers, of least squares
    for (int round = 0; round < ROUNDS; round++) {
        const std::vector<size_t> inliers = inliers_of(pair, m);
        if (inliers.size() < 6) {
            break;
        }
        cv::Mat p = parameters_of(m);
        cv::LMSolver::create(cv::makePtr<Robust>(pair, inliers), STEPS)->run(p);
        m = motion_of(p);
        if (!pair.metric) {
            m.translation(cv::normalize(m.translation()));
        }
    }
    return m;
}

Uncertainty uncertainty_of(const Pair &pair, const Motion &m, const std::vector<size_t> &inliers)
{
    cv::Mat errors, slopes, covariance;
    Robust(pair, inliers).compute(parameters_of(m), errors, slopes);
    cv::invert(slopes.t() * slopes, covariance, cv::DECOMP_SVD);
    const double square = errors.dot(errors);
    // pixels of an enlarged picture err together
    const double deviation = std::max(1.0, pair.enlarged) * std::max(0.1, std::sqrt(square / cv::countNonZero(errors)));
    const cv::Vec3d t = m.translation();
    const double length = cv::norm(t);
    const cv::Mat turn = covariance(cv::Rect(0, 0, 3, 3)), move = covariance(cv::Rect(3, 3, 3, 3));
    const cv::Mat across = cv::Mat(UNIT - (t * t.t()) * (length > 0 ? 1 / (length * length) : 0));
    return {std::sqrt(square / static_cast<double>(inliers.size())), deviation * largest_deviation(turn) / DEGREE,
            std::atan2(deviation * largest_deviation(across * move * across), length) / DEGREE};
}
