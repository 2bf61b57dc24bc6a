/* SPDX-License-Identifier: Apache-2.0 */
#include "posing/fit.h"

#include <lapacke.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "posing/five_point.h"

#define ERRORS 4 /* of one match at most */
#define UNKNOWNS 6
#define ROUNDS 5 /* of choosing inliers */
#define STEPS 10 /* of least squares a round */
/* of errors a level of the pyramid: its pixels are 1.25 times as wide, its corners are placed better than that */
#define LEVEL_WIDENS 1.12
#define FAR 1e3 /* pixels, of a point behind the camera */
#define PI 3.14159265358979323846

/* ---- errors ----------------------------------------------------------------------------------------------------- */

typedef struct frames_of {
    motion there, back;
    double e[9];
} frames_of;

static frames_of frames_for(const motion *m)
{
    frames_of f = {.there = *m, .back = motion_inverse(m)};
    essential_of(m, f.e);
    return f;
}

static void project(const motion *m, const double ray[2], double depth, const double seen[2], double focal,
                    double error[2])
{
    const double point[3] = {ray[0] * depth, ray[1] * depth, depth};
    double p[3];
    motion_apply(m, point, p);
    for (int i = 0; i < 2; i++) {
        double miss = p[2] > 1e-6 * depth ? focal * (p[i] / p[2] - seen[i]) : FAR;
        error[i] = fabs(miss) < FAR ? miss : FAR;
    }
}

static double scale_of(const fit_pair *pair, const pose_match *match)
{
    uint32_t a = pair->a->corners[match->a].level, b = pair->b->corners[match->b].level;
    return pow(LEVEL_WIDENS, a > b ? a : b);
}

/* The errors of a match, so that the sum of their squares is what fit_error() squares. */
static int errors_of(const fit_pair *pair, uint32_t at, const frames_of *f, double error[ERRORS])
{
    const pose_match *match = &pair->matches[at];
    const double *ray_a = pair->a->rays[match->a], *ray_b = pair->b->rays[match->b];
    double scale = scale_of(pair, match);
    int count = 0;
    if (pair->metric && pair->a->depth[match->a] > 0) {
        project(&f->there, ray_a, pair->a->depth[match->a], ray_b, pair->b->focal, error);
        count = 2;
    }
    if (pair->metric && pair->b->depth[match->b] > 0) {
        project(&f->back, ray_b, pair->b->depth[match->b], ray_a, pair->a->focal, error + count);
        count += 2;
    }
    if (count == 0) {
        error[count++] = epipolar_error(f->e, ray_a, ray_b, (pair->a->focal + pair->b->focal) / 2);
    }
    for (int i = 0; i < count; i++) {
        error[i] /= count == ERRORS ? scale * sqrt(2) : scale;
    }
    return count;
}

static double error_of(const fit_pair *pair, uint32_t at, const frames_of *f)
{
    double error[ERRORS], sum = 0;
    int count = errors_of(pair, at, f, error);
    for (int i = 0; i < count; i++) {
        sum += error[i] * error[i];
    }
    return sqrt(sum);
}

double fit_error(const fit_pair *pair, uint32_t match, const motion *m)
{
    frames_of f = frames_for(m);
    return error_of(pair, match, &f);
}

double fit_cost(const fit_pair *pair, const motion *m, uint32_t *inliers)
{
    frames_of f = frames_for(m);
    double sum = 0, limit = fit_pixels(pair);
    uint32_t count = 0;
    for (uint32_t i = 0; i < pair->count; i++) {
        double error = error_of(pair, i, &f);
        count += error < limit;
        error = error < limit ? error : limit;
        sum += error * error;
    }
    if (inliers != NULL) {
        *inliers = count;
    }
    return sum;
}

/* ---- least squares ---------------------------------------------------------------------------------------------- */

/* A small change of a motion: a turn before, and a move of t, which stays on the sphere where lengths are unknown. */
typedef struct step_frame {
    int unknowns;
    double move[3][3]; /* what t moves by for a unit of each unknown after the turn's three */
} step_frame;

static step_frame frame_at(const fit_pair *pair, const motion *m, double length)
{
    step_frame f = {.unknowns = pair->metric ? 6 : 5};
    if (pair->metric) {
        for (int i = 0; i < 3; i++) {
            f.move[i][i] = length;
        }
        return f;
    }
    int least = 0;
    for (int i = 1; i < 3; i++) {
        least = fabs(m->t[i]) < fabs(m->t[least]) ? i : least;
    }
    double axis[3] = {least == 0, least == 1, least == 2};
    cross3(m->t, axis, f.move[0]);
    double size = norm3(f.move[0]);
    for (int i = 0; i < 3; i++) {
        f.move[0][i] /= size;
    }
    cross3(m->t, f.move[0], f.move[1]);
    return f;
}

static motion stepped(const motion *m, const step_frame *f, const double *x)
{
    motion out;
    double turn[9];
    rotation_about(x, turn);
    multiply3(turn, m->r, out.r);
    memcpy(out.t, m->t, sizeof out.t);
    for (int k = 3; k < f->unknowns; k++) {
        for (int i = 0; i < 3; i++) {
            out.t[i] += f->move[k - 3][i] * x[k];
        }
    }
    if (f->unknowns == 5) {
        double size = norm3(out.t);
        for (int i = 0; i < 3; i++) {
            out.t[i] /= size;
        }
    }
    return out;
}

/* Normal equations over the inliers, each weighted by 1 / (1 + error^2) (Cauchy); derivatives by central differences.
 * Returns the sum of log(1 + error^2). */
static double normal_equations(const fit_pair *pair, const uint8_t *inlier, const motion *m, const step_frame *f,
                               double jtj[UNKNOWNS * UNKNOWNS], double jtr[UNKNOWNS])
{
    static const double h = 1e-6;
    frames_of plus[UNKNOWNS], minus[UNKNOWNS], here = frames_for(m);
    for (int k = 0; k < f->unknowns; k++) {
        double x[UNKNOWNS] = {0};
        x[k] = h;
        motion moved = stepped(m, f, x);
        plus[k] = frames_for(&moved);
        x[k] = -h;
        moved = stepped(m, f, x);
        minus[k] = frames_for(&moved);
    }
    memset(jtj, 0, UNKNOWNS * UNKNOWNS * sizeof *jtj);
    memset(jtr, 0, UNKNOWNS * sizeof *jtr);
    double total = 0;
    for (uint32_t i = 0; i < pair->count; i++) {
        if (!inlier[i]) {
            continue;
        }
        double error[ERRORS], ahead[ERRORS], behind[ERRORS], slope[UNKNOWNS][ERRORS], square = 0;
        int count = errors_of(pair, i, &here, error);
        for (int k = 0; k < f->unknowns; k++) {
            errors_of(pair, i, &plus[k], ahead);
            errors_of(pair, i, &minus[k], behind);
            for (int e = 0; e < count; e++) {
                slope[k][e] = (ahead[e] - behind[e]) / (2 * h);
            }
        }
        for (int e = 0; e < count; e++) {
            square += error[e] * error[e];
        }
        total += log1p(square);
        for (int e = 0; e < count; e++) {
            for (int k = 0; k < f->unknowns; k++) {
                jtr[k] += slope[k][e] * error[e] / (1 + square);
                for (int l = 0; l < f->unknowns; l++) {
                    jtj[k * f->unknowns + l] += slope[k][e] * slope[l][e] / (1 + square);
                }
            }
        }
    }
    return total;
}

static double robust_cost(const fit_pair *pair, const uint8_t *inlier, const motion *m)
{
    frames_of f = frames_for(m);
    double total = 0;
    for (uint32_t i = 0; i < pair->count; i++) {
        if (inlier[i]) {
            double error = error_of(pair, i, &f);
            total += log1p(error * error);
        }
    }
    return total;
}

static void descend(const fit_pair *pair, const uint8_t *inlier, motion *m, double length)
{
    double damping = 1e-3;
    for (int step = 0; step < STEPS && damping < 1e6; step++) {
        step_frame f = frame_at(pair, m, length);
        double jtj[UNKNOWNS * UNKNOWNS], jtr[UNKNOWNS], x[UNKNOWNS];
        double before = normal_equations(pair, inlier, m, &f, jtj, jtr);
        for (int k = 0; k < f.unknowns; k++) {
            jtj[k * f.unknowns + k] *= 1 + damping;
            x[k] = -jtr[k];
        }
        if (LAPACKE_dposv(LAPACK_ROW_MAJOR, 'L', f.unknowns, 1, jtj, f.unknowns, x, 1) != 0) {
            return;
        }
        motion moved = stepped(m, &f, x);
        double after = robust_cost(pair, inlier, &moved);
        if (after < before) {
            *m = moved;
            damping /= 10;
            if (before - after < 1e-9 * before) {
                return;
            }
        } else {
            damping *= 10;
        }
    }
}

/* ---- account ---------------------------------------------------------------------------------------------------- */

/* The largest standard deviation along any direction of a block of the covariance. */
static double largest_deviation(const double *covariance, int stride, int first, int count)
{
    double block[9], values[3];
    for (int i = 0; i < count; i++) {
        for (int k = 0; k < count; k++) {
            block[i * count + k] = covariance[(first + i) * stride + first + k];
        }
    }
    return LAPACKE_dsyev(LAPACK_ROW_MAJOR, 'N', 'U', count, block, count, values) == 0
               ? sqrt(fmax(0, values[count - 1]))
               : INFINITY;
}

static int account_for(const fit_pair *pair, const uint8_t *inlier, const motion *m, double length,
                       fit_account *account)
{
    step_frame f = frame_at(pair, m, length);
    frames_of here = frames_for(m);
    double jtj[UNKNOWNS * UNKNOWNS], jtr[UNKNOWNS], covariance[UNKNOWNS * UNKNOWNS] = {0}, sum = 0;
    uint32_t count = 0, told = 0;
    normal_equations(pair, inlier, m, &f, jtj, jtr);
    for (int k = 0; k < f.unknowns; k++) {
        covariance[k * f.unknowns + k] = 1;
    }
    for (uint32_t i = 0; i < pair->count; i++) {
        if (inlier[i]) {
            double errors[ERRORS];
            told += (uint32_t)errors_of(pair, i, &here, errors);
            double error = error_of(pair, i, &here);
            sum += error * error;
            count++;
        }
    }
    if (told <= UNKNOWNS ||
        LAPACKE_dposv(LAPACK_ROW_MAJOR, 'L', f.unknowns, f.unknowns, jtj, f.unknowns, covariance, f.unknowns) != 0) {
        return -1;
    }
    account->pixels = sqrt(sum / count);
    /* pixels of an enlarged picture err together */
    double enlarged = fmax(1, fmax(pair->a->enlarged, pair->b->enlarged));
    double deviation = enlarged * fmax(sqrt(sum / told), 0.1);
    account->turn_degrees = deviation * largest_deviation(covariance, f.unknowns, 0, 3) * 180 / PI;
    double move = deviation * largest_deviation(covariance, f.unknowns, 3, f.unknowns - 3);
    double far = norm3(m->t);
    account->direction_degree = pair->metric ? atan2(move * length, far) * 180 / PI : move * 180 / PI;
    return 0;
}

static int descending(const void *a, const void *b)
{
    double p = *(const double *)a, q = *(const double *)b;
    return (p < q) - (p > q);
}

/* The median of the known depths of the first view's matched corners: what moves of t are measured in. */
static double median_depth(const fit_pair *pair)
{
    double *depths = malloc((pair->count + 1) * sizeof *depths), median = 1;
    uint32_t count = 0;
    for (uint32_t i = 0; i < pair->count && depths != NULL; i++) {
        double depth = pair->a->depth[pair->matches[i].a];
        depth = depth > 0 ? depth : pair->b->depth[pair->matches[i].b];
        if (depth > 0) {
            depths[count++] = depth;
        }
    }
    if (count > 0) {
        qsort(depths, count, sizeof *depths, descending);
        median = depths[count / 2];
    }
    free(depths);
    return median;
}

int fit_refine(const fit_pair *pair, motion *m, fit_account *account)
{
    uint8_t *inlier = malloc(pair->count + 1u);
    double length = pair->metric ? median_depth(pair) : 1;
    motion best = *m;
    if (inlier == NULL) {
        return -1;
    }
    for (int round = 0; round < ROUNDS; round++) {
        frames_of f = frames_for(&best);
        for (uint32_t i = 0; i < pair->count; i++) {
            inlier[i] = error_of(pair, i, &f) < fit_pixels(pair);
        }
        descend(pair, inlier, &best, length);
    }
    int status = account_for(pair, inlier, &best, length, account);
    free(inlier);
    if (status == 0) {
        *m = best;
    }
    return status;
}
