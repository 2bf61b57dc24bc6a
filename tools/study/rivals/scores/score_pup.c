/* SPDX-License-Identifier: Apache-2.0 */
/* PUP 3D-GS: Principled Uncertainty Pruning for 3D Gaussian Splatting. Hanson, Tu et al., CVPR 2025 (arXiv:2406.10219),
 * section 4: the sensitivity of the reconstruction error to a Gaussian is U_i = log |det sum over the training views of
 * (grad I)(grad I)^T|, grad I the derivatives of the rendered pixels, each channel one, with respect to the Gaussian's
 * mean and the logarithms of its scales: a 6 x 6 block each.
 *
 * A pixel's channels depend on position and shape only through alpha, alpha on the splat's five numbers (centre and
 * conic), and these through the projection on the six. So 5 x 5 sums over a view's pixels are taken first, exactly, and
 * the Jacobian of the projection converts them to 6 x 6. The released code pools pixels into patches to save work; this
 * one does not. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "study/rivals/scores/score.h"

enum { FLAT = 5, FREE = 6 };

#define LEAST_PIVOT 0x1p-24

typedef struct sensitivity {
    double flat[FLAT][FLAT]; /* lower triangle */
} sensitivity;

typedef struct sweep {
    const splat_view *view;
    const float *rgb; /* the finished picture */
    float *blended;   /* up to and including the current splat */
    sensitivity *of;
} sweep;

/* Returns |dC / d alpha|^2 over the channels (splat_differentiate.c). */
static double colour_change(const sweep *s, size_t pixel, const splat *drawn, float alpha, float before)
{
    double sum = 0;
    for (int c = 0; c < 3; c++) {
        size_t at = pixel * 3 + (size_t)c;
        s->blended[at] += before * alpha * drawn->colour[c];
        double change = before * drawn->colour[c] - (s->rgb[at] - s->blended[at]) / (1 - alpha);
        sum += change * change;
    }
    return sum;
}

static void add_row(void *user, const splat_row *row)
{
    sweep *s = user;
    const splat *drawn = &s->view->splats[row->gaussian];
    double dy = (double)row->y - (double)drawn->y;
    for (uint32_t i = 0; i < row->columns; i++) {
        float alpha = row->alpha[i];
        if (alpha <= 0) {
            continue;
        }
        size_t pixel = (size_t)row->y * s->view->camera.width + row->x + i;
        double change = colour_change(s, pixel, drawn, alpha, row->before[i]);
        if (alpha >= SPLAT_ALPHA_MOST) {
            continue;
        }
        double dx = (double)(row->x + i) - (double)drawn->x;
        const double d[FLAT] = {alpha * (drawn->a * dx + drawn->b * dy), alpha * (drawn->b * dx + drawn->c * dy),
                                -0.5 * alpha * dx * dx, -alpha * dx * dy, -0.5 * alpha * dy * dy};
        for (int m = 0; m < FLAT; m++) {
            for (int n = 0; n <= m; n++) {
                s->of[row->gaussian].flat[m][n] += change * d[m] * d[n];
            }
        }
    }
}

/* Computes the derivatives j[m] of the splat's m-th number with respect to mean and log scales. */
static void jacobian(const splat_camera *camera, const double *parameters, double j[FLAT][FREE])
{
    for (int m = 0; m < FLAT; m++) {
        splat_gradient one = {.x = m == 0, .y = m == 1, .a = m == 2, .b = m == 3, .c = m == 4};
        double all[SPLAT_PARAMETERS] = {0};
        splat_chain(camera, parameters, &one, all);
        memcpy(j[m], &all[SPLAT_POSITION], 3 * sizeof(double));
        memcpy(&j[m][3], &all[SPLAT_LOG_SCALE], 3 * sizeof(double));
    }
}

static void carry(const sensitivity *s, double j[FLAT][FREE], double to[FREE][FREE])
{
    for (int m = 0; m < FLAT; m++) {
        for (int n = 0; n < FLAT; n++) {
            double flat = m >= n ? s->flat[m][n] : s->flat[n][m];
            for (int a = 0; a < FREE; a++) {
                for (int b = 0; b < FREE; b++) {
                    to[a][b] += j[m][a] * flat * j[n][b];
                }
            }
        }
    }
}

double score_pup_log_determinant(double matrix[FREE][FREE])
{
    double unit[FREE][FREE], sum = 0;
    for (int i = 0; i < FREE; i++) {
        if (!(matrix[i][i] > 0)) {
            return -HUGE_VAL;
        }
        sum += log(matrix[i][i]);
    }
    for (int i = 0; i < FREE; i++) {
        for (int j = 0; j < FREE; j++) {
            unit[i][j] = matrix[i][j] / sqrt(matrix[i][i]) / sqrt(matrix[j][j]);
        }
    }
    /* Gauss elimination needs no pivoting: all pivots of such a matrix are in 0..1 */
    for (int k = 0; k < FREE; k++) {
        double pivot = fmax(unit[k][k], LEAST_PIVOT);
        sum += log(pivot);
        for (int i = k + 1; i < FREE; i++) {
            for (int j = k + 1; j < FREE; j++) {
                unit[i][j] -= unit[i][k] * unit[k][j] / pivot;
            }
        }
    }
    return sum;
}

static bool add_view(const splat_model *model, const splat_view *view, sensitivity *flat, double (*free6)[FREE][FREE])
{
    size_t values = (size_t)view->camera.width * view->camera.height * 3;
    float *rgb = malloc(values * sizeof *rgb), *blended = calloc(values, sizeof *blended);
    bool done = rgb != NULL && blended != NULL;
    if (done) {
        sweep s = {.view = view, .rgb = rgb, .blended = blended, .of = flat};
        memset(flat, 0, model->count * sizeof *flat);
        splat_view_draw(view, rgb, NULL);
        splat_view_walk(view, add_row, &s);
    }
    for (uint32_t i = 0; i < model->count && done; i++) {
        const double *parameters = &model->parameters[(size_t)i * SPLAT_PARAMETERS];
        double j[FLAT][FREE];
        if (view->splats[i].left <= view->splats[i].right) {
            jacobian(&view->camera, parameters, j);
            carry(&flat[i], j, free6[i]);
        }
    }
    free(rgb);
    free(blended);
    return done;
}

bool score_pup(const splat_model *model, const splat_view *views, uint32_t view_count, double *score)
{
    sensitivity *flat = malloc(((size_t)model->count + 1) * sizeof *flat);
    double(*free6)[FREE][FREE] = calloc((size_t)model->count + 1, sizeof *free6);
    bool done = flat != NULL && free6 != NULL;
    for (uint32_t v = 0; v < view_count && done; v++) {
        done = add_view(model, &views[v], flat, free6);
    }
    for (uint32_t i = 0; i < model->count && done; i++) {
        score[i] = score_pup_log_determinant(free6[i]);
    }
    free(flat);
    free(free6);
    return done;
}
