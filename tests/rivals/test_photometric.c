/* SPDX-License-Identifier: Apache-2.0 */
/* The loss of fine-tuning against a direct computation of its definition, and its derivatives against differences. */
#include "splat_scenes.h"
#include "study/rivals/tuning/photometric.h"
#include "test.h"

enum { WIDTH = 19, HEIGHT = 14, VALUES = WIDTH * HEIGHT * 3 };

static void fill(uint8_t *target, float *rgb, uint64_t seed)
{
    dice d = {seed};
    for (int i = 0; i < VALUES; i++) {
        target[i] = (uint8_t)dice_below(&d, 256);
        rgb[i] = (float)fmin(fmax(target[i] / 255.0 + dice_between(&d, -0.3, 0.3), 0), 1);
    }
}

/* Weighted sums over the 11 x 11 window about a pixel, zeros beyond the border: of a, b, a^2, b^2, ab. */
static void window_sums(const uint8_t *target, const float *rgb, int x, int y, int c, double sum[5])
{
    double norm = 0;
    for (int i = -5; i <= 5; i++) {
        norm += exp(-i * i / 4.5);
    }
    for (int k = 0; k < 5; k++) {
        sum[k] = 0;
    }
    for (int v = y - 5; v <= y + 5; v++) {
        for (int u = x - 5; u <= x + 5; u++) {
            if (u < 0 || v < 0 || u >= WIDTH || v >= HEIGHT) {
                continue;
            }
            double w = exp(-((u - x) * (u - x) + (v - y) * (v - y)) / 4.5) / (norm * norm);
            double a = rgb[(v * WIDTH + u) * 3 + c], b = target[(v * WIDTH + u) * 3 + c] / 255.0;
            sum[0] += w * a;
            sum[1] += w * b;
            sum[2] += w * a * a;
            sum[3] += w * b * b;
            sum[4] += w * a * b;
        }
    }
}

static double loss_slowly(const uint8_t *target, const float *rgb, double similarity)
{
    double difference = 0, likeness = 0;
    for (int i = 0; i < VALUES; i++) {
        double m[5];
        difference += fabs(rgb[i] - target[i] / 255.0) / VALUES;
        window_sums(target, rgb, i / 3 % WIDTH, i / 3 / WIDTH, i % 3, m);
        double c1 = 0.01 * 0.01, c2 = 0.03 * 0.03;
        likeness += (2 * m[0] * m[1] + c1) * (2 * (m[4] - m[0] * m[1]) + c2) /
                    ((m[0] * m[0] + m[1] * m[1] + c1) * (m[2] - m[0] * m[0] + m[3] - m[1] * m[1] + c2)) / VALUES;
    }
    return (1 - similarity) * difference + similarity * (1 - likeness);
}

TEST(against_definition)
{
    static const double shares[] = {0, 0.2, 1};
    uint8_t target[VALUES];
    float rgb[VALUES], gradient[VALUES];
    fill(target, rgb, 1);
    photometric p;
    assert_true(photometric_open(&p, target, WIDTH, HEIGHT));
    for (size_t i = 0; i < 3; i++) {
        double loss = photometric_loss(&p, shares[i], rgb, gradient), wanted = loss_slowly(target, rgb, shares[i]);
        assert_true(wanted > 0.01 && fabs(loss - wanted) < 1e-5);
    }
    for (int i = 0; i < VALUES; i++) {
        rgb[i] = (float)target[i] / 255;
    }
    assert_true(fabs(photometric_loss(&p, 0.2, rgb, gradient)) < 1e-6);
    photometric_close(&p);
}

TEST(derivatives)
{
    static const double shares[] = {0, 0.2, 1};
    uint8_t target[VALUES];
    float rgb[VALUES], gradient[VALUES];
    fill(target, rgb, 2);
    photometric p;
    assert_true(photometric_open(&p, target, WIDTH, HEIGHT));
    for (size_t s = 0; s < 3; s++) {
        (void)photometric_loss(&p, shares[s], rgb, gradient);
        for (int i = 0; i < VALUES; i += 7) {
            float was = rgb[i], step = 1e-3f;
            if (fabs(was - target[i] / 255.0) < 2e-3) {
                continue; /* the corner of the absolute value */
            }
            rgb[i] = was + step;
            double above = loss_slowly(target, rgb, shares[s]);
            rgb[i] = was - step;
            double slope = (above - loss_slowly(target, rgb, shares[s])) / (2 * (double)step);
            rgb[i] = was;
            assert_true(fabs(slope - (double)gradient[i]) < 2e-2 / VALUES);
        }
    }
    photometric_close(&p);
}
