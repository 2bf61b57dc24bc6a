/* One-sided Jacobi on the rows of F: exact to the last bits even for thin Gaussians, where an eigendecomposition of the
 * covariance would lose all scales below 1e-8 of the largest. */
#include "scene/gaussian_shape.h"

#include <math.h>

#include "geometry/quaternion.h"

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void rotate_pair(double a[3], double b[3], double cosine, double sine)
{
    for (int i = 0; i < 3; i++) {
        double x = a[i], y = b[i];
        a[i] = cosine * x - sine * y;
        b[i] = sine * x + cosine * y;
    }
}

gaussian_shape gaussian_shape_of(const t3r_gaussian *gaussian)
{
    double row[3][3], axis[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (int i = 0; i < 9; i++) {
        row[i / 3][i % 3] = gaussian->factor[i];
    }
    /* three pairs per sweep; 3x3 converges in 5 or 6 sweeps */
    for (int sweep = 0; sweep < 20; sweep++) {
        int turned = 0;
        for (int p = 0; p < 2; p++) {
            for (int q = p + 1; q < 3; q++) {
                double pp = dot(row[p], row[p]), qq = dot(row[q], row[q]), pq = dot(row[p], row[q]);
                if (fabs(pq) <= 1e-15 * sqrt(pp * qq)) {
                    continue;
                }
                double zeta = (qq - pp) / (2 * pq);
                double tangent = copysign(1 / (fabs(zeta) + sqrt(1 + zeta * zeta)), zeta);
                double cosine = 1 / sqrt(1 + tangent * tangent);
                rotate_pair(row[p], row[q], cosine, cosine * tangent);
                rotate_pair(axis[p], axis[q], cosine, cosine * tangent);
                turned = 1;
            }
        }
        if (!turned) {
            break;
        }
    }
    gaussian_shape shape;
    double largest = 0;
    for (int i = 0; i < 3; i++) {
        shape.scale[i] = ldexp(sqrt(dot(row[i], row[i])), gaussian->factor_exponent);
        largest = fmax(largest, shape.scale[i]);
    }
    double least = largest > 0 ? largest * GAUSSIAN_SHAPE_THINNEST : GAUSSIAN_SHAPE_POINT;
    for (int i = 0; i < 3; i++) {
        shape.scale[i] = fmax(shape.scale[i], least);
    }
    /* the axes are the rotation's columns */
    const double rotation[9] = {axis[0][0], axis[1][0], axis[2][0], axis[0][1], axis[1][1],
                                axis[2][1], axis[0][2], axis[1][2], axis[2][2]};
    quaternion_of_rotation(rotation, shape.rotation);
    return shape;
}

int gaussian_shape_set(t3r_gaussian *gaussian, const double scale[3], const double rotation[4])
{
    double unit[4] = {rotation[0], rotation[1], rotation[2], rotation[3]}, factor[9];
    const double norm = quaternion_norm(unit);
    if (!(norm > 0) || !isfinite(norm)) {
        return -1;
    }
    quaternion_normalise(unit);
    quaternion_matrix(unit, factor);
    double largest = 0;
    for (int i = 0; i < 9; i++) {
        factor[i] *= scale[i % 3];
        largest = fmax(largest, fabs(factor[i]));
    }
    if (!isfinite(largest)) {
        return -1;
    }
    int exponent = -60;
    if (largest > 0) {
        (void)frexp(largest, &exponent);
        exponent -= 15; /* brings the largest mantissa to [2^14, 2^15] */
        if (nearbyint(ldexp(largest, -exponent)) > INT16_MAX) {
            exponent++;
        }
        exponent = exponent < -60 ? -60 : exponent;
    }
    if (exponent > 15) {
        return -1;
    }
    for (int i = 0; i < 9; i++) {
        gaussian->factor[i] = (int16_t)nearbyint(ldexp(factor[i], -exponent));
    }
    gaussian->factor_exponent = (int8_t)exponent;
    return 0;
}

void gaussian_covariance(const t3r_gaussian *gaussian, double covariance[9])
{
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            double sum = 0; /* exact: products are below 2^30 */
            for (int k = 0; k < 3; k++) {
                sum += (double)gaussian->factor[3 * i + k] * gaussian->factor[3 * j + k];
            }
            covariance[3 * i + j] = ldexp(sum, 2 * gaussian->factor_exponent);
        }
    }
}
