/* SPDX-License-Identifier: Apache-2.0 */
#include "oracle_refine.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { PARAMETERS = 6 };

/* A Gaussian as seen by one view. */
typedef struct footprint {
    size_t index;
    double z, x, y;
    double rows[2][3]; /* T */
    double inverse[3]; /* of T T^T + 0.3 I: xx xy yy */
} footprint;

typedef struct sums {
    double colour[3], weight, b[PARAMETERS], a[PARAMETERS][PARAMETERS];
} sums;

static void *take(size_t count, size_t bytes)
{
    void *memory = calloc(count == 0 ? 1 : count, bytes);
    if (memory == NULL) {
        fputs("out of memory\n", stderr);
        exit(1);
    }
    return memory;
}

static double held(double x, double most)
{
    return x < -most ? -most : x > most ? most : x;
}

static int look(const oracle_gaussian *g, const oracle_camera *camera, footprint *f)
{
    double c[3], along[3][3];
    for (int k = 0; k < 3; k++) {
        c[k] = 0;
        for (int i = 0; i < 3; i++) {
            c[k] += camera->rotation[3 * i + k] * (g->position[i] - camera->position[i]);
        }
        for (int j = 0; j < 3; j++) {
            along[k][j] = 0;
            for (int i = 0; i < 3; i++) {
                along[k][j] += camera->rotation[3 * i + k] * g->factor[3 * i + j];
            }
        }
    }
    if (c[2] <= ORACLE_NEAR || g->opacity < 1.0 / 255) {
        return 0;
    }
    f->z = floor(c[2] * 1048576 + 0.5);
    f->x = camera->cx + camera->fx * c[0] / c[2];
    f->y = camera->cy + camera->fy * c[1] / c[2];
    double u = held(c[0] / c[2], 0.65 * camera->width / camera->fx);
    double v = held(c[1] / c[2], 0.65 * camera->height / camera->fy);
    double xx = 0.3, xy = 0, yy = 0.3;
    for (int j = 0; j < 3; j++) {
        f->rows[0][j] = camera->fx / c[2] * (along[0][j] - u * along[2][j]);
        f->rows[1][j] = camera->fy / c[2] * (along[1][j] - v * along[2][j]);
        xx += f->rows[0][j] * f->rows[0][j];
        xy += f->rows[0][j] * f->rows[1][j];
        yy += f->rows[1][j] * f->rows[1][j];
    }
    double determinant = xx * yy - xy * xy;
    f->inverse[0] = yy / determinant;
    f->inverse[1] = -xy / determinant;
    f->inverse[2] = xx / determinant;
    return 1;
}

static int by_depth(const void *a, const void *b)
{
    const footprint *one = a, *other = b;
    if (one->z != other->z) {
        return one->z < other->z ? -1 : 1;
    }
    return one->index < other->index ? -1 : one->index > other->index;
}

static double alpha_at(const footprint *f, const oracle_gaussian *g, double dx, double dy)
{
    double q = 0.5 * (f->inverse[0] * dx * dx + 2 * f->inverse[1] * dx * dy + f->inverse[2] * dy * dy);
    double alpha = fmin(0.99, g->opacity * exp(-q));
    return alpha < 1.0 / 255 ? 0 : alpha;
}

static void add(sums *s, const footprint *f, const oracle_gaussian *g, double dx, double dy, double weight,
                const double behind[3], const double residual[3])
{
    double e[2], gr = 0, gg = 0;
    for (int k = 0; k < 2; k++) {
        double sx = f->inverse[0] * dx + f->inverse[1] * dy, sy = f->inverse[1] * dx + f->inverse[2] * dy;
        e[k] = held(f->rows[0][k] * sx + f->rows[1][k] * sy, 3.5);
    }
    for (int c = 0; c < 3; c++) {
        double change = weight * (255 * g->colour[c] - held(behind[c], 255));
        gr += change * residual[c];
        gg += change * change;
        s->colour[c] += weight * residual[c];
    }
    s->weight += weight;
    const double phi[PARAMETERS] = {1, e[0], e[1], e[0] * e[0] - 0.5, 2 * e[0] * e[1], e[1] * e[1] - 0.5};
    for (int i = 0; i < PARAMETERS; i++) {
        s->b[i] += gr * phi[i];
        for (int j = 0; j < PARAMETERS; j++) {
            s->a[i][j] += gg * phi[i] * phi[j];
        }
    }
}

/* Measures every pixel of one view by visiting all splats: slow and plain. */
static void measure(const oracle_gaussian *scene, size_t count, const oracle_context *view, sums *all)
{
    footprint *seen = take(count, sizeof *seen);
    size_t visible = 0;
    for (size_t i = 0; i < count; i++) {
        seen[visible].index = i;
        visible += (size_t)look(&scene[i], &view->camera, &seen[visible]);
    }
    qsort(seen, visible, sizeof *seen, by_depth);
    for (size_t pixel = 0; pixel < (size_t)view->camera.width * view->camera.height; pixel++) {
        if (!view->counts[pixel]) {
            continue;
        }
        double px = (double)(pixel % view->camera.width), py = (double)(pixel / view->camera.width);
        double whole[3] = {0}, so_far[3] = {0}, residual[3], left = 1;
        for (size_t i = 0; i < visible && left >= 1e-4; i++) {
            const oracle_gaussian *g = &scene[seen[i].index];
            double weight = left * alpha_at(&seen[i], g, px - seen[i].x, py - seen[i].y);
            for (int c = 0; c < 3; c++) {
                whole[c] += weight * 255 * g->colour[c];
            }
            left -= weight;
        }
        for (int c = 0; c < 3; c++) {
            residual[c] = view->rgb[3 * pixel + (size_t)c] - whole[c];
        }
        left = 1;
        for (size_t i = 0; i < visible && left >= 1e-4; i++) {
            const oracle_gaussian *g = &scene[seen[i].index];
            double weight = left * alpha_at(&seen[i], g, px - seen[i].x, py - seen[i].y), behind[3];
            if (weight == 0) {
                continue;
            }
            left -= weight;
            for (int c = 0; c < 3; c++) {
                so_far[c] += weight * 255 * g->colour[c];
                behind[c] = (whole[c] - so_far[c]) / left;
            }
            add(&all[seen[i].index], &seen[i], g, px - seen[i].x, py - seen[i].y, weight, behind, residual);
        }
    }
    free(seen);
}

static void solve(const sums *s, double x[PARAMETERS])
{
    memset(x, 0, PARAMETERS * sizeof *x);
    for (int sweep = 0; sweep < 8; sweep++) {
        for (int i = 0; i < PARAMETERS; i++) {
            double rest = s->b[i];
            for (int j = 0; j < PARAMETERS; j++) {
                rest -= j == i ? 0 : s->a[i][j] * x[j];
            }
            x[i] = held(rest / (s->a[i][i] * (1 + 3.0 / 16) + 64), 8);
        }
    }
    x[0] -= (x[3] + x[5]) / 2;
}

static double share_of(const sums *s, const double wanted[PARAMETERS], const oracle_change *before)
{
    if (before->share == 0) {
        return 11.0 / 64;
    }
    double again = 0, squared = 0;
    for (int i = 0; i < PARAMETERS; i++) {
        again += s->a[i][i] * before->step[i] * held(wanted[i], 2);
        squared += s->a[i][i] * before->step[i] * before->step[i];
    }
    if (squared == 0) {
        return before->share;
    }
    double answered = squared - again * before->share;
    double share = answered <= 0 ? 2 * before->share : before->share * squared / answered;
    return fmin(fmin(2 * before->share, 0.5), fmax(fmax(before->share / 4, 1.0 / 32), share));
}

static void correct(const sums *s, oracle_change *change, oracle_gaussian *g)
{
    const oracle_change before = *change;
    *change = (oracle_change){0};
    if (s->weight == 0) {
        return;
    }
    const double momentum = 3.0 / 16, most[PARAMETERS] = {0.5, 0.5, 0.5, 0.1, 0.1, 0.1};
    double x[PARAMETERS];
    solve(s, x);
    change->share = share_of(s, x, &before);
    for (int i = 0; i < PARAMETERS; i++) {
        x[i] = held(held(change->share * x[i], most[i]) + momentum * before.step[i], 0.5);
        change->step[i] = x[i];
    }
    for (int c = 0; c < 3; c++) {
        change->colour[c] = held(26.0 / 32 * s->colour[c] / s->weight + momentum * before.colour[c], 255);
        g->colour[c] = fmin(1, fmax(0, g->colour[c] + change->colour[c] / 255));
        double *row = g->factor + 3 * c;
        const double along = row[0], across = row[1];
        g->position[c] += along * x[1] + across * x[2];
        row[0] = along * (1 + x[3]) + across * x[4];
        row[1] = along * x[4] + across * (1 + x[5]);
    }
    g->opacity = fmin(fmax(0.99, g->opacity), fmax(fmin(256.0 / 32768, g->opacity), g->opacity * exp(x[0])));
}

void oracle_refine(oracle_gaussian *scene, size_t count, const oracle_context *views, size_t view_count,
                   oracle_change *changes)
{
    sums *all = take(count, sizeof *all);
    for (size_t v = 0; v < view_count; v++) {
        measure(scene, count, &views[v], all);
    }
    for (size_t i = 0; i < count; i++) {
        correct(&all[i], &changes[i], &scene[i]);
    }
    free(all);
}
