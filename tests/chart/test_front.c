/* SPDX-License-Identifier: Apache-2.0 */
/* The Pareto front against its definition. */
#include <math.h>
#include <string.h>

#include "core/fixed.h"
#include "study/chart/front.h"
#include "test.h"

enum { MOST = 40 };

static bool beaten(const chart_place *by, const chart_place *it)
{
    return by->cost <= it->cost && by->quality >= it->quality && (by->cost < it->cost || by->quality > it->quality);
}

static bool takes_part(const chart_place *it)
{
    return !isnan(it->cost) && !isnan(it->quality);
}

TEST(test_agrees_with_the_definition)
{
    for (uint32_t trial = 0; trial < 2000; trial++) {
        chart_place all[MOST] = {{0}}, sorted[MOST];
        uint32_t count = t3r_mix32(trial) % MOST, expected = 0;
        for (uint32_t i = 0; i < count; i++) {
            uint32_t noise = t3r_mix32(trial * 100 + i); /* few values: ties are common */
            double cost = noise % 7, quality = (noise >> 8) % 7;
            all[i] = (chart_place){noise % 11 == 0 ? NAN : cost, noise % 13 == 0 ? NAN : quality, i};
        }
        memcpy(sorted, all, sizeof all);
        uint32_t found = chart_front(sorted, count);
        for (uint32_t i = 0; i < count; i++) {
            bool on = takes_part(&all[i]), is = false;
            for (uint32_t k = 0; k < count && on; k++) {
                on = !(takes_part(&all[k]) && beaten(&all[k], &all[i]));
            }
            for (uint32_t k = 0; k < found; k++) {
                is = is || sorted[k].index == i;
            }
            assert_int_equal(is, on);
            expected += on;
        }
        assert_int_equal(found, expected);
        for (uint32_t k = 1; k < found; k++) {
            assert_true(sorted[k - 1].cost <= sorted[k].cost && sorted[k - 1].quality <= sorted[k].quality);
        }
    }
}

TEST(test_small_fronts)
{
    chart_place none[1], one[] = {{3, 4, 7}}, out[] = {{NAN, 4, 0}, {3, NAN, 1}};
    assert_int_equal(chart_front(none, 0), 0);
    assert_int_equal(chart_front(one, 1), 1);
    assert_int_equal(one[0].index, 7);
    assert_int_equal(chart_front(out, 2), 0);
    chart_place endless[] = {{INFINITY, 9, 0}, {1, 8, 1}};
    assert_int_equal(chart_front(endless, 2), 2);
    assert_int_equal(endless[0].index, 1);
}
