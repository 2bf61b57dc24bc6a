/* SPDX-License-Identifier: Apache-2.0 */
#include "study/chart/table.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/tables/csv_read.h"
#include "host/file_bytes.h"
#include "host/grow.h"
#include "host/reason.h"

#define NO_COLUMN UINT32_MAX
#define BUDGET_BYTES 40

const chart_setting_about chart_settings[CHART_SETTINGS] = {
    [CHART_METHOD] = {"method", "", ""},       [CHART_HEAD] = {"head", "", ""},
    [CHART_BITS] = {"bits", "", " bits"},      [CHART_REFINE] = {"refine", "refine ", ""},
    [CHART_ALLOCATE] = {"allocate", "", ""},   [CHART_DEPTH] = {"depth", "", ""},
    [CHART_WAVELET] = {"wavelet", "", ""},     [CHART_LEVELS] = {"levels", "levels ", ""},
    [CHART_CLUSTERS] = {"clusters", "K ", ""}, [CHART_ELSE] = {"settings", "else ", ""},
    [CHART_ABLATION] = {"ablation", "", ""},   [CHART_KEEP] = {"keep", "", " % kept"},
};

const chart_measure_about chart_measures[CHART_MEASURES] = {
    [CHART_PSNR] = {"psnr", "PSNR", CHART_DECIBELS, 2, 0},
    [CHART_SSIM] = {"ssim", "SSIM", CHART_PLAIN, 3, 0},
    [CHART_PERCEPTUAL] = {"perceptual", "Difference (FLIP)", CHART_PLAIN, 3, 1},
    [CHART_PLANAR_PSNR] = {"planar_psnr", "Planar PSNR", CHART_DECIBELS, 2, 0},
    [CHART_PSNR_ALL] = {"psnr_all", "Whole-picture PSNR", CHART_DECIBELS, 2, 0},
    [CHART_SSIM_ALL] = {"ssim_all", "Whole-picture SSIM", CHART_PLAIN, 3, 0},
    [CHART_PERCEPTUAL_ALL] = {"perceptual_all", "Whole-picture difference (FLIP)", CHART_PLAIN, 3, 1},
    [CHART_BUILD_MS] = {"build_ms", "Build time", CHART_MILLISECONDS, 0, 1},
    [CHART_RENDER_MS] = {"render_ms", "Render time", CHART_MILLISECONDS, 0, 1},
    [CHART_ARENA_BYTES] = {"arena_bytes", "Arena", CHART_BYTES, 0, 1},
    [CHART_SCENE_BYTES] = {"scene_bytes", "Scene", CHART_BYTES, 0, 1},
    [CHART_GAUSSIANS] = {"gaussians", "Gaussians", CHART_PLAIN, 0, 1},
};

/* The columns of a table. */
typedef struct layout {
    uint32_t scene, context, target, requested, picture;
    uint32_t setting[CHART_SETTINGS], measure[CHART_MEASURES];
    uint32_t cells;
} layout;

static int fail(const csv_reader *reader, char *error, size_t error_bytes, const char *what, const char *why)
{
    return t3r_reason(error, error_bytes, "%s:%u: %.60s%s", reader->name, (unsigned)reader->line, what, why);
}

static uint32_t column(const csv_reader *reader, const char *name)
{
    for (uint32_t i = 0; i < reader->cell_count; i++) {
        if (strcmp(reader->cell[i], name) == 0) {
            return i;
        }
    }
    return NO_COLUMN;
}

static int read_heading(csv_reader *reader, layout *l, char *error, size_t error_bytes)
{
    for (uint32_t i = 0; i < reader->cell_count; i++) {
        if (reader->cell[i][0] != '\0' && column(reader, reader->cell[i]) != i) {
            return fail(reader, error, error_bytes, reader->cell[i], " is in the heading twice");
        }
    }
    l->cells = reader->cell_count;
    l->scene = column(reader, "scene");
    l->context = column(reader, "context");
    l->target = column(reader, "target");
    l->requested = column(reader, "requested");
    l->picture = column(reader, "picture");
    for (int s = 0; s < CHART_SETTINGS; s++) {
        l->setting[s] = column(reader, chart_settings[s].column);
    }
    bool quality = false, cost = false;
    for (int m = 0; m < CHART_MEASURES; m++) {
        l->measure[m] = column(reader, chart_measures[m].column);
        quality = quality || (m < CHART_QUALITIES && l->measure[m] != NO_COLUMN);
        cost = cost || (m >= CHART_QUALITIES && m < CHART_COSTS_END && l->measure[m] != NO_COLUMN);
    }
    if (!quality) {
        return fail(reader, error, error_bytes, "the heading names no quality",
                    ": one of psnr, ssim, perceptual, planar_psnr, psnr_all, ssim_all, perceptual_all");
    }
    return cost ? 0
                : fail(reader, error, error_bytes, "the heading names no cost",
                       ": one of build_ms, render_ms, arena_bytes, scene_bytes");
}

static const char *cell(const csv_reader *reader, uint32_t index)
{
    return index == NO_COLUMN ? "" : reader->cell[index];
}

/* Sets the number of the row's case; adds the case if it is new. */
static int number_case(chart_table *table, const csv_reader *reader, const layout *l, uint32_t *number)
{
    static const char *const parts[] = {"scene", "context", "target"};
    const char *texts[] = {cell(reader, l->scene), cell(reader, l->context), cell(reader, l->target)};
    _Static_assert(sizeof parts == sizeof texts, "a text a part");
    char key[CSV_ROW_BYTES_MOST + 8];
    chart_case is;
    /* unambiguous: no cell holds the control character that separates them */
    snprintf(key, sizeof key, "%s\001%s\001%s", texts[0], texts[1], texts[2]);
    if (chart_texts_number(&table->scenes, texts[0], &is.scene) != 0 ||
        chart_texts_number(&table->texts, texts[1], &is.context) != 0 ||
        chart_texts_number(&table->texts, texts[2], &is.target) != 0 ||
        chart_texts_number(&table->case_keys, key, number) != 0) {
        return -1;
    }
    chart_case *cases = t3r_grow(table->cases, *number, &table->case_room, sizeof *cases);
    if (cases == NULL) {
        return -1;
    }
    table->cases = cases;
    table->cases[*number] = is;
    return 0;
}

/* Returns the budget as text: 5 and "5.0" are equal; a text such as auto stays. Without a percentage the count is
 * used. */
static const char *budget_text(const char *percent, const char *count, char own[BUDGET_BYTES])
{
    const bool counted = percent[0] == '\0';
    const char *text = counted ? count : percent;
    double number;
    bool given;
    if (csv_number(text, &number, &given) != 0 || !given) {
        return text;
    }
    snprintf(own, BUDGET_BYTES, counted ? "%.10g Gaussians" : "%.10g", number);
    return own;
}

static int read_measures(chart_row *row, const csv_reader *reader, const layout *l, char *error, size_t error_bytes)
{
    for (int m = 0; m < CHART_MEASURES; m++) {
        const char *text = cell(reader, l->measure[m]);
        bool given;
        char why[96];
        if (csv_number(text, &row->value[m], &given) != 0) {
            snprintf(why, sizeof why, ": '%.40s' is not a finite number", text);
            return fail(reader, error, error_bytes, chart_measures[m].column, why);
        }
        if (given && m >= CHART_QUALITIES && row->value[m] < 0) {
            return fail(reader, error, error_bytes, chart_measures[m].column, " is below 0");
        }
    }
    return 0;
}

/* Whether a path stays within the folder where it is looked up. */
static bool stays_within(const char *path)
{
    for (const char *part = path; part != NULL; part = strchr(part, '/')) {
        part += *part == '/' && part != path;
        if (*part == '/' || (strncmp(part, "..", 2) == 0 && (part[2] == '/' || part[2] == '\0'))) {
            return false;
        }
    }
    return true;
}

static chart_row *new_row(chart_table *table)
{
    chart_row *rows = t3r_grow(table->rows, table->row_count, &table->row_room, sizeof *rows);
    table->rows = rows != NULL ? rows : table->rows;
    return rows != NULL ? &rows[table->row_count] : NULL;
}

static int read_row(chart_table *table, const csv_reader *reader, const layout *l, char *error, size_t error_bytes)
{
    if (reader->cell_count != l->cells) {
        char why[96];
        snprintf(why, sizeof why, "%u cells, where the heading has %u", (unsigned)reader->cell_count,
                 (unsigned)l->cells);
        return fail(reader, error, error_bytes, "", why);
    }
    if (table->row_count == CHART_ROWS_MOST) {
        return fail(reader, error, error_bytes, "", "more than 500000 rows");
    }
    chart_row *row = new_row(table);
    if (row == NULL) {
        return fail(reader, error, error_bytes, "", "out of memory");
    }
    *row = (chart_row){.file = table->file_count};
    if (read_measures(row, reader, l, error, error_bytes) != 0) {
        return -1;
    }
    int failed = number_case(table, reader, l, &row->scene_case);
    for (int s = 0; s < CHART_SETTINGS && failed == 0; s++) {
        char own[BUDGET_BYTES];
        const char *text = cell(reader, l->setting[s]);
        if (strlen(text) > CHART_SETTING_BYTES_MOST) {
            return fail(reader, error, error_bytes, chart_settings[s].column, ": more than 160 bytes");
        }
        text = s == CHART_KEEP ? budget_text(text, cell(reader, l->requested), own) : text;
        failed = chart_texts_number(&table->texts, text, &row->setting[s]);
    }
    const char *picture = cell(reader, l->picture);
    if (!stays_within(picture) || (picture[0] != '\0' && !stays_within(cell(reader, l->scene)))) {
        return fail(reader, error, error_bytes, "picture", ": a path that leaves its folder");
    }
    if (failed != 0 || chart_texts_number(&table->texts, picture, &row->picture) != 0) {
        return fail(reader, error, error_bytes, "", "out of memory, or its texts collide");
    }
    table->has_pictures |= picture[0] != '\0';
    table->row_count++;
    return 0;
}

int chart_table_parse(chart_table *table, const char *name, const char *text, size_t bytes, char *error,
                      size_t error_bytes)
{
    csv_reader *reader = malloc(sizeof *reader);
    if (reader == NULL) {
        return t3r_reason(error, error_bytes, "%s: out of memory", name);
    }
    layout l = {0};
    uint32_t rows_before = table->row_count;
    csv_reader_open(reader, name, text, bytes);
    int got = csv_reader_next(reader, error, error_bytes);
    int failed = got <= 0 ? -1 : read_heading(reader, &l, error, error_bytes);
    if (got == 0) {
        t3r_reason(error, error_bytes, "%s:1: the table is empty", name);
    }
    while (failed == 0 && (got = csv_reader_next(reader, error, error_bytes)) != 0) {
        failed = got < 0 ? -1 : read_row(table, reader, &l, error, error_bytes);
    }
    if (failed == 0 && table->row_count == rows_before) {
        failed = fail(reader, error, error_bytes, "", "a heading without rows");
    }
    table->file_count++;
    free(reader);
    return failed;
}

int chart_table_read(chart_table *table, const char *path, char *error, size_t error_bytes)
{
    size_t count;
    uint8_t *bytes = t3r_file_bytes(path, CHART_FILE_BYTES_MOST, &count, error, error_bytes);
    if (bytes == NULL) {
        return -1;
    }
    int failed = chart_table_parse(table, path, (const char *)bytes, count, error, error_bytes);
    free(bytes);
    return failed;
}

void chart_table_free(chart_table *table)
{
    chart_texts_free(&table->texts);
    chart_texts_free(&table->scenes);
    chart_texts_free(&table->case_keys);
    free(table->cases);
    free(table->rows);
    *table = (chart_table){0};
}
