/* SPDX-License-Identifier: Apache-2.0 */
#include "study/chart/page.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

#include <cjson/cJSON.h>

#include "cli/text/markup.h"
#include "study/chart/svg.h"

/* Embedded by the build: page.html with the marks <!--style-->, <!--svg-->, <!--data--> and <!--script-->. */
extern const char chart_page_html[], chart_page_css[], chart_page_js[];

/* ---- the data -------------------------------------------------------------------------------------------------- */

/* Writes JSON within a script element, which no '<' may end, and deletes it. An object may stay open for more members.
 * Returns 0, or -1 when memory is out. */
static int write_json(FILE *out, cJSON *json, bool open)
{
    char *text = cJSON_PrintUnformatted(json);
    cJSON_Delete(json);
    for (const char *c = text; c != NULL && c[open] != '\0'; c++) {
        fprintf(out, *c == '<' ? "\\u003c" : "%c", *c);
    }
    cJSON_free(text);
    return text != NULL ? 0 : -1;
}

static cJSON *number(double value)
{
    char text[32];
    snprintf(text, sizeof text, "%.10g", value);
    return isnan(value) ? cJSON_CreateNull() : cJSON_CreateRaw(text);
}

static cJSON *picture(uint32_t number)
{
    return number == CHART_NO_PICTURE ? cJSON_CreateNull() : cJSON_CreateNumber(number);
}

static void add_measures(cJSON *root)
{
    static const char *const units[] = {"", "dB", "ms", "bytes"};
    cJSON *measures = cJSON_AddArrayToObject(root, "measures");
    for (int m = 0; m < CHART_MEASURES; m++) {
        const chart_measure_about *about = &chart_measures[m];
        cJSON *item = cJSON_CreateObject();
        cJSON_AddStringToObject(item, "title", about->title);
        cJSON_AddStringToObject(item, "unit", units[about->unit]);
        cJSON_AddNumberToObject(item, "decimals", about->decimals);
        cJSON_AddBoolToObject(item, "less", about->less_is_better);
        cJSON_AddBoolToObject(item, "quality", m < CHART_QUALITIES);
        cJSON_AddBoolToObject(item, "cost", m >= CHART_QUALITIES && m < CHART_COSTS_END);
        cJSON_AddItemToArray(measures, item);
    }
    cJSON_AddNumberToObject(root, "gaussians", CHART_GAUSSIANS);
    cJSON_AddItemToObject(root, "shapes", cJSON_CreateStringArray(chart_shapes, CHART_SHAPES));
}

static void add_series(cJSON *root, const chart_points *points, const chart_names *names)
{
    cJSON *list = cJSON_AddArrayToObject(root, "series");
    for (uint32_t s = 0; s < points->series_count; s++) {
        const chart_series *series = &points->series[s];
        cJSON *item = cJSON_CreateObject(), *of = cJSON_AddArrayToObject(item, "points");
        cJSON_AddStringToObject(item, "name", names->series[s].text);
        cJSON_AddNumberToObject(item, "colour", names->series[s].colour);
        cJSON_AddNumberToObject(item, "shape", names->series[s].shape);
        for (uint32_t i = 0; i < series->point_count; i++) {
            cJSON_AddItemToArray(of, cJSON_CreateNumber(series->first_point + i));
        }
        cJSON_AddItemToArray(list, item);
    }
}

static void add_cases(cJSON *root, const chart_table *table)
{
    cJSON *scenes = cJSON_CreateStringArray((const char *const *)table->scenes.text, (int)table->scenes.count);
    cJSON_AddItemToObject(root, "scenes", scenes);
    cJSON *cases = cJSON_AddArrayToObject(root, "cases");
    for (uint32_t c = 0; c < table->case_keys.count; c++) {
        const chart_case *it = &table->cases[c];
        char name[512] = "";
        if (table->texts.text[it->target][0] != '\0') {
            snprintf(name, sizeof name, "frame %.100s from %.300s", table->texts.text[it->target],
                     table->texts.text[it->context]);
        }
        cJSON *item = cJSON_CreateObject();
        cJSON_AddNumberToObject(item, "scene", it->scene);
        cJSON_AddStringToObject(item, "name", name);
        cJSON_AddItemToArray(cases, item);
    }
}

static void add_texts(cJSON *root, const chart_points *points, const chart_names *names, const chart_pictures *pictures,
                      const chart_view *first)
{
    const chart_table *table = points->table;
    char about[2 * CHART_NAME_BYTES], left_out[256] = "";
    snprintf(about, sizeof about, "%u point%s, %u case%s of %u scene%s%s%s.", (unsigned)points->count,
             points->count == 1 ? "" : "s", (unsigned)table->case_keys.count, table->case_keys.count == 1 ? "" : "s",
             (unsigned)table->scenes.count, table->scenes.count == 1 ? "" : "s",
             names->common[0] != '\0' ? "; unless named, " : "", names->common);
    if (pictures->left_out + pictures->missing > 0) {
        snprintf(left_out, sizeof left_out,
                 "Of the pictures, %u are left out because the report would be too large, and %u were not found.",
                 (unsigned)pictures->left_out, (unsigned)pictures->missing);
    }
    cJSON *start = cJSON_AddObjectToObject(root, "start");
    const bool all = first->choice.scene == CHART_ALL_SCENES;
    cJSON_AddItemToObject(start, "scene", all ? cJSON_CreateNull() : cJSON_CreateNumber(first->choice.scene));
    cJSON_AddNumberToObject(start, "quality", first->choice.quality);
    cJSON_AddNumberToObject(start, "cost", first->choice.cost);
    cJSON_AddStringToObject(root, "about", about);
    cJSON_AddStringToObject(root, "leftOut", left_out);
}

/* A cell: its case, its pictures (render, target, mask), and a value a measure. */
static cJSON *cell_json(const chart_cell *cell, const chart_shots *shots)
{
    cJSON *json = cJSON_CreateArray();
    cJSON_AddItemToArray(json, cJSON_CreateNumber(cell->scene_case));
    cJSON_AddItemToArray(json, picture(shots->render));
    cJSON_AddItemToArray(json, picture(shots->target));
    cJSON_AddItemToArray(json, picture(shots->mask));
    for (int m = 0; m < CHART_MEASURES; m++) {
        cJSON_AddItemToArray(json, number(cell->value[m]));
    }
    return json;
}

static cJSON *point_json(const chart_points *points, const chart_pictures *pictures, uint32_t index)
{
    const chart_point *point = &points->points[index];
    char text[CHART_NAME_BYTES];
    cJSON *json = cJSON_CreateObject();
    cJSON_AddNumberToObject(json, "series", point->series);
    chart_setting_text(points, index, CHART_KEEP, text, sizeof text);
    cJSON_AddStringToObject(json, "keep", text);
    cJSON *settings = cJSON_AddArrayToObject(json, "settings");
    for (int s = 0; s < CHART_KEEP; s++) {
        chart_setting_text(points, index, (chart_setting)s, text, sizeof text);
        if (text[0] != '\0') {
            cJSON_AddItemToArray(settings, cJSON_CreateString(text));
        }
    }
    cJSON *cells = cJSON_AddArrayToObject(json, "cells");
    for (uint32_t c = point->first_cell; c < point->first_cell + point->cell_count; c++) {
        cJSON_AddItemToArray(cells, cell_json(&points->cells[c], &pictures->of_cell[c]));
    }
    return json;
}

/* Points are written one by one: together they may be large. */
static int write_data(FILE *out, const chart_points *points, const chart_names *names, const chart_pictures *pictures,
                      const chart_view *first)
{
    cJSON *root = cJSON_CreateObject();
    add_texts(root, points, names, pictures, first);
    add_measures(root);
    add_series(root, points, names);
    add_cases(root, points->table);
    fputs("<script type=\"application/json\" id=\"data\">\n", out);
    int failed = write_json(out, root, true);
    fputs(",\n\"points\":[", out);
    for (uint32_t i = 0; i < points->count && failed == 0; i++) {
        fputs(i == 0 ? "\n" : ",\n", out);
        failed = write_json(out, point_json(points, pictures, i), false);
    }
    fputs("]}\n</script>\n", out);
    for (uint32_t i = 0; i < pictures->count; i++) {
        fprintf(out, "<script type=\"text/plain\" id=\"p%u\">", (unsigned)i);
        markup_base64(out, pictures->pictures[i].png, pictures->pictures[i].bytes);
        fputs("</script>\n", out);
    }
    return failed;
}

/* ---- the page -------------------------------------------------------------------------------------------------- */

static void write_ground(FILE *out, const char *const colours[CHART_COLOURS], const char *rest)
{
    fputs(rest, out);
    for (uint32_t c = 0; c < CHART_COLOURS; c++) {
        fprintf(out, "--c%u:%s;", (unsigned)c, colours[c]);
    }
}

/* Light, dark, and what the reader has set unless the page's button says otherwise. */
static void write_style(FILE *out)
{
    static const char light[] = "color-scheme:light;--paper:#fbfaf8;--raised:#fff;--ink:#1d2126;--quiet:#5c6672;"
                                "--line:#dcd9d2;--grid:#e9e6df;--accent:#0a7568;",
                      dark[] = "color-scheme:dark;--paper:#16181b;--raised:#1e2125;--ink:#e6e4df;--quiet:#9aa3ad;"
                               "--line:#363b41;--grid:#2a2e33;--accent:#53d6c1;";
    fputs("\n:root{", out);
    write_ground(out, chart_colours_light, light);
    fputs("}\n@media(prefers-color-scheme:dark){:root:not([data-theme=light]){", out);
    write_ground(out, chart_colours_dark, dark);
    fputs("}}\n:root[data-theme=dark]{", out);
    write_ground(out, chart_colours_dark, dark);
    fputs("}\n", out);
    fputs(chart_page_css, out);
}

/* Writes the template up to the mark and returns the text after the mark. */
static const char *up_to(FILE *out, const char *from, const char *mark)
{
    const char *at = strstr(from, mark);
    fwrite(from, 1, (size_t)(at - from), out);
    return at + strlen(mark);
}

int chart_page_write(FILE *out, const chart_points *points, const chart_names *names, const chart_pictures *pictures,
                     const chart_view *first)
{
    const char *rest = up_to(out, chart_page_html, "<!--style-->");
    write_style(out);
    rest = up_to(out, rest, "<!--svg-->");
    chart_svg_write(out, points, names, first, 1, CHART_GROUND_READER);
    rest = up_to(out, rest, "<!--data-->");
    int failed = write_data(out, points, names, pictures, first);
    rest = up_to(out, rest, "<!--script-->\n");
    fputs(chart_page_js, out);
    fputs(rest, out);
    return failed;
}
