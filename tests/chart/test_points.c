/* SPDX-License-Identifier: Apache-2.0 */
/* Tables to points: grouping, means over scenes, quartiles, membership of the front, names. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "study/chart/names.h"
#include "study/chart/points.h"
#include "study/chart/table.h"
#include "study/chart/view.h"
#include "test.h"

#define HEADING "scene,context,target,method,head,bits,refine,keep,psnr,build_ms\n"

#define TEXT_OF_40 "0123456789012345678901234567890123456789"

static void read_text(chart_table *table, const char *text)
{
    char error[256] = "";
    if (chart_table_parse(table, "t.csv", text, strlen(text), error, sizeof error) != 0) {
        fail_msg("%s", error);
    }
}

static void make(chart_points *points, const chart_table *table)
{
    char error[256] = "";
    assert_int_equal(chart_points_make(points, table, error, sizeof error), 0);
}

static const char *text_of(const chart_points *points, uint32_t point, chart_setting setting)
{
    return points->table->texts.text[points->points[point].setting[setting]];
}

TEST(test_each_scene_counts_once)
{
    chart_table table = {0};
    chart_points points;
    read_text(&table, HEADING "a,\"0,2\",1,trim3r,small,8,4,10,20,100\n"
                              "a,\"2,4\",3,trim3r,small,8,4,10.0,24,300\n"
                              "b,\"0,2\",1,trim3r,small,8,4,10,30,500\n"
                              "b,\"0,2\",1,trim3r,small,8,4,5,28,nan\n"
                              "b,\"0,2\",1,random,small,8,4,10,9,\n");
    make(&points, &table);
    assert_int_equal(points.count, 3);
    assert_int_equal(points.series_count, 2);
    assert_string_equal(text_of(&points, 0, CHART_KEEP), "10");
    assert_string_equal(text_of(&points, 1, CHART_KEEP), "5"); /* from the largest budget to the smallest */
    assert_string_equal(text_of(&points, 2, CHART_METHOD), "random");
    chart_spread psnr = chart_points_spread(&points, 0, CHART_PSNR, CHART_ALL_SCENES);
    assert_true(psnr.mean == 26 && psnr.cases == 3); /* (22 + 30) / 2 */
    assert_true(psnr.low == 22 && psnr.median == 24 && psnr.high == 27);
    assert_true(chart_points_spread(&points, 0, CHART_PSNR, 0).mean == 22);
    assert_true(chart_points_spread(&points, 0, CHART_PSNR, 1).mean == 30);
    chart_spread none = chart_points_spread(&points, 1, CHART_BUILD_MS, CHART_ALL_SCENES);
    assert_true(none.cases == 0 && isnan(none.mean) && isnan(none.median));
    assert_int_equal(chart_points_spread(&points, 2, CHART_PSNR, 0).cases, 0);
    assert_true(chart_points_have(&points, CHART_BUILD_MS) && !chart_points_have(&points, CHART_SSIM));
    chart_points_free(&points);
    chart_table_free(&table);
}

TEST(test_a_measurement_made_again_is_one)
{
    chart_table table = {0};
    chart_points points;
    read_text(&table, HEADING "a,0,1,trim3r,,,,10,20,100\na,0,1,trim3r,,,,10,,400\na,0,2,trim3r,,,,10,40,100\n");
    read_text(&table, HEADING "a,0,1,trim3r,,,,10,20,100\n"); /* another table's rows join */
    make(&points, &table);
    assert_int_equal(points.count, 1);
    assert_int_equal(points.cell_count, 2);
    assert_true(points.cells[0].value[CHART_BUILD_MS] == 200 && points.cells[0].value[CHART_PSNR] == 20);
    chart_spread time = chart_points_spread(&points, 0, CHART_BUILD_MS, CHART_ALL_SCENES);
    assert_true(time.mean == 150 && time.cases == 2);
    chart_points_free(&points);
    chart_table_free(&table);
}

TEST(test_quartiles)
{
    const double five[] = {1, 2, 4, 8, 16}, two[] = {1, 3};
    assert_true(chart_quantile(five, 5, 0) == 1 && chart_quantile(five, 5, 0.25) == 2);
    assert_true(chart_quantile(five, 5, 0.5) == 4 && chart_quantile(five, 5, 1) == 16);
    assert_true(chart_quantile(two, 2, 0.25) == 1.5 && chart_quantile(two, 1, 0.75) == 1);
}

TEST(test_front_is_among_the_complete)
{
    chart_table table = {0};
    chart_points points;
    chart_view view;
    read_text(&table, HEADING "a,0,1,trim3r,,,,10,20,100\nb,0,1,trim3r,,,,10,22,100\n"
                              "a,0,1,trim3r,,,,20,19,200\nb,0,1,trim3r,,,,20,19,200\n" /* dearer and worse */
                              "b,0,1,random,,,,10,50,1\n");                            /* an easy scene alone */
    make(&points, &table);
    assert_int_equal(chart_view_make(&view, &points, (chart_choice){CHART_PSNR, CHART_BUILD_MS, CHART_ALL_SCENES}), 0);
    assert_int_equal(view.shown, 3);
    assert_int_equal(view.cases, 2);
    assert_int_equal(view.front_count, 1);
    assert_string_equal(text_of(&points, view.front[0], CHART_KEEP), "10");
    assert_string_equal(text_of(&points, view.front[0], CHART_METHOD), "trim3r");
    chart_view_free(&view);
    assert_int_equal(chart_view_make(&view, &points, (chart_choice){CHART_PSNR, CHART_BUILD_MS, 1}), 0);
    assert_int_equal(view.front_count, 1); /* within that scene it is complete */
    assert_string_equal(text_of(&points, view.front[0], CHART_METHOD), "random");
    chart_view_free(&view);
    assert_int_equal(chart_view_make(&view, &points, (chart_choice){CHART_SSIM, CHART_BUILD_MS, 1}), 0);
    assert_int_equal(view.shown + view.front_count, 0);
    chart_view_free(&view);
    chart_points_free(&points);
    chart_table_free(&table);
}

TEST(test_less_difference_is_better)
{
    chart_table table = {0};
    chart_points points;
    chart_view view;
    read_text(&table, "method,perceptual,scene_bytes\na,0.1,50\nb,0.2,50\n");
    make(&points, &table);
    assert_int_equal(chart_view_make(&view, &points, (chart_choice){CHART_PERCEPTUAL, CHART_SCENE_BYTES, 0}), 0);
    assert_int_equal(view.front_count, 1);
    assert_string_equal(text_of(&points, view.front[0], CHART_METHOD), "a");
    chart_view_free(&view);
    chart_points_free(&points);
    chart_table_free(&table);
}

TEST(test_names_tell_what_differs)
{
    chart_table table = {0};
    chart_points points;
    chart_names names;
    read_text(&table, HEADING "a,0,1,trim3r,small,8,4,10,20,1\na,0,1,trim3r,small,8,4,5,20,1\n"
                              "a,0,1,trim3r,small,8,0,10,20,1\na,0,1,trim3r,analytic,,4,10,20,1\n"
                              "a,0,1,pup,small,8,4,10,20,1\na,0,1,pup+finetune,small,8,4,10,20,1\n");
    read_text(&table, "method,keep,psnr,build_ms\ntrim3r,10,20,1\n");
    make(&points, &table);
    assert_int_equal(chart_names_make(&names, &points), 0);
    static const char *const expected[] = {
        "trim3r",
        "trim3r \xC2\xB7 refine 0",
        "trim3r \xC2\xB7 analytic",
        "pup",
        "pup+finetune",
        "trim3r \xC2\xB7 head not given \xC2\xB7 bits not given \xC2\xB7 refine not given"};
    assert_int_equal(points.series_count, 6);
    for (uint32_t s = 0; s < 6; s++) {
        assert_string_equal(names.series[s].text, expected[s]);
    }
    assert_string_equal(names.common, "small, 8 bits, refine 4");
    assert_int_equal(names.series[0].colour,
                     names.series[1].colour); /* program: the colour; configuration: the shape */
    assert_int_not_equal(names.series[0].shape, names.series[1].shape);
    assert_int_not_equal(names.series[0].colour, names.series[2].colour);
    assert_int_equal(names.series[0].shape, names.series[3].shape);
    assert_int_equal(names.series[3].colour, names.series[4].colour);
    assert_int_not_equal(names.series[3].shape, names.series[4].shape);
    chart_names_free(&names);
    chart_points_free(&points);
    chart_table_free(&table);
}

TEST(test_refusals)
{
    static const struct {
        const char *text, *why;
    } of[] = {
        {"", "t.csv:1: the table is empty"},
        {"\n\n", "t.csv:1: the table is empty"},
        {HEADING, "t.csv:1: a heading without rows"},
        {"method,build_ms\na,1\n",
         "t.csv:1: the heading names no quality: one of psnr, ssim, perceptual, planar_psnr, psnr_all, ssim_all, "
         "perceptual_all"},
        {"psnr,keep\n1,2\n",
         "t.csv:1: the heading names no cost: one of build_ms, render_ms, arena_bytes, scene_bytes"},
        {"psnr,build_ms,psnr\n1,2,3\n", "t.csv:1: psnr is in the heading twice"},
        {"psnr,build_ms\n1,2\n\n1\n", "t.csv:4: 1 cells, where the heading has 2"},
        {"psnr,build_ms\n1,2,3\n", "t.csv:2: 3 cells, where the heading has 2"},
        {"psnr,build_ms\n1,inf\n", "t.csv:2: build_ms: 'inf' is not a finite number"},
        {"psnr,build_ms\nbest,1\n", "t.csv:2: psnr: 'best' is not a finite number"},
        {"psnr,build_ms\n1,1e300\n", "t.csv:2: build_ms: '1e300' is not a finite number"},
        {"psnr,build_ms\n1,-1\n", "t.csv:2: build_ms is below 0"},
        {"psnr,build_ms,picture\n1,1,/etc/x.png\n", "t.csv:2: picture: a path that leaves its folder"},
        {"psnr,build_ms,picture\n1,1,a/../../x.png\n", "t.csv:2: picture: a path that leaves its folder"},
        {"psnr,build_ms,picture,scene\n1,1,x.png,..\n", "t.csv:2: picture: a path that leaves its folder"},
        {"psnr,build_ms,method\n1,1," TEXT_OF_40 TEXT_OF_40 TEXT_OF_40 TEXT_OF_40 "0\n",
         "t.csv:2: method: more than 160 bytes"},
    };
    for (size_t i = 0; i < sizeof of / sizeof of[0]; i++) {
        chart_table table = {0};
        char error[256] = "";
        assert_int_equal(chart_table_parse(&table, "t.csv", of[i].text, strlen(of[i].text), error, sizeof error), -1);
        assert_string_equal(error, of[i].why);
        chart_table_free(&table);
    }
    chart_table fine = {0};
    read_text(&fine, "psnr,build_ms,picture,other\n1,1,a/..b/x..png,\"any\"\"thing\"\n");
    chart_table_free(&fine);
}

TEST(test_no_more_points_than_a_chart_takes)
{
    char *text = NULL, error[256] = "";
    size_t bytes = 0;
    FILE *out = open_memstream(&text, &bytes);
    assert_non_null(out);
    fputs("method,psnr,build_ms\n", out);
    for (uint32_t i = 0; i <= CHART_POINTS_MOST; i++) {
        fprintf(out, "m%u,1,1\n", (unsigned)i);
    }
    fclose(out);
    chart_table table = {0};
    chart_points points;
    read_text(&table, text);
    assert_int_equal(chart_points_make(&points, &table, error, sizeof error), -1);
    assert_string_equal(error, "the tables have 2001 points, a chart takes at most 2000");
    chart_table_free(&table);
    free(text);
}
