/* SPDX-License-Identifier: Apache-2.0 */
/* The published scores on scenes where the answer is known, or can be had the slow way. */
#include <stdio.h>

#include "splat_scenes.h"
#include "study/rivals/scores/choose.h"
#include "study/rivals/scores/score.h"
#include "test.h"

enum { SIDE = 33 };

#define FOCAL 32.0

/* A ball in the middle, as wide as sigma pixels: the covariance of the drawn splat is sigma^2 + 0.3. */
static void set_pixels_wide(const splat_model *model, uint32_t gaussian, double z, double sigma, double opacity)
{
    set_ball(model, gaussian, 0, 0, z, sigma * z / FOCAL, opacity);
}

/* alpha of such a ball at a pixel that far from the middle */
static double alpha_at(double x, double y, double sigma, double opacity)
{
    double alpha = opacity * exp(-(x * x + y * y) / (2 * (sigma * sigma + 0.3)));
    return alpha < 1.0 / 255 ? 0 : fmin(alpha, 0.99);
}

/* Two balls behind one another: pixels, sum of weights of the front and of the back one. */
static void two_balls(double sigma, double front, double back, double pixels[2], double weights[2])
{
    pixels[0] = pixels[1] = weights[0] = weights[1] = 0;
    for (int y = -SIDE / 2; y <= SIDE / 2; y++) {
        for (int x = -SIDE / 2; x <= SIDE / 2; x++) {
            double a = alpha_at(x, y, sigma, front), b = alpha_at(x, y, sigma, back);
            pixels[0] += a > 0;
            pixels[1] += b > 0;
            weights[0] += a;
            weights[1] += (1 - a) * b;
        }
    }
}

/* Both balls, one more that no view sees. */
static splat_model two_and_one(void)
{
    splat_model model = plain_model(3);
    set_pixels_wide(&model, 0, 2, 2.5, 0.4); /* the back one comes first in the scene */
    set_pixels_wide(&model, 1, 1, 2.5, 0.8);
    set_ball(&model, 2, 0, 0, -1, 0.1, 0.9);
    return model;
}

TEST(eagles)
{
    double pixels[2], weights[2], score[3];
    two_balls(2.5, 0.8, 0.4, pixels, weights);
    splat_camera camera = middle_camera(FOCAL, SIDE, SIDE);
    splat_model model = two_and_one();
    splat_view views[2] = {view_of(&model, &camera, SPLAT_ALPHA_LEAST), view_of(&model, &camera, SPLAT_ALPHA_LEAST)};
    assert_true(score_eagles(&model, views, 1, score));
    assert_near(score[1], weights[0], 1e-3);
    assert_near(score[0], weights[1], 1e-3);
    assert_true(score[2] == 0);
    assert_true(score_eagles(&model, views, 2, score)); /* sums over views */
    assert_near(score[1], 2 * weights[0], 2e-3);
    splat_view_close(&views[0]);
    splat_view_close(&views[1]);
    splat_model_free(&model);
}

TEST(lightgaussian)
{
    double pixels[2], weights[2], score[3];
    two_balls(2.5, 0.8, 0.4, pixels, weights);
    splat_camera camera = middle_camera(FOCAL, SIDE, SIDE);
    splat_model model = two_and_one();
    splat_view view = view_of(&model, &camera, SPLAT_ALPHA_LEAST);
    assert_true(score_lightgaussian(&model, &view, 1, score));
    /* the back ball counts as much as it is seen through the front one */
    double seen = 0;
    for (int y = -SIDE / 2; y <= SIDE / 2; y++) {
        for (int x = -SIDE / 2; x <= SIDE / 2; x++) {
            seen += alpha_at(x, y, 2.5, 0.4) > 0 ? 1 - alpha_at(x, y, 2.5, 0.8) : 0;
        }
    }
    assert_true(seen < pixels[1] - 5);
    /* of three volumes the ninth decile is the largest, that of the back ball: twice as far, eight times the volume;
     * the unseen one's is smaller still */
    double largest = fmax(pow(2.5 * 2 / FOCAL, 3), 0.001);
    assert_near(score[0], seen * 0.4, 1e-3);
    assert_near(score[1], pixels[0] * 0.8 * pow(pow(2.5 / FOCAL, 3) / largest, 0.1), 1e-6);
    assert_true(score[2] == 0);
    splat_view_close(&view);
    splat_model_free(&model);
}

TEST(efficientgs)
{
    double pixels[2], weights[2], score[3];
    two_balls(2.5, 0.8, 0.4, pixels, weights);
    splat_camera camera = middle_camera(FOCAL, SIDE, SIDE);
    splat_model model = two_and_one();
    splat_view view = view_of(&model, &camera, SPLAT_ALPHA_LEAST);
    assert_true(score_efficientgs(&model, &view, 1, score));
    /* the front ball outweighs the back one wherever both are: it alone is dominant */
    assert_near(score[1], pixels[0] + 0.5, 1e-9);
    assert_near(score[0], 0.5 * weights[1] / weights[0], 1e-4);
    assert_true(score[2] == 0);

    /* faint in front: the back one has the middle, the front one the rim that it alone reaches */
    set_pixels_wide(&model, 1, 1, 5, 0.05);
    assert_true(splat_view_project(&view, &model));
    double front = 0, back = 0;
    for (int y = -SIDE / 2; y <= SIDE / 2; y++) {
        for (int x = -SIDE / 2; x <= SIDE / 2; x++) {
            double a = alpha_at(x, y, 5, 0.05), b = (1 - a) * alpha_at(x, y, 2.5, 0.4);
            front += a > 0 && a >= b;
            back += b > a;
        }
    }
    assert_true(score_efficientgs(&model, &view, 1, score));
    assert_true(front > 10 && back > 10);
    assert_near(floor(score[1]), front, 1e-9);
    assert_near(floor(score[0]), back, 1e-9);
    splat_view_close(&view);
    splat_model_free(&model);
}

/* ---- PUP ------------------------------------------------------------------------------------------------------ */

TEST(log_determinants)
{
    double matrix[6][6] = {{0}}, sum = 0;
    for (int i = 0; i < 6; i++) {
        matrix[i][i] = pow(10, 3 * i - 9);
        sum += log(matrix[i][i]);
    }
    assert_near(score_pup_log_determinant(matrix), sum, 1e-12);
    matrix[1][2] = matrix[2][1] = 0.5 * sqrt(matrix[1][1] * matrix[2][2]);
    assert_near(score_pup_log_determinant(matrix), sum + log(0.75), 1e-12);
    /* singular: held where the sums of floats end */
    matrix[1][2] = matrix[2][1] = sqrt(matrix[1][1] * matrix[2][2]);
    assert_near(score_pup_log_determinant(matrix), sum - 24 * log(2), 1e-9);
    matrix[5][5] = 0;
    assert_true(isinf(score_pup_log_determinant(matrix)) && score_pup_log_determinant(matrix) < 0);
}

enum { PUP_COUNT = 6 };

/* The derivatives of every value of the picture with respect to mean and log scales of one Gaussian, by differences. */
static void add_slowly(splat_model *model, uint32_t gaussian, const splat_camera *camera, double to[6][6])
{
    static float above[SIDE * SIDE * 3], below[SIDE * SIDE * 3];
    static double slope[6][SIDE * SIDE * 3];
    for (int k = 0; k < 6; k++) {
        double *p = &parameters_of(model, gaussian)[k], was = *p, step = k < 3 ? 1e-4 : 2e-3;
        for (int side = 0; side < 2; side++) {
            *p = side == 0 ? was + step : was - step;
            splat_view view = view_of(model, camera, 1e-6);
            splat_view_draw(&view, side == 0 ? above : below, NULL);
            splat_view_close(&view);
        }
        *p = was;
        for (int i = 0; i < SIDE * SIDE * 3; i++) {
            slope[k][i] = (double)(above[i] - below[i]) / (2 * step);
        }
    }
    for (int a = 0; a < 6; a++) {
        for (int b = 0; b < 6; b++) {
            for (int i = 0; i < SIDE * SIDE * 3; i++) {
                to[a][b] += slope[a][i] * slope[b][i];
            }
        }
    }
}

TEST(pup)
{
    dice d = {3};
    splat_model model = random_model(&d, PUP_COUNT + 1, FOCAL, SIDE, SIDE);
    set_ball(&model, PUP_COUNT, 0, 0, -1, 0.1, 0.9); /* nobody sees it */
    splat_camera cameras[3];
    splat_view views[3];
    for (int v = 0; v < 3; v++) {
        const double position[3] = {v - 1.0, 0.6 * v, 0.2 * v}, at[3] = {0, 0, 1.5};
        t3r_camera camera = camera_towards(FOCAL, SIDE, SIDE, position, at);
        cameras[v] = splat_camera_of(&camera, &scene_frame, SIDE, SIDE);
        views[v] = view_of(&model, &cameras[v], 1e-6);
    }
    double score[PUP_COUNT + 1];
    assert_true(score_pup(&model, views, 3, score));
    for (uint32_t i = 0; i < PUP_COUNT; i++) {
        double matrix[6][6] = {{0}};
        for (int v = 0; v < 3; v++) {
            add_slowly(&model, i, &cameras[v], matrix);
        }
        assert_near(score[i], score_pup_log_determinant(matrix), 0.1);
    }
    assert_true(isinf(score[PUP_COUNT]) && score[PUP_COUNT] < 0);
    /* one view cannot tell near and small from far and large: 17 nats for what it does not see */
    double alone[PUP_COUNT + 1];
    assert_true(score_pup(&model, views, 1, alone));
    for (uint32_t i = 0; i < PUP_COUNT; i++) {
        assert_true(alone[i] < score[i] - 5);
    }
    for (int v = 0; v < 3; v++) {
        splat_view_close(&views[v]);
    }
    splat_model_free(&model);
}

/* ---- random, and choosing ------------------------------------------------------------------------------------- */

TEST(random_scores)
{
    enum { COUNT = 10000 };
    static double first[COUNT], other[COUNT];
    splat_model model = {COUNT, COUNT, NULL};
    assert_true(score_random(&model, 1, first) && score_random(&model, 2, other));
    double sum = 0, product = 0, neighbours = 0;
    for (int i = 0; i < COUNT; i++) {
        assert_true(first[i] >= 0 && first[i] < 1);
        sum += first[i];
        product += (first[i] - 0.5) * (other[i] - 0.5);
        neighbours += i == 0 ? 0 : (first[i] - 0.5) * (first[i - 1] - 0.5);
    }
    /* five standard deviations */
    assert_near(sum / COUNT, 0.5, 5 * 0.2887 / 100);
    assert_near(product / COUNT, 0, 5 * 0.0833 / 100);
    assert_near(neighbours / COUNT, 0, 5 * 0.0833 / 100);
    assert_true(score_random(&model, 1, other));
    assert_memory_equal(first, other, sizeof first);
}

TEST(choosing)
{
    const double score[7] = {1, 3, -HUGE_VAL, 3, 2, 3, -HUGE_VAL};
    static const uint32_t wanted[8][7] = {
        {0}, {1}, {1, 3}, {1, 3, 5}, {1, 3, 4, 5}, {0, 1, 3, 4, 5}, {0, 1, 2, 3, 4, 5}, {0, 1, 2, 3, 4, 5, 6}};
    for (uint32_t count = 0; count <= 7; count++) {
        uint32_t *kept = calloc(count + 1, sizeof *kept);
        assert_non_null(kept);
        assert_true(rival_choose(score, 7, 7, count, kept));
        assert_memory_equal(kept, wanted[count], count * sizeof *kept);
        free(kept);
    }
}

/* The last two Gaussians are a rim. */
TEST(choosing_beside_a_rim)
{
    double score[40];
    uint32_t kept[40];
    for (uint32_t i = 0; i < 40; i++) {
        score[i] = i; /* the rim's would be the highest */
    }
    for (uint32_t count = 0; count <= 40; count++) {
        const uint32_t rim = count >= 32 ? 2 : 0;
        assert_true(rival_choose(score, 38, 40, count, kept));
        for (uint32_t n = 0; n < count; n++) {
            assert_int_equal(kept[n], n < count - rim ? 38 - (count - rim) + n : 38 + n - (count - rim));
        }
    }
    assert_true(rival_choose(score, 1, 3, 2, kept)); /* no room for a whole rim, and too few surfaces */
    assert_int_equal(kept[0], 0);
    assert_int_equal(kept[1], 1);
}
