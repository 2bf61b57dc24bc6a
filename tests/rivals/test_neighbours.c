/* SPDX-License-Identifier: Apache-2.0 */
/* Distances to the nearest neighbours against a search of all pairs, and the widths made of them. */
#include "splat_scenes.h"
#include "study/rivals/tuning/neighbours.h"
#include "test.h"

enum { COUNT = 700 };

/* Scatters centres over a plane, with some in the same place and one far away. */
static splat_model scattered(uint32_t count)
{
    dice d = {5};
    splat_model model = plain_model(count);
    for (uint32_t i = 0; i < count; i++) {
        double *p = parameters_of(&model, i);
        p[0] = dice_between(&d, -1, 1);
        p[1] = dice_between(&d, -1, 1);
        p[2] = 1 + 0.1 * p[0];
        if (i % 50 == 1) {
            memcpy(p, parameters_of(&model, i - 1), 3 * sizeof *p);
        }
    }
    parameters_of(&model, count - 1)[2] = 1e4;
    return model;
}

/* Returns the same distance by comparing with every other Gaussian. */
static double slow_distance(const splat_model *model, uint32_t of)
{
    double nearest[NEIGHBOURS] = {INFINITY, INFINITY, INFINITY}, sum = 0;
    for (uint32_t i = 0; i < model->count; i++) {
        const double *a = parameters_of(model, of), *b = parameters_of(model, i);
        double square = pow(a[0] - b[0], 2) + pow(a[1] - b[1], 2) + pow(a[2] - b[2], 2);
        for (int k = 0; k < NEIGHBOURS && i != of; k++) {
            if (square < nearest[k]) {
                double farther = nearest[k];
                nearest[k] = square;
                square = farther;
            }
        }
    }
    int count = 0;
    for (; count < NEIGHBOURS && isfinite(nearest[count]); count++) {
        sum += nearest[count];
    }
    return count == 0 ? 0 : sqrt(sum / count);
}

TEST(every_pair)
{
    static const uint32_t counts[] = {1, 2, 3, 4, 5, 64, COUNT};
    for (size_t n = 0; n < sizeof counts / sizeof counts[0]; n++) {
        splat_model model = scattered(counts[n]);
        double distance[COUNT];
        assert_true(neighbour_distances(&model, distance));
        for (uint32_t i = 0; i < model.count; i++) {
            assert_near(distance[i], slow_distance(&model, i), 1e-9 * (1 + distance[i]));
        }
        splat_model_free(&model);
    }
}

/* The largest axis becomes the distance, and the others keep their ratio to it. */
TEST(widths)
{
    splat_model model = plain_model(5);
    for (uint32_t i = 0; i < 5; i++) {
        double *p = parameters_of(&model, i);
        p[0] = i < 4 ? 0.25 * i : 0.75; /* the last two are in one place */
        p[SPLAT_LOG_SCALE] = log(0.01);
        p[SPLAT_LOG_SCALE + 1] = log(0.02);
        p[SPLAT_LOG_SCALE + 2] = log(0.001);
    }
    assert_true(neighbour_widen(&model));
    const double *first = &parameters_of(&model, 0)[SPLAT_LOG_SCALE]; /* neighbours at 1/4, 1/2, 3/4 */
    const double wide = 0.25 * sqrt((1 + 4 + 9) / 3.0);
    assert_near(exp(first[0]), wide / 2, 1e-12);
    assert_near(exp(first[1]), wide, 1e-12);
    assert_near(exp(first[2]), wide / 20, 1e-12);
    splat_model_free(&model);

    model = plain_model(4); /* all in one place: nothing to go by */
    const double was = parameters_of(&model, 0)[SPLAT_LOG_SCALE];
    assert_true(neighbour_widen(&model));
    assert_true(parameters_of(&model, 0)[SPLAT_LOG_SCALE] == was);
    splat_model_free(&model);
}
