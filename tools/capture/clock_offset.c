/* SPDX-License-Identifier: Apache-2.0 */
#include "capture/clock_offset.h"

#include <math.h>
#include <string.h>

#include "geometry/quaternion.h"
#include "host/reason.h"

#define MOST_SHIFT 8      /* most columns and rows between neighbours: a tenth of the picture */
#define LEAST_MOTIONS 12u /* fewest motions with poses at both ends */
#define COARSE_NS INT64_C(4000000)
#define FINE_NS INT64_C(250000)
#define APART_NS INT64_C(50000000)
#define LEAST_EXPLAINED 0.5
#define TERMS 2 /* rotation, translation */

/* Returns a brightness of 0..255: the green of colours, the luma of YUV. */
static float brightness(const t3r_frame *f, uint32_t x, uint32_t y)
{
    const uint8_t *row = f->planes[0] + (size_t)y * f->stride_bytes[0];
    switch (f->format) {
    case T3R_PIXEL_RGB24:
    case T3R_PIXEL_BGR24:
        return row[3 * (size_t)x + 1];
    case T3R_PIXEL_YUYV:
        return row[2 * (size_t)x];
    case T3R_PIXEL_UYVY:
        return row[2 * (size_t)x + 1];
    case T3R_PIXEL_GREY:
    case T3R_PIXEL_NV12:
    case T3R_PIXEL_FORMAT_COUNT:
    default:
        return row[x];
    }
}

/* Computes box means from at most every second sample. */
void clock_picture_of(const t3r_frame *frame, clock_picture *out)
{
    float count[CLOCK_ROWS][CLOCK_COLUMNS] = {{0}};
    memset(out, 0, sizeof *out);
    uint32_t step_x = frame->width >= 4 * CLOCK_COLUMNS ? 2 : 1, step_y = frame->height >= 4 * CLOCK_ROWS ? 2 : 1;
    for (uint32_t y = 0; y < frame->height; y += step_y) {
        uint32_t row = (uint32_t)((uint64_t)y * CLOCK_ROWS / frame->height);
        for (uint32_t x = 0; x < frame->width; x += step_x) {
            uint32_t column = (uint32_t)((uint64_t)x * CLOCK_COLUMNS / frame->width);
            out->value[row][column] += brightness(frame, x, y);
            count[row][column]++;
        }
    }
    float mean = 0;
    for (int r = 0; r < CLOCK_ROWS; r++) {
        for (int c = 0; c < CLOCK_COLUMNS; c++) {
            out->value[r][c] /= count[r][c] > 0 ? count[r][c] : 1;
            mean += out->value[r][c] / (CLOCK_ROWS * CLOCK_COLUMNS);
        }
    }
    for (int r = 0; r < CLOCK_ROWS; r++) {
        for (int c = 0; c < CLOCK_COLUMNS; c++) {
            out->value[r][c] -= mean;
        }
    }
}

/* Returns the sum of squared differences after moving the second picture back by (right, down). */
static float mismatch(const clock_picture *a, const clock_picture *b, int right, int down)
{
    float sum = 0;
    for (int r = MOST_SHIFT; r < CLOCK_ROWS - MOST_SHIFT; r++) {
        for (int c = MOST_SHIFT; c < CLOCK_COLUMNS - MOST_SHIFT; c++) {
            float d = a->value[r][c] - b->value[r + down][c + right];
            sum += d * d;
        }
    }
    return sum;
}

/* Returns the minimum of the parabola through three equally spaced values, relative to the middle one. */
static double lowest(float before, float middle, float after)
{
    double curve = (double)before - 2 * (double)middle + (double)after;
    return curve > 0 ? ((double)before - (double)after) / (2 * curve) : 0;
}

void clock_motion_of(const clock_picture *before, const clock_picture *after, clock_motion *out)
{
    enum { SHIFTS = 2 * MOST_SHIFT + 1 };
    float worth[SHIFTS][SHIFTS];
    int right = 0, down = 0;
    for (int y = 0; y < SHIFTS; y++) {
        for (int x = 0; x < SHIFTS; x++) {
            worth[y][x] = mismatch(before, after, x - MOST_SHIFT, y - MOST_SHIFT);
            if (worth[y][x] < worth[down][right]) {
                right = x;
                down = y;
            }
        }
    }
    double more_right = 0, more_down = 0;
    if (right > 0 && right < SHIFTS - 1) {
        more_right = lowest(worth[down][right - 1], worth[down][right], worth[down][right + 1]);
    }
    if (down > 0 && down < SHIFTS - 1) {
        more_down = lowest(worth[down - 1][right], worth[down][right], worth[down + 1][right]);
    }
    out->right = (right - MOST_SHIFT + more_right) / CLOCK_COLUMNS;
    out->down = (down - MOST_SHIFT + more_down) / CLOCK_ROWS;
}

/* Predicts how the picture moves between two poses: right and down, by rotation (radians) and by translation (world
 * units), in the first camera. */
static void expected(const rigid *a, const rigid *b, double right[TERMS], double down[TERMS])
{
    const rigid back = rigid_inverse(a), second = rigid_compose(&back, b); /* in the first camera */
    const double axis[3] = {0, 0, 1}, *local = second.position;
    double seen[3];
    quaternion_rotate(second.rotation, axis, seen);
    double ahead = seen[2] > 0.1 ? seen[2] : 0.1;
    right[0] = -seen[0] / ahead;
    down[0] = -seen[1] / ahead;
    right[1] = -local[0];
    down[1] = -local[1];
}

/* Fits the motions by the predicted terms at one offset, in least squares; returns the share of their variance that is
 * explained. Both axes share their factors except for the picture's aspect, which each axis's own factor absorbs. */
static double explained_at(const clock_motion *motions, size_t count, const trajectory *t, int64_t offset_ns,
                           size_t *used)
{
    double a[2][TERMS][TERMS] = {{{0}}}, b[2][TERMS] = {{0}}, squares = 0, fitted = 0;
    *used = 0;
    for (size_t i = 0; i < count; i++) {
        rigid from, to;
        double x[2][TERMS];
        if (!trajectory_at_offset(t, motions[i].from_ns, offset_ns, &from) ||
            !trajectory_at_offset(t, motions[i].to_ns, offset_ns, &to)) {
            continue;
        }
        expected(&from, &to, x[0], x[1]);
        const double y[2] = {motions[i].right, motions[i].down};
        for (int axis = 0; axis < 2; axis++) {
            for (int r = 0; r < TERMS; r++) {
                b[axis][r] += x[axis][r] * y[axis];
                for (int c = 0; c < TERMS; c++) {
                    a[axis][r][c] += x[axis][r] * x[axis][c];
                }
            }
            squares += y[axis] * y[axis];
        }
        ++*used;
    }
    for (int axis = 0; axis < 2; axis++) {
        double(*m)[TERMS] = a[axis];
        /* a small ridge keeps the factor of a term that does not occur at 0 */
        double ridge = 1e-6 * (m[0][0] + m[1][1]) + 1e-30;
        double d0 = m[0][0] + ridge, d1 = m[1][1] + ridge, det = d0 * d1 - m[0][1] * m[1][0];
        if (det > 0) {
            double f0 = (b[axis][0] * d1 - b[axis][1] * m[0][1]) / det;
            double f1 = (b[axis][1] * d0 - b[axis][0] * m[1][0]) / det;
            fitted += f0 * b[axis][0] + f1 * b[axis][1];
        }
    }
    return squares > 0 ? fitted / squares : 0;
}

typedef struct search {
    int64_t offset_ns;
    double explained;
} search;

static search best_between(const clock_motion *motions, size_t count, const trajectory *t, int64_t low_ns,
                           int64_t high_ns, int64_t step_ns, size_t enough)
{
    search best = {low_ns, -1};
    for (int64_t offset = low_ns; offset <= high_ns; offset += step_ns) {
        size_t used;
        double explained = explained_at(motions, count, t, offset, &used);
        if (used >= enough && explained > best.explained) {
            best = (search){offset, explained};
        }
    }
    return best;
}

int clock_offset_estimate(const clock_motion *motions, size_t count, const trajectory *t, int64_t around_ns,
                          int64_t range_ns, clock_offset *out, char *error, size_t error_bytes)
{
    double moved = 0;
    for (size_t i = 0; i < count; i++) {
        moved += hypot(motions[i].right, motions[i].down);
    }
    /* excludes offsets at which much of the capture lies outside the trajectory */
    size_t enough = count / 2 > LEAST_MOTIONS ? count / 2 : LEAST_MOTIONS;
    if (count < LEAST_MOTIONS || moved / (double)count < 0.2 / CLOCK_COLUMNS) {
        return t3r_reason(error, error_bytes, "the clocks' offset cannot be estimated: %s",
                          count < LEAST_MOTIONS ? "fewer than 13 frames" : "the picture hardly moves");
    }
    search coarse = best_between(motions, count, t, around_ns - range_ns, around_ns + range_ns, COARSE_NS, enough);
    if (coarse.explained < 0) {
        return t3r_reason(error, error_bytes,
                          "the clocks' offset cannot be estimated: half of the frames lie outside the trajectory");
    }
    search fine =
        best_between(motions, count, t, coarse.offset_ns - COARSE_NS, coarse.offset_ns + COARSE_NS, FINE_NS, enough);
    search before = best_between(motions, count, t, around_ns - range_ns, fine.offset_ns - APART_NS, COARSE_NS, enough);
    search behind = best_between(motions, count, t, fine.offset_ns + APART_NS, around_ns + range_ns, COARSE_NS, enough);
    *out = (clock_offset){fine.offset_ns, fine.explained, fmax(0, fmax(before.explained, behind.explained))};
    if (fine.explained < LEAST_EXPLAINED || fine.explained - out->runner_up < 0.02 * fine.explained) {
        return t3r_reason(error, error_bytes,
                          "the clocks' offset is not clear: %+.1f ms explains %.0f %% of the motion, another %.0f %%; "
                          "give it with --clock-offset",
                          (double)fine.offset_ns * 1e-6, fine.explained * 100, out->runner_up * 100);
    }
    return 0;
}
