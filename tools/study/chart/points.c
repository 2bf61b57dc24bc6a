/* SPDX-License-Identifier: Apache-2.0 */
#include "study/chart/points.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/tables/csv_read.h"
#include "host/reason.h"

#define KEY_BYTES (CHART_SETTINGS * 11u + 1)
_Static_assert(CHART_KEEP == CHART_SETTINGS - 1, "a series is all settings but the last");

typedef struct chart_measured {
    double value;
    uint32_t scene;
} measured;

double chart_quantile(const double *ascending, uint32_t count, double q)
{
    double at = q * (count - 1);
    uint32_t below = (uint32_t)at, above = below + 1 < count ? below + 1 : below;
    return ascending[below] + (at - below) * (ascending[above] - ascending[below]);
}

/* Numbers of a row, its point and its series. */
typedef struct key {
    uint32_t point, series, row;
} key;

/* Joins the first `count` settings into one text. */
static void join(const chart_row *row, int count, char text[KEY_BYTES])
{
    size_t length = 0;
    text[0] = '\0';
    for (int s = 0; s < count; s++) {
        length += (size_t)snprintf(text + length, KEY_BYTES - length, "%u,", (unsigned)row->setting[s]);
    }
}

static int number_rows(const chart_table *table, key *keys, chart_texts *point_keys, chart_texts *series_keys)
{
    for (uint32_t i = 0; i < table->row_count; i++) {
        char text[KEY_BYTES];
        keys[i].row = i;
        join(&table->rows[i], CHART_SETTINGS, text);
        int failed = chart_texts_number(point_keys, text, &keys[i].point);
        join(&table->rows[i], CHART_KEEP, text); /* the last setting */
        if (failed != 0 || chart_texts_number(series_keys, text, &keys[i].series) != 0) {
            return -1;
        }
    }
    return 0;
}

/* Context of the comparison. */
typedef struct sorted_key {
    key is;
    double budget; /* -1: not a number */
    uint32_t scene_case;
} sorted_key;

static int compare(uint64_t a, uint64_t b)
{
    return (a > b) - (a < b);
}

/* Orders by series, falling budget, point, case, row. */
static int by_place(const void *left, const void *right)
{
    const sorted_key *a = left, *b = right;
    int order = compare(a->is.series, b->is.series);
    if (order == 0) {
        order = (a->budget < b->budget) - (a->budget > b->budget);
    }
    if (order == 0) {
        order = compare(a->is.point, b->is.point);
    }
    if (order == 0) {
        order = compare(a->scene_case, b->scene_case);
    }
    return order != 0 ? order : compare(a->is.row, b->is.row);
}

/* Returns the number that the text begins with: a percentage, or a count of Gaussians. */
static double budget_of(const chart_table *table, const chart_row *row)
{
    const char *text = table->texts.text[row->setting[CHART_KEEP]];
    char number[32];
    double budget;
    bool given;
    snprintf(number, sizeof number, "%.*s", (int)strcspn(text, " "), text);
    return csv_number(number, &budget, &given) == 0 && given ? budget : -1;
}

/* Merges the rows [from, to) of one point and case into one cell. */
static chart_cell merge(const chart_table *table, const sorted_key *keys, uint32_t from, uint32_t to, uint32_t point)
{
    chart_cell cell = {.point = point, .scene_case = keys[from].scene_case};
    const chart_row *first = &table->rows[keys[from].is.row];
    cell.picture = first->picture;
    cell.file = first->file;
    for (int m = 0; m < CHART_MEASURES; m++) {
        double sum = 0;
        uint32_t given = 0;
        for (uint32_t i = from; i < to; i++) {
            double value = table->rows[keys[i].is.row].value[m];
            given += isnan(value) ? 0 : 1;
            sum += isnan(value) ? 0 : value;
        }
        cell.value[m] = given == 0 ? NAN : sum / given;
    }
    for (uint32_t i = from + 1; i < to && table->texts.text[cell.picture][0] == '\0'; i++) {
        cell.picture = table->rows[keys[i].is.row].picture;
        cell.file = table->rows[keys[i].is.row].file;
    }
    return cell;
}

static void fill(chart_points *points, const sorted_key *keys)
{
    const chart_table *table = points->table;
    for (uint32_t from = 0, to; from < table->row_count; from = to) {
        for (to = from + 1; to < table->row_count && keys[to].is.point == keys[from].is.point &&
                            keys[to].scene_case == keys[from].scene_case;
             to++) {
        }
        if (from == 0 || keys[from].is.series != keys[from - 1].is.series) {
            points->series[points->series_count++].first_point = points->count;
        }
        if (from == 0 || keys[from].is.point != keys[from - 1].is.point) {
            chart_point *point = &points->points[points->count++];
            memcpy(point->setting, table->rows[keys[from].is.row].setting, sizeof point->setting);
            point->series = points->series_count - 1;
            point->first_cell = points->cell_count;
            points->series[point->series].point_count++;
        }
        chart_point *point = &points->points[points->count - 1];
        point->cell_count++;
        points->cells[points->cell_count++] = merge(table, keys, from, to, points->count - 1);
    }
}

static int make(chart_points *points, key *keys, sorted_key *sorted, chart_texts *point_keys, chart_texts *series_keys,
                char *error, size_t error_bytes)
{
    const chart_table *table = points->table;
    if (keys == NULL || sorted == NULL || number_rows(table, keys, point_keys, series_keys) != 0) {
        return t3r_reason(error, error_bytes, "out of memory");
    }
    if (point_keys->count > CHART_POINTS_MOST) {
        return t3r_reason(error, error_bytes, "the tables have %u points, a chart takes at most %u",
                          (unsigned)point_keys->count, CHART_POINTS_MOST);
    }
    for (uint32_t i = 0; i < table->row_count; i++) {
        const chart_row *row = &table->rows[i];
        sorted[i] = (sorted_key){.is = keys[i], .budget = budget_of(table, row), .scene_case = row->scene_case};
    }
    qsort(sorted, table->row_count, sizeof *sorted, by_place);
    points->points = calloc(point_keys->count, sizeof *points->points);
    points->series = calloc(series_keys->count, sizeof *points->series);
    points->cells = calloc(table->row_count, sizeof *points->cells);
    if (points->points == NULL || points->series == NULL || points->cells == NULL) {
        return t3r_reason(error, error_bytes, "out of memory");
    }
    fill(points, sorted);
    uint32_t most = 1;
    for (uint32_t p = 0; p < points->count; p++) {
        most = points->points[p].cell_count > most ? points->points[p].cell_count : most;
    }
    points->measured = calloc(most, sizeof *points->measured);
    points->ascending = calloc(most, sizeof *points->ascending);
    return points->measured != NULL && points->ascending != NULL ? 0 : t3r_reason(error, error_bytes, "out of memory");
}

int chart_points_make(chart_points *points, const chart_table *table, char *error, size_t error_bytes)
{
    chart_texts point_keys = {0}, series_keys = {0};
    *points = (chart_points){.table = table};
    if (table->row_count == 0) {
        return t3r_reason(error, error_bytes, "no rows");
    }
    key *keys = calloc(table->row_count, sizeof *keys);
    sorted_key *sorted = calloc(table->row_count, sizeof *sorted);
    int failed = make(points, keys, sorted, &point_keys, &series_keys, error, error_bytes);
    free(sorted);
    free(keys);
    chart_texts_free(&point_keys);
    chart_texts_free(&series_keys);
    if (failed != 0) {
        chart_points_free(points);
    }
    return failed;
}

void chart_points_free(chart_points *points)
{
    free(points->points);
    free(points->series);
    free(points->cells);
    free(points->measured);
    free(points->ascending);
    *points = (chart_points){0};
}

static int by_scene(const void *left, const void *right)
{
    return compare(((const measured *)left)->scene, ((const measured *)right)->scene);
}

static int by_value(const void *left, const void *right)
{
    double a = *(const double *)left, b = *(const double *)right;
    return (a > b) - (a < b);
}

/* Returns the mean over scenes of each scene's mean. Sorts the values. */
static double mean_of_scenes(measured *values, uint32_t count)
{
    double sum = 0;
    uint32_t scenes = 0;
    qsort(values, count, sizeof *values, by_scene);
    for (uint32_t from = 0, to; from < count; from = to) {
        double of_scene = 0;
        for (to = from; to < count && values[to].scene == values[from].scene; to++) {
            of_scene += values[to].value;
        }
        sum += of_scene / (to - from);
        scenes++;
    }
    return sum / scenes;
}

chart_spread chart_points_spread(const chart_points *points, uint32_t point, chart_measure measure, uint32_t scene)
{
    const chart_point *p = &points->points[point];
    chart_spread spread = {.mean = NAN, .low = NAN, .median = NAN, .high = NAN};
    measured *values = points->measured;
    double *ascending = points->ascending;
    for (uint32_t i = 0; i < p->cell_count; i++) {
        const chart_cell *cell = &points->cells[p->first_cell + i];
        uint32_t of = points->table->cases[cell->scene_case].scene;
        if (!isnan(cell->value[measure]) && (scene == CHART_ALL_SCENES || scene == of)) {
            ascending[spread.cases] = cell->value[measure];
            values[spread.cases++] = (measured){cell->value[measure], of};
        }
    }
    if (spread.cases > 0) {
        spread.mean = mean_of_scenes(values, spread.cases);
        qsort(ascending, spread.cases, sizeof *ascending, by_value);
        spread.low = chart_quantile(ascending, spread.cases, 0.25);
        spread.median = chart_quantile(ascending, spread.cases, 0.5);
        spread.high = chart_quantile(ascending, spread.cases, 0.75);
    }
    return spread;
}
