#include "scene/harmonics.h"

#include <math.h>
#include <string.h>

#include "geometry/quaternion.h"

#define SIDE_MOST 7u /* number of harmonics of degree 3 */

void harmonics_of(const double direction[3], double values[HARMONICS_REST_MOST])
{
    const double x = direction[0], y = direction[1], z = direction[2];
    const double xx = x * x, yy = y * y, zz = z * z;
    /* sqrt(3 / 4 pi) */
    values[0] = -0.4886025119029199 * y;
    values[1] = 0.4886025119029199 * z;
    values[2] = -0.4886025119029199 * x;
    /* sqrt(15 / 4 pi), sqrt(5 / 16 pi), sqrt(15 / 16 pi) */
    values[3] = 1.0925484305920792 * x * y;
    values[4] = -1.0925484305920792 * y * z;
    values[5] = 0.31539156525252005 * (2 * zz - xx - yy);
    values[6] = -1.0925484305920792 * x * z;
    values[7] = 0.5462742152960396 * (xx - yy);
    /* sqrt(35 / 32 pi), sqrt(105 / 4 pi), sqrt(21 / 32 pi), sqrt(7 / 16 pi), sqrt(105 / 16 pi) */
    values[8] = -0.5900435899266435 * y * (3 * xx - yy);
    values[9] = 2.890611442640554 * x * y * z;
    values[10] = -0.4570457994644658 * y * (4 * zz - xx - yy);
    values[11] = 0.3731763325901154 * z * (2 * zz - 3 * xx - 3 * yy);
    values[12] = -0.4570457994644658 * x * (4 * zz - xx - yy);
    values[13] = 1.445305721320277 * z * (xx - yy);
    values[14] = -0.5900435899266435 * x * (xx - 3 * yy);
}

/* Solves A X = B for matrices of `side` rows by elimination with pivoting; B becomes X. */
static void solve(double a[SIDE_MOST][SIDE_MOST], double b[SIDE_MOST][SIDE_MOST], uint32_t side)
{
    for (uint32_t column = 0; column < side; column++) {
        uint32_t pivot = column;
        for (uint32_t row = column + 1; row < side; row++) {
            pivot = fabs(a[row][column]) > fabs(a[pivot][column]) ? row : pivot;
        }
        for (uint32_t i = 0; i < side; i++) {
            double kept = a[column][i];
            a[column][i] = a[pivot][i];
            a[pivot][i] = kept;
            kept = b[column][i];
            b[column][i] = b[pivot][i];
            b[pivot][i] = kept;
        }
        for (uint32_t row = 0; row < side; row++) {
            const double times = row == column ? 0 : a[row][column] / a[column][column];
            for (uint32_t i = 0; i < side; i++) {
                a[row][i] -= times * a[column][i];
                b[row][i] -= times * b[column][i];
            }
        }
    }
    for (uint32_t row = 0; row < side; row++) {
        for (uint32_t i = 0; i < side; i++) {
            b[row][i] /= a[row][row];
        }
    }
}

/* Finds the matrix by which a rotation R changes coefficients: the colour seen from d before is seen from R d
 * afterwards. As many directions as the degree has harmonics determine it. */
static void turn_degree(const double rotation[9], uint32_t degree, double *matrix)
{
    static const double directions[SIDE_MOST][3] = {{0.36, 0.48, 0.8}, {-0.6, 0.64, 0.48},  {0.8, -0.6, 0},
                                                    {0, 0.28, -0.96},  {-0.48, -0.8, 0.36}, {0.6, 0, 0.8},
                                                    {0.64, 0.6, -0.48}};
    const uint32_t first = harmonics_rest(degree - 1), side = 2 * degree + 1;
    double before[SIDE_MOST][SIDE_MOST], behind[SIDE_MOST][SIDE_MOST];
    for (uint32_t i = 0; i < side; i++) {
        const double *d = directions[i];
        double turned[3], values[HARMONICS_REST_MOST];
        matrix_apply(rotation, d, turned);
        harmonics_of(d, values);
        memcpy(before[i], &values[first], side * sizeof values[0]);
        harmonics_of(turned, values);
        memcpy(behind[i], &values[first], side * sizeof values[0]);
    }
    solve(behind, before, side);
    for (uint32_t row = 0; row < side; row++) {
        memcpy(&matrix[row * side], before[row], side * sizeof before[0][0]);
    }
}

harmonics_turn harmonics_turn_of(const double rotation[9])
{
    harmonics_turn turn;
    turn_degree(rotation, 1, turn.degree_1);
    turn_degree(rotation, 2, turn.degree_2);
    turn_degree(rotation, 3, turn.degree_3);
    return turn;
}

void harmonics_turn_apply(const harmonics_turn *turn, uint32_t degree, double rest[HARMONICS_REST_MOST][3])
{
    const double *matrices[] = {turn->degree_1, turn->degree_2, turn->degree_3};
    for (uint32_t d = 1; d <= degree; d++) {
        const uint32_t first = harmonics_rest(d - 1), side = 2 * d + 1;
        double before[SIDE_MOST][3];
        memcpy(before, rest[first], side * sizeof before[0]);
        for (uint32_t i = 0; i < side; i++) {
            for (int channel = 0; channel < 3; channel++) {
                double sum = 0;
                for (uint32_t k = 0; k < side; k++) {
                    sum += matrices[d - 1][i * side + k] * before[k][channel];
                }
                rest[first + i][channel] = sum;
            }
        }
    }
}
