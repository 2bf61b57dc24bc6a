/* SPDX-License-Identifier: Apache-2.0 */
/* Ticks of every kind of axis: few, round, ascending, within the range, each with a name of its own. */
#include <math.h>
#include <string.h>

#include "study/chart/axis.h"
#include "test.h"

/* With named == false names may repeat: 15 digits do not distinguish the ticks. */
static void check(chart_measure measure, double least, double most, bool named)
{
    chart_axis axis = chart_axis_make(measure, least, most);
    assert_true(isfinite(axis.low) && isfinite(axis.high) && axis.low < axis.high);
    assert_true(axis.low <= least && most <= axis.high);
    assert_true(axis.tick_count >= 2 && axis.tick_count <= CHART_TICKS_MOST);
    for (uint32_t i = 0; i < axis.tick_count; i++) {
        double place = chart_axis_place(&axis, axis.tick[i].value);
        assert_true(place >= -1e-6 && place <= 1 + 1e-6);
        assert_int_not_equal(axis.tick[i].label[0], '\0');
        if (i > 0) {
            assert_true(axis.tick[i].value > axis.tick[i - 1].value);
            assert_true(!named || strcmp(axis.tick[i].label, axis.tick[i - 1].label) != 0);
        }
    }
    double low = chart_axis_place(&axis, axis.low), high = chart_axis_place(&axis, axis.high);
    assert_true(fabs(low) < 1e-9 && fabs(high - 1) < 1e-9);
}

TEST(test_every_range)
{
    static const double values[] = {0,  1e-15, 1e-9, 0.003, 0.02, 0.5, 0.51, 1,   1.0001, 4.9, 5.1, 31.2,   31.25,
                                    99, 100,   1023, 1024,  1025, 5e3, 65e3, 1e6, 3.9e6,  4e7, 1e9, 1.1e12, 1e15};
    for (int m = 0; m < CHART_COSTS_END; m++) {
        for (size_t a = 0; a < sizeof values / sizeof values[0]; a++) {
            for (size_t b = a; b < sizeof values / sizeof values[0]; b++) {
                check((chart_measure)m, values[a], values[b], values[a] >= 1e-3 && values[b] - values[a] >= 1e-3);
            }
        }
    }
    check(CHART_PSNR, -5, 40, true);
    check(CHART_SSIM, -1e15, 1e15, true);
}

static void expect(chart_measure measure, double least, double most, const char *labels)
{
    chart_axis axis = chart_axis_make(measure, least, most);
    char text[CHART_TICKS_MOST * (CHART_LABEL_BYTES + 1) + 1] = "";
    for (uint32_t i = 0; i < axis.tick_count; i++) {
        strcat(text, i > 0 ? "|" : "");
        strcat(text, axis.tick[i].label);
    }
    assert_string_equal(text, labels);
}

TEST(test_names)
{
    expect(CHART_PSNR, 12, 31, "15 dB|20 dB|25 dB|30 dB");
    expect(CHART_PSNR, 30.1, 30.9, "30.2 dB|30.4 dB|30.6 dB|30.8 dB");
    expect(CHART_SSIM, 0.71, 0.95, "0.7|0.75|0.8|0.85|0.9|0.95");
    expect(CHART_BUILD_MS, 3, 42000, "10 ms|100 ms|1 s|10 s");
    expect(CHART_BUILD_MS, 120, 9000, "100 ms|200 ms|500 ms|1 s|2 s|5 s|10 s");
    expect(CHART_RENDER_MS, 8, 16, "8 ms|10 ms|12 ms|14 ms|16 ms");
    expect(CHART_ARENA_BYTES, 100000, 9000000, "128 KiB|256 KiB|512 KiB|1 MiB|2 MiB|4 MiB|8 MiB");
    expect(CHART_SCENE_BYTES, 1048576, 3 * 1048576, "1 MiB|1.5 MiB|2 MiB|2.5 MiB|3 MiB");
}

TEST(test_kinds)
{
    assert_true(chart_axis_make(CHART_BUILD_MS, 1, 10).logarithmic);
    assert_false(chart_axis_make(CHART_BUILD_MS, 1, 4).logarithmic);
    assert_false(chart_axis_make(CHART_BUILD_MS, 0, 1000).logarithmic);
    assert_false(chart_axis_make(CHART_PSNR, 1, 100).logarithmic);
    assert_true(chart_axis_make(CHART_PERCEPTUAL, 0.1, 0.2).falling);
    assert_false(chart_axis_make(CHART_SSIM, 0.1, 0.2).falling);
    assert_false(chart_axis_make(CHART_BUILD_MS, 1, 2).falling);
    assert_true(chart_axis_make(CHART_BUILD_MS, 0, 1000).low >= 0); /* no times below 0 */
    chart_axis axis = chart_axis_make(CHART_BUILD_MS, 10, 1000);
    assert_true(fabs(chart_axis_place(&axis, 100) - 0.5) < 1e-9);
}

TEST(test_values)
{
    static const struct {
        chart_measure measure;
        double value;
        const char *text;
    } of[] = {
        {CHART_PSNR, 31.204, "31.20 dB"},  {CHART_SSIM, 0.9116, "0.912"},   {CHART_BUILD_MS, 85.04, "85 ms"},
        {CHART_BUILD_MS, 1234, "1.23 s"},  {CHART_SCENE_BYTES, 44, "44 B"}, {CHART_ARENA_BYTES, 3941440, "3.76 MiB"},
        {CHART_GAUSSIANS, 13107, "13107"}, {CHART_PSNR, NAN, "-"},          {CHART_ARENA_BYTES, 1e15, "909.49 TiB"},
        {CHART_RENDER_MS, 0, "0 ms"},
    };
    for (size_t i = 0; i < sizeof of / sizeof of[0]; i++) {
        char text[CHART_LABEL_BYTES];
        chart_value_text(of[i].measure, of[i].value, text, sizeof text);
        assert_string_equal(text, of[i].text);
    }
}
