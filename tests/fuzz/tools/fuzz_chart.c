/* SPDX-License-Identifier: Apache-2.0 */
/* Any bytes as a table of eval: an error with its line, or a consistent chart and report. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cjson/cJSON.h>

#include "study/chart/names.h"
#include "study/chart/page.h"
#include "study/chart/pictures.h"
#include "study/chart/points.h"
#include "study/chart/svg.h"
#include "study/chart/table.h"
#include "study/chart/view.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/* The page's data is one JSON value, which cannot hold NaN or infinity. */
static void check_data(const char *text)
{
    static const char begin[] = "id=\"data\">", end[] = "</script>";
    const char *from = strstr(text, begin), *to = from == NULL ? NULL : strstr(from, end);
    cJSON *data = to == NULL ? NULL : cJSON_ParseWithLength(from + strlen(begin), (size_t)(to - from) - strlen(begin));
    if (data == NULL) {
        abort();
    }
    cJSON_Delete(data);
}

static void draw(const chart_points *points, const chart_view *view)
{
    chart_names names;
    chart_pictures pictures;
    char error[256] = "", *text = NULL;
    size_t bytes = 0;
    FILE *out = open_memstream(&text, &bytes);
    if (out == NULL || chart_names_make(&names, points) != 0 ||
        chart_pictures_gather(&pictures, points, view, NULL, 0, 0, error, sizeof error) != 0 ||
        chart_page_write(out, points, &names, &pictures, view) != 0) {
        abort();
    }
    fclose(out);
    check_data(text);
    if (strstr(text, "<fuzz") != NULL) { /* a table's text that is valid markup */
        abort();
    }
    free(text);
    chart_pictures_free(&pictures);
    chart_names_free(&names);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    chart_table table = {0};
    chart_points points;
    char error[256] = "";
    if (chart_table_parse(&table, "t", (const char *)data, size, error, sizeof error) != 0) {
        if (strncmp(error, "t:", 2) != 0) {
            abort();
        }
    } else if (chart_points_make(&points, &table, error, sizeof error) == 0) {
        for (int q = 0; q < CHART_QUALITIES; q++) {
            chart_view view;
            if (chart_view_make(&view, &points, (chart_choice){(chart_measure)q, CHART_BUILD_MS, 0}) != 0) {
                abort();
            }
            for (uint32_t i = 0; i < view.front_count; i++) {
                if (!view.spots[view.front[i]].complete || !isfinite(view.spots[view.front[i]].cost.mean)) {
                    abort();
                }
            }
            if (view.shown > 0 && points.count < 50) {
                draw(&points, &view);
            }
            chart_view_free(&view);
        }
        chart_points_free(&points);
    }
    chart_table_free(&table);
    return 0;
}
