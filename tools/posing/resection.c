/* SPDX-License-Identifier: Apache-2.0 */
#include "posing/resection.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define POINTS_LEAST 16u
#define SAMPLE 8u
#define SAMPLES                                                                                                        \
    100 /* with a third wrong, one in 26 holds right ones alone: but for one chance in fifty, of a hundred one does */
#define ROUNDS 5
#define STEPS 100

typedef struct seen {
    double x[3], v[3]; /* the place; its ray */
    double miss;
} seen;

/* v (v . p) / (v . v): the place on the ray that is nearest to p */
static void onto_ray(const double v[3], const double p[3], double out[3])
{
    double along = dot3(v, p) / dot3(v, v);
    for (int i = 0; i < 3; i++) {
        out[i] = along * v[i];
    }
}

/* The inverse of a symmetric matrix by its adjugate; -1 where it has none. */
static int invert(const double m[9], double out[9])
{
    double determinant = determinant3(m);
    if (!(fabs(determinant) > 1e-12)) {
        return -1;
    }
    for (int i = 0; i < 3; i++) {
        double c[3];
        cross3(m + 3 * ((i + 1) % 3), m + 3 * ((i + 2) % 3), c);
        for (int k = 0; k < 3; k++) {
            out[3 * k + i] = c[k] / determinant;
        }
    }
    return 0;
}

/* The best translation for a rotation: (1 - mean of the projections)^-1 mean of (projection - 1) r x. */
static void translate(const seen *s, uint32_t count, const double inverse[9], motion *m)
{
    double sum[3] = {0}, turned[3], near[3];
    for (uint32_t i = 0; i < count; i++) {
        apply3(m->r, s[i].x, turned);
        onto_ray(s[i].v, turned, near);
        for (int k = 0; k < 3; k++) {
            sum[k] += (near[k] - turned[k]) / count;
        }
    }
    apply3(inverse, sum, m->t);
}

/* The rotation that brings the places' offsets from their mean nearest to those of `targets`. */
static int rotate(const seen *s, uint32_t count, const motion *m, motion *out)
{
    double mean_x[3] = {0}, mean_q[3] = {0}, h[9] = {0}, u[9], d[3], vt[9], p[3], q[3];
    for (int pass = 0; pass < 2; pass++) {
        for (uint32_t i = 0; i < count; i++) {
            motion_apply(m, s[i].x, p);
            onto_ray(s[i].v, p, q);
            for (int k = 0; k < 3 && pass == 0; k++) {
                mean_x[k] += s[i].x[k] / count;
                mean_q[k] += q[k] / count;
            }
            for (int k = 0; k < 9 && pass == 1; k++) {
                h[k] += (q[k / 3] - mean_q[k / 3]) * (s[i].x[k % 3] - mean_x[k % 3]);
            }
        }
    }
    if (singular3(h, u, d, vt) != 0 || !(d[1] > 1e-9 * d[0])) {
        return -1;
    }
    if (determinant3(u) * determinant3(vt) < 0) {
        for (int i = 0; i < 3; i++) {
            u[3 * i + 2] = -u[3 * i + 2];
        }
    }
    multiply3(u, vt, out->r);
    return 0;
}

static int iterate(const seen *s, uint32_t count, motion *m)
{
    double mean[9] = {0}, inverse[9];
    for (uint32_t i = 0; i < count; i++) {
        double square = dot3(s[i].v, s[i].v);
        for (int k = 0; k < 9; k++) {
            mean[k] += s[i].v[k / 3] * s[i].v[k % 3] / square / count;
        }
    }
    for (int k = 0; k < 9; k++) {
        mean[k] = motion_none.r[k] - mean[k];
    }
    if (invert(mean, inverse) != 0) {
        return -1;
    }
    for (int step = 0; step < STEPS; step++) {
        motion next = *m;
        if (rotate(s, count, m, &next) != 0) {
            return -1;
        }
        translate(s, count, inverse, &next);
        double moved = rotation_angle(m->r, next.r);
        *m = next;
        if (moved < 1e-9 && step > 0) {
            break;
        }
    }
    return 0;
}

static int by_miss(const void *a, const void *b)
{
    double p = ((const seen *)a)->miss, q = ((const seen *)b)->miss;
    return (p > q) - (p < q);
}

/* Far before the points' middle, looking along z: as a camera without perspective would see them. */
static motion begin(const seen *s, uint32_t count)
{
    motion m = motion_none;
    double centre[3] = {0}, spread = 0;
    for (uint32_t i = 0; i < count; i++) {
        for (int k = 0; k < 3; k++) {
            centre[k] += s[i].x[k] / count;
        }
    }
    for (uint32_t i = 0; i < count; i++) {
        for (int k = 0; k < 3; k++) {
            spread += (s[i].x[k] - centre[k]) * (s[i].x[k] - centre[k]) / count;
        }
    }
    for (int k = 0; k < 3; k++) {
        m.t[k] = -centre[k] + (k == 2 ? 3 * sqrt(spread) : 0);
    }
    return m;
}

/* Orders by error; returns the median. */
static double sort_misses(seen *s, uint32_t count, const motion *m)
{
    for (uint32_t i = 0; i < count; i++) {
        double p[3];
        motion_apply(m, s[i].x, p);
        double dx = p[0] / p[2] - s[i].v[0], dy = p[1] / p[2] - s[i].v[1];
        s[i].miss = p[2] > 0 ? sqrt(dx * dx + dy * dy) : HUGE_VAL;
    }
    qsort(s, count, sizeof *s, by_miss);
    return s[count / 2].miss;
}

/* The pose of the sample with the least median error over all, which is returned; HUGE_VAL when none has one. */
static double best_sample(seen *s, uint32_t count, motion *best)
{
    uint64_t state = 1;
    double least = HUGE_VAL;
    for (int n = 0; n < SAMPLES; n++) {
        seen some[SAMPLE];
        for (uint32_t i = 0; i < SAMPLE; i++) {
            state = state * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
            some[i] = s[(state >> 33) % count];
        }
        motion m = begin(some, SAMPLE);
        double median = iterate(some, SAMPLE, &m) == 0 ? sort_misses(s, count, &m) : HUGE_VAL;
        if (median < least) {
            least = median;
            *best = m;
        }
    }
    return least;
}

int resect(const double (*points)[3], const double (*rays)[2], uint32_t count, motion *camera, double *error)
{
    seen *s = malloc((count + 1) * sizeof *s);
    if (s == NULL || count < POINTS_LEAST) {
        free(s);
        return -1;
    }
    for (uint32_t i = 0; i < count; i++) {
        s[i] = (seen){.v = {rays[i][0], rays[i][1], 1}};
        memcpy(s[i].x, points[i], sizeof s[i].x);
    }
    motion m = motion_none;
    int status = best_sample(s, count, &m) < HUGE_VAL ? 0 : -1;
    for (int round = 0; round < ROUNDS && status == 0; round++) {
        (void)sort_misses(s, count, &m);
        status = iterate(s, count / 2, &m);
    }
    (void)sort_misses(s, count, &m);
    *error = 0;
    for (uint32_t i = 0; i < count / 2; i++) {
        *error += s[i].miss * s[i].miss / (count / 2);
    }
    *error = sqrt(*error);
    free(s);
    *camera = motion_inverse(&m);
    return status == 0 && isfinite(*error) ? 0 : -1;
}
