#include "poses/resection.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define POINTS_LEAST 6u
#define ROUNDS 4 /* the first on all points */
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

int resect(const double (*points)[3], const double (*rays)[2], uint32_t count, motion *camera, double *error)
{
    seen *s = malloc((count + 1) * sizeof *s);
    if (s == NULL || count < POINTS_LEAST) {
        free(s);
        return -1;
    }
    double centre[3] = {0}, spread = 0;
    for (uint32_t i = 0; i < count; i++) {
        s[i] = (seen){.v = {rays[i][0], rays[i][1], 1}};
        memcpy(s[i].x, points[i], sizeof s[i].x);
        for (int k = 0; k < 3; k++) {
            centre[k] += points[i][k] / count;
        }
    }
    for (uint32_t i = 0; i < count; i++) {
        double d[3] = {points[i][0] - centre[0], points[i][1] - centre[1], points[i][2] - centre[2]};
        spread += dot3(d, d) / count;
    }
    /* begins far before the points' middle: as a camera without perspective would see them */
    motion m = motion_none;
    for (int k = 0; k < 3; k++) {
        m.t[k] = -centre[k] + (k == 2 ? 3 * sqrt(spread) : 0);
    }
    uint32_t used = count;
    int status = 0;
    for (int round = 0; round < ROUNDS && status == 0; round++) {
        double sum = 0;
        status = iterate(s, used, &m);
        for (uint32_t i = 0; i < count; i++) {
            double p[3];
            motion_apply(&m, s[i].x, p);
            double dx = p[0] / p[2] - s[i].v[0], dy = p[1] / p[2] - s[i].v[1];
            s[i].miss = p[2] > 0 ? sqrt(dx * dx + dy * dy) : HUGE_VAL;
        }
        qsort(s, count, sizeof *s, by_miss);
        used = count * 2 / 3 > POINTS_LEAST ? count * 2 / 3 : POINTS_LEAST;
        for (uint32_t i = 0; i < used; i++) {
            sum += s[i].miss * s[i].miss / used;
        }
        *error = sqrt(sum);
    }
    free(s);
    *camera = motion_inverse(&m);
    return status == 0 && isfinite(*error) ? 0 : -1;
}
