/* SPDX-License-Identifier: Apache-2.0 */
#include "posing/five_point.h"

#include <lapacke.h>
#include <math.h>
#include <string.h>

/* Monomials in x, y, z: first the ten of degree 3, then those of degree 2 and less, as the action matrix has them. */
enum { MONOMIALS = 20, CUBIC = 10 };
static const int exponents[MONOMIALS][3] = {{3, 0, 0}, {2, 1, 0}, {2, 0, 1}, {1, 2, 0}, {1, 1, 1}, {1, 0, 2}, {0, 3, 0},
                                            {0, 2, 1}, {0, 1, 2}, {0, 0, 3}, {2, 0, 0}, {1, 1, 0}, {1, 0, 1}, {0, 2, 0},
                                            {0, 1, 1}, {0, 0, 2}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, 0}};
/* What x times the last ten monomials is. */
static const int times_x[CUBIC] = {0, 1, 2, 3, 4, 5, 10, 11, 12, 16};

typedef struct polynomial {
    double c[MONOMIALS];
} polynomial;

static int monomial(int x, int y, int z)
{
    for (int i = 0; i < MONOMIALS; i++) {
        if (exponents[i][0] == x && exponents[i][1] == y && exponents[i][2] == z) {
            return i;
        }
    }
    return -1; /* degree above 3: no product of ours has it */
}

/* sum += factor a b */
static void add_product(polynomial *sum, const polynomial *a, const polynomial *b, double factor)
{
    for (int i = 0; i < MONOMIALS; i++) {
        for (int j = 0; j < MONOMIALS && a->c[i] != 0; j++) {
            if (b->c[j] != 0) {
                int k = monomial(exponents[i][0] + exponents[j][0], exponents[i][1] + exponents[j][1],
                                 exponents[i][2] + exponents[j][2]);
                if (k >= 0) {
                    sum->c[k] += factor * a->c[i] * b->c[j];
                }
            }
        }
    }
}

/* The four matrices that the pairs leave: the last rows of v^T. */
static int null_space(double ray_a[5][2], double ray_b[5][2], double basis[4][9])
{
    double m[5 * 9], s[5], u[25], vt[81], superb[5];
    for (int i = 0; i < 5; i++) {
        const double a[3] = {ray_a[i][0], ray_a[i][1], 1}, b[3] = {ray_b[i][0], ray_b[i][1], 1};
        for (int k = 0; k < 9; k++) {
            m[9 * i + k] = b[k / 3] * a[k % 3];
        }
    }
    if (LAPACKE_dgesvd(LAPACK_ROW_MAJOR, 'N', 'A', 5, 9, m, 9, s, u, 5, vt, 9, superb) != 0 || s[4] < 1e-9 * s[0]) {
        return -1;
    }
    memcpy(basis, vt + 5 * 9, 4 * sizeof basis[0]);
    return 0;
}

/* The ten cubic equations, a row each. */
static void equations(double basis[4][9], double rows[10][MONOMIALS])
{
    polynomial e[9] = {0}, gram[9] = {0}, trace = {0}, minor, row;
    for (int k = 0; k < 9; k++) {
        for (int i = 0; i < 4; i++) {
            e[k].c[16 + i] = basis[i][k];
        }
    }
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            for (int k = 0; k < 3; k++) {
                add_product(&gram[3 * i + j], &e[3 * i + k], &e[3 * j + k], 1);
            }
        }
        for (int m = 0; m < MONOMIALS; m++) {
            trace.c[m] += gram[4 * i].c[m];
        }
    }
    for (int i = 0; i < 9; i++) {
        row = (polynomial){0};
        for (int k = 0; k < 3; k++) {
            add_product(&row, &gram[i / 3 * 3 + k], &e[3 * k + i % 3], 2);
        }
        add_product(&row, &trace, &e[i], -1);
        memcpy(rows[i], row.c, sizeof row.c);
    }
    row = (polynomial){0};
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        minor = (polynomial){0};
        add_product(&minor, &e[3 + j], &e[6 + k], 1);
        add_product(&minor, &e[3 + k], &e[6 + j], -1);
        add_product(&row, &e[i], &minor, 1);
    }
    memcpy(rows[9], row.c, sizeof row.c);
}

int five_point(double ray_a[5][2], double ray_b[5][2], double essentials[FIVE_POINT_MOST][9])
{
    double basis[4][9], rows[10][MONOMIALS], left[100], right[100], action[100] = {0};
    double real[10], imaginary[10], vectors[100];
    lapack_int pivots[10];
    if (null_space(ray_a, ray_b, basis) != 0) {
        return 0;
    }
    equations(basis, rows);
    for (int i = 0; i < 10; i++) {
        memcpy(left + 10 * i, rows[i], 10 * sizeof *left);
        memcpy(right + 10 * i, rows[i] + 10, 10 * sizeof *right);
    }
    if (LAPACKE_dgesv(LAPACK_ROW_MAJOR, 10, 10, left, 10, pivots, right, 10) != 0) {
        return 0;
    }
    for (int i = 0; i < 10; i++) {
        for (int k = 0; k < 10; k++) {
            action[10 * i + k] = times_x[i] < CUBIC ? -right[10 * times_x[i] + k] : times_x[i] - CUBIC == k;
        }
    }
    if (LAPACKE_dgeev(LAPACK_ROW_MAJOR, 'N', 'V', 10, action, 10, real, imaginary, NULL, 10, vectors, 10) != 0) {
        return 0;
    }
    int count = 0;
    for (int i = 0; i < 10; i++) {
        double last = vectors[90 + i];
        if (imaginary[i] != 0 || fabs(last) < 1e-12) {
            continue;
        }
        double weight[4] = {vectors[60 + i] / last, vectors[70 + i] / last, vectors[80 + i] / last, 1}, sum = 0;
        for (int k = 0; k < 9; k++) {
            double value = 0;
            for (int j = 0; j < 4; j++) {
                value += weight[j] * basis[j][k];
            }
            essentials[count][k] = value;
            sum += value * value;
        }
        count += isfinite(sum) && sum > 0;
    }
    return count;
}

int essential_motions(const double e[9], motion motions[4])
{
    double u[9], s[3], vt[9], turned[9];
    static const double w[9] = {0, -1, 0, 1, 0, 0, 0, 0, 1}, w_back[9] = {0, 1, 0, -1, 0, 0, 0, 0, 1};
    if (singular3(e, u, s, vt) != 0) {
        return -1;
    }
    for (int i = 0; i < 4; i++) {
        multiply3(u, i < 2 ? w : w_back, turned);
        multiply3(turned, vt, motions[i].r);
        double sign = determinant3(motions[i].r) < 0 ? -1 : 1;
        for (int k = 0; k < 9; k++) {
            motions[i].r[k] *= sign;
        }
        for (int k = 0; k < 3; k++) {
            motions[i].t[k] = (i % 2 == 0 ? 1 : -1) * u[3 * k + 2];
        }
    }
    return 0;
}

void essential_of(const motion *m, double e[9])
{
    const double *t = m->t;
    const double crossed[9] = {0, -t[2], t[1], t[2], 0, -t[0], -t[1], t[0], 0};
    multiply3(crossed, m->r, e);
}
