/* SPDX-License-Identifier: Apache-2.0 */
#include "study/chart/names.h"

#include <ctype.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "study/chart/texts.h"

const char *const chart_shapes[CHART_SHAPES] = {
    "M-1,0A1,1 0 1 1 1,0A1,1 0 1 1 -1,0Z",
    "M0,-1.27L1.27,0L0,1.27L-1.27,0Z",
    "M-0.9,-0.9H0.9V0.9H-0.9Z",
    "M0,-1.25L1.2,0.85H-1.2Z",
    "M0,1.25L1.2,-0.85H-1.2Z",
    "M-0.4,-1.2H0.4V-0.4H1.2V0.4H0.4V1.2H-0.4V0.4H-1.2V-0.4H-0.4Z",
};
/* Neighbours differ in hue and in lightness, so that colour-blind readers can distinguish them. */
const char *const chart_colours_light[CHART_COLOURS] = {"#0a7568", "#e0833a", "#3f63d2", "#c43c63",
                                                        "#8a63c9", "#7d8f21", "#2f9fd0", "#6b6f76"};
const char *const chart_colours_dark[CHART_COLOURS] = {"#53d6c1", "#f3a261", "#8aa6ff", "#ff7d9d",
                                                       "#c3a3f7", "#bfd060", "#6fcdf5", "#b4b9c1"};

#define MIDDLE_DOT " \xC2\xB7 "

static const char *setting(const chart_points *points, uint32_t point, chart_setting s)
{
    return points->table->texts.text[points->points[point].setting[s]];
}

void chart_setting_text(const chart_points *points, uint32_t point, chart_setting s, char *text, size_t bytes)
{
    const char *value = setting(points, point, s);
    bool given = value[0] != '\0', number = given && isdigit((unsigned char)value[strlen(value) - 1]);
    snprintf(text, bytes, "%s%s%s", given ? chart_settings[s].before : "", value,
             number ? chart_settings[s].behind : "");
}

static uint32_t first_of(const chart_points *points, uint32_t series)
{
    return points->series[series].first_point;
}

/* Returns the most frequent value of a setting (the first of several), which names may omit; "" if no series gives
 * one. */
static const char *usual(const chart_points *points, chart_setting s)
{
    const char *found = "";
    uint32_t most = 0;
    for (uint32_t a = 0; a < points->series_count; a++) {
        const char *value = setting(points, first_of(points, a), s);
        uint32_t count = 0;
        for (uint32_t b = 0; b < points->series_count; b++) {
            count += strcmp(value, setting(points, first_of(points, b), s)) == 0;
        }
        if (value[0] != '\0' && count > most) {
            found = value;
            most = count;
        }
    }
    return found;
}

/* Appends the text, truncated if it does not fit. Settings of at most CHART_SETTING_BYTES_MOST bytes always fit. */
static void append(char *text, size_t bytes, const char *between, const char *more)
{
    size_t length = strlen(text), gap = length == 0 ? 0 : strlen(between), count = strlen(more);
    if (count > 0 && length + gap + count < bytes) {
        memcpy(text + length, between, gap);
        memcpy(text + length + gap, more, count + 1);
    }
}

/* Returns the suffix for how a method makes Gaussians of its points: "+finetune", "+head", or "". */
static const char *way_of(const char *method)
{
    return method + strcspn(method, "+");
}

/* Writes the contestant, which decides the colour: the method that chose the points, and the head. */
static void contestant(const chart_points *points, uint32_t point, char *text, size_t bytes)
{
    const char *method = setting(points, point, CHART_METHOD);
    snprintf(text, bytes, "%.*s\001%s", (int)(way_of(method) - method), method, setting(points, point, CHART_HEAD));
}

/* Names the missing setting if two series differ only because one of them does not give it. */
static void name_missing(chart_names *names, const chart_points *points, uint32_t series, const char *const usuals[])
{
    char *text = names->series[series].text;
    bool taken = false;
    for (uint32_t earlier = 0; earlier < series && !taken; earlier++) {
        taken = strcmp(names->series[earlier].text, text) == 0;
    }
    for (int s = 0; s < CHART_KEEP && taken; s++) {
        if (usuals[s][0] != '\0' && setting(points, first_of(points, series), (chart_setting)s)[0] == '\0') {
            append(text, CHART_NAME_BYTES, MIDDLE_DOT, chart_settings[s].column);
            append(text, CHART_NAME_BYTES, " ", "not given");
        }
    }
}

static int name_series(chart_names *names, const chart_points *points, uint32_t series, const char *const usuals[],
                       chart_texts *contestants, chart_texts *variants)
{
    chart_name *name = &names->series[series];
    uint32_t point = first_of(points, series), who, how;
    char key[CHART_NAME_BYTES];
    contestant(points, point, key, sizeof key);
    if (chart_texts_number(contestants, key, &who) != 0) {
        return -1;
    }
    key[0] = '\0';
    for (int s = 0; s < CHART_KEEP; s++) {
        char text[CHART_NAME_BYTES];
        chart_setting_text(points, point, (chart_setting)s, text, sizeof text);
        bool given = s == CHART_METHOD || strcmp(setting(points, point, (chart_setting)s), usuals[s]) != 0;
        append(name->text, sizeof name->text, MIDDLE_DOT, given ? text : "");
        append(key, sizeof key, ",", given && s != CHART_METHOD && s != CHART_HEAD ? text : "");
    }
    append(key, sizeof key, ",", way_of(setting(points, point, CHART_METHOD)));
    if (name->text[0] == '\0') {
        snprintf(name->text, sizeof name->text, "all rows");
    }
    name_missing(names, points, series, usuals);
    if (chart_texts_number(variants, key, &how) != 0) {
        return -1;
    }
    name->colour = who % CHART_COLOURS;
    name->shape = (how + who / CHART_COLOURS) % CHART_SHAPES;
    return 0;
}

/* Gives colours to the variants when there is only one contestant. */
static void colour_variants(chart_names *names, const chart_points *points, uint32_t contestants)
{
    for (uint32_t s = 0; s < points->series_count && contestants == 1; s++) {
        names->series[s].colour = s % CHART_COLOURS;
    }
}

static void name_common(chart_names *names, const char *const usuals[])
{
    for (int s = 0; s < CHART_KEEP; s++) {
        char text[CHART_NAME_BYTES];
        if (s != CHART_METHOD && usuals[s][0] != '\0') {
            snprintf(text, sizeof text, "%s%s%s", chart_settings[s].before, usuals[s], chart_settings[s].behind);
            append(names->common, sizeof names->common, ", ", text);
        }
    }
}

int chart_names_make(chart_names *names, const chart_points *points)
{
    chart_texts contestants = {0}, variants = {0};
    const char *usuals[CHART_SETTINGS];
    *names = (chart_names){.series = calloc(points->series_count, sizeof *names->series)};
    int failed = names->series == NULL ? -1 : 0;
    for (int s = 0; s < CHART_KEEP; s++) {
        usuals[s] = usual(points, (chart_setting)s);
    }
    for (uint32_t s = 0; s < points->series_count && failed == 0; s++) {
        failed = name_series(names, points, s, usuals, &contestants, &variants);
    }
    if (failed == 0) {
        colour_variants(names, points, contestants.count);
        name_common(names, usuals);
    }
    chart_texts_free(&contestants);
    chart_texts_free(&variants);
    if (failed != 0) {
        chart_names_free(names);
    }
    return failed;
}

void chart_names_free(chart_names *names)
{
    free(names->series);
    *names = (chart_names){0};
}
