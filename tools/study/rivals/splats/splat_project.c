/* SPDX-License-Identifier: Apache-2.0 */
/* Projection of one Gaussian, and its derivatives. EWA splatting: Zwicker et al. 2001; as 3D Gaussian Splatting uses
 * it: Kerbl et al. 2023, section 4 and appendix A. */
#include <math.h>

#include "geometry/quaternion.h"
#include "study/rivals/splats/splat_view.h"

#define NEAR (1.0 / 32)     /* camera z in scene units at which splats are culled */
#define WIDEST 16.0         /* |x / z|, |y / z| beyond which they are */
#define MOST_PIXELS 4096.0  /* entries of the projected factor are held within */
#define FIELD_OF_SLOPES 1.3 /* slopes of the linearisation are clamped to this times the slope of the farther edge */
#define KEY_MOST 2147483647.0

static double clamped(double x, double limit)
{
    return x < -limit ? -limit : x > limit ? limit : x;
}

/* Values that the forward and the backward pass share. */
typedef struct projection {
    double t[3];         /* camera coordinates */
    double axes[9];      /* R(q), row-major */
    double scale[3];     /* exp of the logarithms */
    double f[9];         /* camera x factor, row-major */
    double slope[2];     /* x / z, y / z, held within the field of view */
    bool held[2];        /* and whether they were */
    double g[2][3];      /* projected factor, pixels */
    bool clipped[2][3];  /* entries at MOST_PIXELS */
    double A, B, C, det; /* covariance with the low-pass, and its determinant */
} projection;

static void project_shape(const splat_camera *camera, const double *p, projection *j)
{
    const double *q = &p[SPLAT_ROTATION];
    double unit[4] = {q[0], q[1], q[2], q[3]};
    quaternion_normalise(unit);
    quaternion_matrix(unit, j->axes);
    for (int k = 0; k < 3; k++) {
        j->scale[k] = exp(p[SPLAT_LOG_SCALE + k]);
    }
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < 3; k++) {
            double sum = 0;
            for (int n = 0; n < 3; n++) {
                sum += camera->rotation[n * 3 + i] * j->axes[n * 3 + k];
            }
            j->f[i * 3 + k] = sum * j->scale[k];
        }
    }
}

static void project_covariance(projection *j)
{
    double minors = 0, xx = 0, xy = 0, yy = 0;
    for (int k = 0; k < 3; k++) {
        int l = (k + 1) % 3;
        double minor = j->g[0][k] * j->g[1][l] - j->g[0][l] * j->g[1][k];
        minors += minor * minor;
        xx += j->g[0][k] * j->g[0][k];
        xy += j->g[0][k] * j->g[1][k];
        yy += j->g[1][k] * j->g[1][k];
    }
    j->A = xx + SPLAT_LOW_PASS;
    j->B = xy;
    j->C = yy + SPLAT_LOW_PASS;
    /* Cauchy-Binet: a sum of positive terms, so nothing cancels for needles */
    j->det = minors + SPLAT_LOW_PASS * (xx + yy) + SPLAT_LOW_PASS * SPLAT_LOW_PASS;
}

/* False where the Gaussian is culled. */
static bool project(const splat_camera *camera, const double *p, projection *j)
{
    for (int i = 0; i < 3; i++) {
        j->t[i] = 0;
        for (int n = 0; n < 3; n++) {
            j->t[i] += camera->rotation[n * 3 + i] * (p[SPLAT_POSITION + n] - camera->position[n]);
        }
    }
    double z = j->t[2];
    if (!(z > NEAR) || fabs(j->t[0]) > WIDEST * z || fabs(j->t[1]) > WIDEST * z) {
        return false;
    }
    project_shape(camera, p, j);
    const double focal[2] = {camera->fx, camera->fy};
    const double side[2] = {camera->width, camera->height}, centre[2] = {camera->cx, camera->cy};
    for (int d = 0; d < 2; d++) {
        double slope = j->t[d] / z, edge = fmax(centre[d] + 0.5, side[d] - 0.5 - centre[d]);
        j->slope[d] = clamped(slope, FIELD_OF_SLOPES * edge / focal[d]);
        j->held[d] = j->slope[d] != slope;
        for (int k = 0; k < 3; k++) {
            double entry = focal[d] / z * (j->f[d * 3 + k] - j->slope[d] * j->f[6 + k]);
            j->g[d][k] = clamped(entry, MOST_PIXELS);
            j->clipped[d][k] = j->g[d][k] != entry;
        }
    }
    project_covariance(j);
    return isfinite(j->det); /* an optimiser may produce any value */
}

void splat_cut(double centre, double reach, uint32_t side, int32_t *low, int32_t *high)
{
    double least = ceil(centre - reach), most = floor(centre + reach);
    *low = least < 0 ? 0 : least > side ? (int32_t)side : (int32_t)least;
    *high = most > side - 1.0 ? (int32_t)side - 1 : most < -1 ? -1 : (int32_t)most;
}

splat splat_project(const splat_camera *camera, const double *p, double alpha_least)
{
    splat s = {.left = 0, .right = -1};
    projection j;
    double opacity = 1 / (1 + exp(-p[SPLAT_LOGIT]));
    if (!(opacity >= alpha_least) || !project(camera, p, &j)) {
        return s;
    }
    double z = j.t[2], x = camera->fx * j.t[0] / z + camera->cx, y = camera->fy * j.t[1] / z + camera->cy;
    double level = 2 * log(opacity / alpha_least);
    s.x = (float)x;
    s.y = (float)y;
    s.a = (float)(j.C / j.det);
    s.b = (float)(-j.B / j.det);
    s.c = (float)(j.A / j.det);
    s.opacity = (float)opacity;
    for (int i = 0; i < 3; i++) {
        s.colour[i] = (float)p[SPLAT_COLOUR + i];
    }
    s.depth_key = (uint32_t)fmin(floor(ldexp(z, 20) + 0.5), KEY_MOST);
    splat_cut(x, sqrt(level * j.A), camera->width, &s.left, &s.right);
    splat_cut(y, sqrt(level * j.C), camera->height, &s.top, &s.bottom);
    if (s.bottom < s.top) {
        s.right = s.left - 1;
    }
    return s;
}

/* ---- derivatives ----------------------------------------------------------------------------------------------- */

/* Chains the gradient from the conic to the projected factor: dg[axis][k]. */
static void chain_conic(const projection *j, const splat_gradient *g, double dg[2][3])
{
    double A = j->A, B = j->B, C = j->C, square = j->det * j->det;
    double dA = (-C * C * g->a + B * C * g->b - B * B * g->c) / square;
    double dC = (-B * B * g->a + A * B * g->b - A * A * g->c) / square;
    double dB = (2 * B * C * g->a - (A * C + B * B) * g->b + 2 * A * B * g->c) / square;
    for (int k = 0; k < 3; k++) {
        dg[0][k] = j->clipped[0][k] ? 0 : 2 * dA * j->g[0][k] + dB * j->g[1][k];
        dg[1][k] = j->clipped[1][k] ? 0 : 2 * dC * j->g[1][k] + dB * j->g[0][k];
    }
}

/* Chains the gradient from the rotation matrix to a quaternion of any norm. */
static void chain_rotation(const double *quaternion, const double m[9], double *gradient)
{
    double norm = sqrt(quaternion[0] * quaternion[0] + quaternion[1] * quaternion[1] + quaternion[2] * quaternion[2] +
                       quaternion[3] * quaternion[3]);
    double w = quaternion[0] / norm, x = quaternion[1] / norm, y = quaternion[2] / norm, z = quaternion[3] / norm;
    const double unit[4] = {
        2 * (x * (m[7] - m[5]) + y * (m[2] - m[6]) + z * (m[3] - m[1])),
        2 * (w * (m[7] - m[5]) + y * (m[1] + m[3]) + z * (m[2] + m[6]) - 2 * x * (m[4] + m[8])),
        2 * (w * (m[2] - m[6]) + x * (m[1] + m[3]) + z * (m[5] + m[7]) - 2 * y * (m[0] + m[8])),
        2 * (w * (m[3] - m[1]) + x * (m[2] + m[6]) + y * (m[5] + m[7]) - 2 * z * (m[0] + m[4])),
    };
    double along = w * unit[0] + x * unit[1] + y * unit[2] + z * unit[3];
    const double q[4] = {w, x, y, z};
    for (int i = 0; i < 4; i++) {
        gradient[i] += (unit[i] - q[i] * along) / norm;
    }
}

static void chain_shape(const splat_camera *camera, const double *p, const projection *j, const double df[9],
                        double *gradient)
{
    double axes[9];
    for (int n = 0; n < 3; n++) {
        for (int k = 0; k < 3; k++) {
            double sum = 0;
            for (int i = 0; i < 3; i++) {
                sum += camera->rotation[n * 3 + i] * df[i * 3 + k];
            }
            axes[n * 3 + k] = sum * j->scale[k];
            gradient[SPLAT_LOG_SCALE + k] += axes[n * 3 + k] * j->axes[n * 3 + k];
        }
    }
    chain_rotation(&p[SPLAT_ROTATION], axes, &gradient[SPLAT_ROTATION]);
}

void splat_chain(const splat_camera *camera, const double *p, const splat_gradient *g, double *gradient)
{
    projection j;
    if (!project(camera, p, &j)) {
        return;
    }
    const double focal[2] = {camera->fx, camera->fy}, centre[2] = {g->x, g->y};
    double z = j.t[2], dt[3] = {0}, df[9] = {0}, dg[2][3];
    chain_conic(&j, g, dg);
    for (int d = 0; d < 2; d++) {
        double dslope = 0;
        for (int k = 0; k < 3; k++) {
            df[d * 3 + k] += focal[d] / z * dg[d][k];
            df[6 + k] -= focal[d] / z * j.slope[d] * dg[d][k];
            dslope -= focal[d] / z * j.f[6 + k] * dg[d][k];
            dt[2] -= j.g[d][k] / z * dg[d][k];
        }
        if (!j.held[d]) {
            dt[d] += dslope / z;
            dt[2] -= dslope * j.slope[d] / z;
        }
        dt[d] += focal[d] / z * centre[d];
        dt[2] -= focal[d] * j.t[d] / (z * z) * centre[d];
    }
    for (int n = 0; n < 3; n++) {
        for (int i = 0; i < 3; i++) {
            gradient[SPLAT_POSITION + n] += camera->rotation[n * 3 + i] * dt[i];
        }
        gradient[SPLAT_COLOUR + n] += g->colour[n];
    }
    chain_shape(camera, p, &j, df, gradient);
    double opacity = 1 / (1 + exp(-p[SPLAT_LOGIT]));
    gradient[SPLAT_LOGIT] += g->opacity * opacity * (1 - opacity);
}
