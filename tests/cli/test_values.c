/* SPDX-License-Identifier: Apache-2.0 */
/* Values on the command line: lists, percentages, sizes, budgets, hashes. */
#include "cli/cli.h"
#include "cli/tables/json_output.h"
#include "cli/text/index_ranges.h"
#include "reconstruction/reconstruction.h"
#include "test.h"

TEST(parses_lists)
{
    uint32_t values[3], count = 0;
    assert_int_equal(cli_parse_list_u32("0,2", values, 3, &count), 0);
    assert_int_equal(count, 2);
    assert_int_equal(values[1], 2);
    assert_int_equal(cli_parse_list_u32("4294967295", values, 3, &count), 0);
    assert_int_equal(values[0], UINT32_MAX);
    static const char *const bad[] = {"",    ",",  "1,", ",1", "1,,2",       "-1",
                                      "1.5", " 1", "1 ", "x",  "4294967296", "1,2,3,4"};
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        assert_int_equal(cli_parse_list_u32(bad[i], values, 3, &count), -1);
    }
}

TEST(parses_counts)
{
    static const struct {
        const char *text;
        uint32_t value;
    } good[] = {{"13107", 13107},  {"10k", 10000},
                {"1.5M", 1500000}, {"2.125k", 2125},
                {"0.000001M", 1},  {"4294.967295M", UINT32_MAX},
                {"007k", 7000},    {"4294967295", UINT32_MAX}};
    uint32_t values[3], count = 0;
    for (size_t i = 0; i < sizeof good / sizeof good[0]; i++) {
        assert_int_equal(cli_parse_list_counts(good[i].text, values, 3, &count), 0);
        assert_int_equal(values[0], good[i].value);
    }
    assert_int_equal(cli_parse_list_counts("1k,20,3M", values, 3, &count), 0);
    assert_true(count == 3 && values[0] == 1000 && values[1] == 20 && values[2] == 3000000);
    static const char *const bad[] = {"",     "k",  "1.k",   ".5k",  "1.5",   "1.2345k",      "1kk",
                                      "1K",   "1G", "-1k",   "1 k",  "1k,",   "4.294967296k", "4294967296k",
                                      "1e3k", "1m", "1..5k", "0x1k", "4295M", "99999999999M"};
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        assert_int_equal(cli_parse_list_counts(bad[i], values, 3, &count), -1);
    }
    assert_int_equal(cli_parse_list_u32("1k", values, 3, &count), -1);
}

TEST(parses_ranges)
{
    static const struct {
        const char *text;
        uint32_t count, values[4];
    } good[] = {
        {"7", 1, {7}},
        {"0-3", 4, {0, 1, 2, 3}},
        {"2:4", 3, {2, 3, 4}},
        {"0:7:3", 3, {0, 3, 6}},
        {"0:6:3", 3, {0, 3, 6}},
        {"5,1-2,0", 4, {5, 1, 2, 0}},
        {"3-3,4:4:9", 2, {3, 4}},
        {"4294967294-4294967295", 2, {UINT32_MAX - 1, UINT32_MAX}},
        {"1:4294967295:4294967295", 1, {1}},
    };
    static const char *const bad[] = {
        "",   ",",  "1,", ",1",  "-1",  "1-",    "1:",  "1-2-3",     "1-2:3",        "1:2:",       "1:2:3:4",
        " 1", "1 ", "x",  "2-1", "2:1", "0:3:0", "0-4", "0,1,2,3,4", "0:4294967295", "4294967296", "0-4294967296"};
    uint32_t values[4], count = 0;
    for (size_t i = 0; i < sizeof good / sizeof good[0]; i++) {
        assert_null(index_ranges_parse(good[i].text, values, 4, &count));
        assert_int_equal(count, good[i].count);
        assert_memory_equal(values, good[i].values, count * sizeof *values);
    }
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        assert_non_null(index_ranges_parse(bad[i], values, 4, &count));
    }
}

TEST(parses_percentages)
{
    double values[3];
    uint32_t count = 0;
    assert_int_equal(cli_parse_list_percent("100,12.5%,.5", values, 3, &count), 0);
    assert_int_equal(count, 3);
    assert_true(values[0] == 100 && values[1] == 12.5 && values[2] == 0.5);
    static const char *const bad[] = {"",     "0",    "101", "-5", "nan", "inf", "1e1",
                                      "0x10", "1..2", ".",   "%",  "5%%", "1,",  "1,2,3,4"};
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        assert_int_equal(cli_parse_list_percent(bad[i], values, 3, &count), -1);
    }
}

TEST(parses_sizes)
{
    uint32_t width = 0, height = 0;
    assert_int_equal(cli_parse_size("640x480", &width, &height), 0);
    assert_true(width == 640 && height == 480);
    static const char *const bad[] = {"",      "640",     "640x",      "x480", "0x480",
                                      "640x0", "640X480", "640x480x3", "-1x2", "640 x480"};
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        assert_int_equal(cli_parse_size(bad[i], &width, &height), -1);
    }
    assert_true(width == 640 && height == 480);
}

TEST(rounds_budgets_half_up)
{
    assert_int_equal(reconstruction_budget(131072, 10), 13107);
    assert_int_equal(reconstruction_budget(131072, 100), 131072);
    assert_int_equal(reconstruction_budget(5, 10), 1);  /* 0.5 */
    assert_int_equal(reconstruction_budget(25, 10), 3); /* 2.5 */
    assert_int_equal(reconstruction_budget(24, 10), 2); /* 2.4 */
    assert_int_equal(reconstruction_budget(1, 0.001), 1);
}

TEST(reads_and_writes_hashes)
{
    char text[HASH_TEXT_BYTES];
    uint64_t hash = 0;
    hash_text(UINT64_C(0x0123456789abcdef), text);
    assert_string_equal(text, "0123456789abcdef");
    assert_int_equal(hash_parse(text, &hash), 0);
    assert_true(hash == UINT64_C(0x0123456789abcdef));
    assert_int_equal(hash_parse("0x0123456789ABCDEF", &hash), 0);
    static const char *const bad[] = {"", "0123456789abcde", "0123456789abcdef0", "0123456789abcdeg", "golden.json"};
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        assert_int_equal(hash_parse(bad[i], &hash), -1);
    }
}

TEST(scales_cameras_with_the_picture)
{
    t3r_camera camera = {.fx_q16 = 200 << 16,
                         .fy_q16 = 100 << 16,
                         .cx_q16 = (255 << 16) / 2,
                         .cy_q16 = 0,
                         .distortion = T3R_DISTORTION_RADTAN,
                         .distortion_q24 = {1, 2, 3, 4, 5}};
    t3r_camera same = reconstruction_camera(&camera, 256, 256, 256, 256);
    assert_int_equal(same.fx_q16, camera.fx_q16);
    assert_int_equal(same.cx_q16, camera.cx_q16);
    assert_int_equal(same.distortion, T3R_DISTORTION_NONE);
    assert_int_equal(same.distortion_q24[4], 0);
    t3r_camera half = reconstruction_camera(&camera, 256, 256, 128, 64);
    assert_int_equal(half.fx_q16, 100 << 16);
    assert_int_equal(half.fy_q16, 25 << 16);
    assert_int_equal(half.cx_q16, (127 << 16) / 2); /* the middle stays the middle */
    assert_int_equal(half.cy_q16, 8192 - 32768);    /* half a pixel from the edge is an eighth now */
}
