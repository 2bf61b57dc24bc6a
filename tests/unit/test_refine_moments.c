/* Moments in a splat's own coordinates against sums in double over the same pixels. */
#include "unit.h"

#include <stdbool.h>

#include "kernels/scatter_columns.h"
#include "refine/refine_moments.h"

enum { SIDE = T3R_TILE_SIDE, CURVATURE_MOST_Q2 = 786432, GRADIENT_MOST_Q3 = 1566720 };

/* What pixels of a tile tell a splat centred at (x, y) of it. */
typedef struct told {
    t3r_own_axes axes;
    double x, y;
    uint32_t column, columns, first, last; /* eight columns or sixteen */
    uint32_t curvature_q2[SIDE][SIDE];
    int32_t gradient_q3[SIDE][SIDE];
} told;

/* C(n + k, k) */
static int64_t choose(int64_t n, int64_t k)
{
    int64_t c = 1;
    for (int64_t i = 1; i <= k; i++) {
        c = c * (n + i) / i;
    }
    return c;
}

static t3r_tile_sums sums_of(const told *t)
{
    t3r_tile_sums sums;
    memset(&sums, 0, sizeof sums);
    for (uint32_t block = 0; block < t->columns; block += T3R_LANES) {
        t3r_scatter_sums lanes;
        memset(&lanes, 0, sizeof lanes);
        for (uint32_t j = t->first; j <= t->last; j++) {
            for (uint32_t i = 0; i < T3R_LANES; i++) {
                int64_t gg = t->curvature_q2[j][t->column + block + i], gr = t->gradient_q3[j][t->column + block + i];
                for (int l = 0; l < 4; l++) {
                    lanes.curvature[l][i] += (uint32_t)(gg * choose(t->last - j, l));
                }
                lanes.curvature_4[i] += (uint64_t)(gg * choose(t->last - j, 4));
                for (int l = 0; l < 3; l++) {
                    lanes.gradient[l][i] += (int32_t)(gr * choose(t->last - j, l));
                }
            }
        }
        t3r_tile_sums_add(&sums, &lanes);
    }
    return sums;
}

static void own_at(const told *t, uint32_t i, uint32_t j, double e[2])
{
    for (int k = 0; k < 2; k++) {
        e[k] = (t->axes.right_q20[k] * (i - t->x) + t->axes.down_q20[k] * (j - t->y)) / (1 << 20);
    }
}

/* In the order of T3R_REFINE_MOMENTS_4. */
static void powers_of(const double e[2], double power[T3R_REFINE_MOMENTS_4])
{
    for (int n = 0, k = 0; n <= 4; n++) {
        for (int l = 0; l <= n; l++, k++) {
            power[k] = pow(e[0], n - l) * pow(e[1], l);
        }
    }
}

/* Each moment of order n is right to a thousandth of the sum of |value| (1 + |e|)^n, and to one level^2, where 64 are
 * noise to refinement. Returns the largest share of that. */
static double compare(const told *t)
{
    t3r_tile_sums sums = sums_of(t);
    t3r_own_moments own;
    uint32_t right = t->column + t->columns - 1;
    t3r_own_moments_of(&sums, &t->axes, llround((right - t->x) * 4096), llround((t->last - t->y) * 4096), &own);
    double gg[T3R_REFINE_MOMENTS_4] = {0}, gr[T3R_REFINE_MOMENTS_2] = {0}, gg_all[5] = {0}, gr_all[5] = {0}, most = 0;
    for (uint32_t j = t->first; j <= t->last; j++) {
        for (uint32_t i = t->column; i <= right; i++) {
            double e[2], power[T3R_REFINE_MOMENTS_4];
            double square = t->curvature_q2[j][i] / 4.0, product = t->gradient_q3[j][i] / 8.0;
            own_at(t, i, j, e);
            powers_of(e, power);
            for (int k = 0; k < T3R_REFINE_MOMENTS_4; k++) {
                gg[k] += square * power[k];
            }
            for (int k = 0; k < T3R_REFINE_MOMENTS_2; k++) {
                gr[k] += product * power[k];
            }
            for (int n = 0; n < 5; n++) {
                gg_all[n] += square * pow(1 + hypot(e[0], e[1]), n);
                gr_all[n] += fabs(product) * pow(1 + hypot(e[0], e[1]), n);
            }
        }
    }
    for (int n = 0, k = 0; n < 5; n++) {
        for (int l = 0; l <= n; l++, k++) {
            most = fmax(most, fabs((double)own.curvature[k] / 128 - gg[k]) / (gg_all[n] / 1000 + 1));
            if (n < 3) {
                most = fmax(most, fabs((double)own.gradient[k] / 128 - gr[k]) / (gr_all[n] / 1000 + 1));
            }
        }
    }
    return most;
}

/* A splat of deviations a, b px turned by `angle`, T's columns at `skew` to its axes. */
static void place(told *t, double x, double y, double a, double b, double angle, double skew)
{
    double c = cos(angle), s = sin(angle), along[2] = {a / (a * a + 0.3), b / (b * b + 0.3)};
    t->x = floor(x * 4096) / 4096;
    t->y = floor(y * 4096) / 4096;
    double ks = sin(skew), kc = cos(skew), k[2][2] = {{kc * along[0], ks * along[1]}, {-ks * along[0], kc * along[1]}};
    for (int i = 0; i < 2; i++) {
        t->axes.right_q20[i] = (int32_t)lround((k[i][0] * c - k[i][1] * s) * (1 << 20));
        t->axes.down_q20[i] = (int32_t)lround((k[i][0] * s + k[i][1] * c) * (1 << 20));
    }
}

/* Pixels inside |e| < 3.47 tell something, others nothing; returns how many do. */
static uint32_t fill(told *t, uint64_t *seed, uint32_t most_q2)
{
    uint32_t count = 0;
    memset(t->curvature_q2, 0, sizeof t->curvature_q2);
    memset(t->gradient_q3, 0, sizeof t->gradient_q3);
    for (uint32_t j = t->first; j <= t->last; j++) {
        for (uint32_t i = t->column; i < t->column + t->columns; i++) {
            double e[2];
            own_at(t, i, j, e);
            if (hypot(e[0], e[1]) < 3.47) {
                double fall = exp(-(e[0] * e[0] + e[1] * e[1]) / 2);
                t->curvature_q2[j][i] = (uint32_t)(fall * fall * (double)unit_between(seed, 0, most_q2));
                t->gradient_q3[j][i] =
                    (int32_t)(fall * (double)unit_between(seed, -GRADIENT_MOST_Q3, GRADIENT_MOST_Q3));
                count++;
            }
        }
    }
    return count;
}

static void any_columns(told *t, uint64_t *seed)
{
    t->columns = (uint32_t)unit_between(seed, 1, 2) * T3R_LANES;
    t->column = t->columns == SIDE ? 0 : (uint32_t)unit_between(seed, 0, SIDE - T3R_LANES);
    t->first = (uint32_t)unit_between(seed, 0, SIDE - 1);
    t->last = (uint32_t)unit_between(seed, t->first, SIDE - 1);
}

/* Deviations between `least` and `most` px, about anywhere from which a pixel of the tile is told. */
static void many(uint64_t seed, double least, double most, double away, uint32_t most_q2)
{
    static told t;
    double share = 0;
    for (int i = 0; i < 10000;) {
        double size[2], place_at[2];
        for (int k = 0; k < 2; k++) {
            size[k] = least * pow(most / least, (double)unit_between(&seed, 0, 1000) / 1000);
            place_at[k] = 8 + away * (double)unit_between(&seed, -1000, 1000) / 1000;
        }
        any_columns(&t, &seed);
        place(&t, place_at[0], place_at[1], size[0], size[1], (double)unit_between(&seed, 0, 6283) / 1000,
              (double)unit_between(&seed, 0, 6283) / 1000);
        if (fill(&t, &seed, most_q2) != 0) {
            share = fmax(share, compare(&t));
            i++;
        }
    }
    print_message("off by at most %.2f of what is allowed\n", share);
    assert_true(share < 1);
}

static void small_splats(void **state)
{
    (void)state;
    many(1, 0.05, 4, 12, CURVATURE_MOST_Q2);
}

static void huge_splats_from_afar(void **state)
{
    (void)state;
    many(2, 10, 4000, 9000, CURVATURE_MOST_Q2);
}

/* Those whose other axis is thin as well as those centred far outside the tile. */
static void needles(void **state)
{
    (void)state;
    many(3, 0.3, 300, 100, CURVATURE_MOST_Q2);
}

static void faint_splats(void **state)
{
    (void)state;
    many(4, 0.3, 30, 20, 3);
    many(5, 0.3, 30, 20, 0); /* no gg at all */
}

/* Anything that the sums can hold and any axes: no overflow, and moments far below 2^63. */
static void the_largest_do_not_overflow(void **state)
{
    (void)state;
    uint64_t seed = 6;
    static told t;
    for (int round = 0; round < 20000; round++) {
        any_columns(&t, &seed);
        int32_t *axes[4] = {&t.axes.right_q20[0], &t.axes.right_q20[1], &t.axes.down_q20[0], &t.axes.down_q20[1]};
        for (int k = 0; k < 4; k++) {
            *axes[k] = unit_random(&seed) % 2 ? T3R_OWN_AXIS_MOST_Q20 : -T3R_OWN_AXIS_MOST_Q20;
        }
        uint32_t split = (uint32_t)unit_between(&seed, 0, 16), one_in = (uint32_t)unit_between(&seed, 1, 16);
        for (uint32_t j = 0; j < SIDE; j++) {
            for (uint32_t i = 0; i < SIDE; i++) {
                bool told_of = (i < split) != (j < split) || unit_random(&seed) % one_in == 0;
                t.curvature_q2[j][i] = told_of && round % 8 != 0 ? CURVATURE_MOST_Q2 : 0;
                t.gradient_q3[j][i] = told_of ? (unit_random(&seed) % one_in ? 1 : -1) * GRADIENT_MOST_Q3 : 0;
            }
        }
        t3r_tile_sums sums = sums_of(&t);
        t3r_own_moments own;
        int64_t far = (int64_t)1 << 27;
        t3r_own_moments_of(&sums, &t.axes, unit_between(&seed, -far, far), unit_between(&seed, -far, far), &own);
        for (int k = 0; k < T3R_REFINE_MOMENTS_4; k++) {
            assert_true(llabs(own.curvature[k]) < (int64_t)1 << 54);
            assert_true(k >= T3R_REFINE_MOMENTS_2 || llabs(own.gradient[k]) < (int64_t)1 << 46);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(small_splats), cmocka_unit_test(huge_splats_from_afar),       cmocka_unit_test(needles),
        cmocka_unit_test(faint_splats), cmocka_unit_test(the_largest_do_not_overflow),
    };
    return cmocka_run_group_tests_name("refine_moments", tests, NULL, NULL);
}
