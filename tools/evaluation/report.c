/* SPDX-License-Identifier: Apache-2.0 */
#include "evaluation/report.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/cli.h"
#include "cli/tables/json_output.h"
#include "evaluation/pictures.h"
#include "evaluation/table.h"

#define ERROR_BYTES 512
#define PATH_BYTES 4096

static int open_page(evaluation_report *report)
{
    char error[ERROR_BYTES] = "";
    report->page = html_page_new("trim3r: rendered views next to recorded ones",
                                 "A scene is built from the context views alone, with the share of their points that "
                                 "stands under each picture, and drawn from where the target was taken.");
    if (report->page == NULL) {
        return cli_error(CLI_BAD_INPUT, "out of memory");
    }
    if (whole_file_begin(&report->page_file, report->to.page, error, sizeof error) != 0) {
        return cli_error(CLI_BAD_INPUT, "%s", error);
    }
    return CLI_OK;
}

int evaluation_report_open(evaluation_report *report, const evaluation_outputs *to, uint32_t cases, uint32_t rows_each)
{
    *report =
        (evaluation_report){.to = *to, .row_total = cases * rows_each, .case_total = cases, .rows_each = rows_each};
    report->rows = calloc(report->row_total, sizeof *report->rows);
    report->refused = cJSON_CreateArray();
    if (report->rows == NULL || report->refused == NULL) {
        return cli_error(CLI_BAD_INPUT, "out of memory");
    }
    int code = to->page != NULL ? open_page(report) : CLI_OK;
    if (code == CLI_OK && to->csv != NULL) {
        bool is_new;
        code = csv_file_open(&report->csv, to->csv, to->resume, &is_new);
        if (code == CLI_OK && is_new) {
            evaluation_csv_header(&report->csv.table);
        }
    }
    if (code == CLI_OK && !to->json && to->table == NULL) {
        evaluation_print_header(stdout, to->planar, to->wide);
    }
    cli_progress_within("rows", 0, 0, report->row_total);
    return code;
}

/* ---- output as rows arrive ------------------------------------------------------------------------------------ */

/* Whether rows of the same target, seen from other frames, have its folder. */
static bool folder_taken(const evaluation_report *report, const evaluation_row *names)
{
    for (uint32_t i = 0; i < report->row_count; i++) {
        const evaluation_row *earlier = &report->rows[i];
        if (strcmp(earlier->scene, names->scene) == 0 && strcmp(earlier->target, names->target) == 0 &&
            strcmp(earlier->context, names->context) != 0) {
            return true;
        }
    }
    return false;
}

/* Writes the folder of a case within --images, with a slash at its end: <target>/, or <target>_from_0_4/ for further
 * contexts of a target; each recording of several has its own folder around these. */
static int case_folder(const evaluation_report *report, const evaluation_row *names, char *folder, size_t bytes)
{
    bool planar = report->to.planar, scene = planar || report->to.folder_each;
    const char *from = !planar && folder_taken(report, names) ? "_from_" : "";
    int length = snprintf(folder, bytes, "%s%s%s%s%s%s", scene ? names->scene : "", scene ? "/" : "",
                          planar ? "" : names->target, from, *from != '\0' ? names->context : "", planar ? "" : "/");
    for (char *c = folder; *c != '\0'; c++) {
        *c = *c == ',' ? '_' : *c;
    }
    return length > 0 && (size_t)length < bytes ? CLI_OK
                                                : cli_error(CLI_BAD_INPUT, "%s: too long for a folder", names->scene);
}

bool evaluation_report_shows(const evaluation_report *report)
{
    return report->page != NULL || report->to.images != NULL;
}

int evaluation_report_case(evaluation_report *report, const evaluation_views *views, const evaluation_case *what)
{
    if (report->page != NULL) {
        evaluation_page_views(report->page, views, what);
    }
    if (report->to.images == NULL) {
        return CLI_OK;
    }
    char folder[EVALUATION_CELL_BYTES], path[PATH_BYTES];
    evaluation_row names = {0};
    evaluation_name_case(&names, what);
    int code = case_folder(report, &names, folder, sizeof folder);
    if (code == CLI_OK && snprintf(path, sizeof path, "%s/%s", report->to.images, folder) >= (int)sizeof path) {
        code = cli_error(CLI_BAD_USAGE, "--images: the path is too long");
    }
    return code == CLI_OK ? evaluation_write_views(path, views, what) : code;
}

/* Names a row's render. Settings of the whole run that are not the default are part of the name, so that runs which
 * differ in a column of the table may share a folder. */
static int name_picture(const evaluation_report *report, const char *label, evaluation_row *row)
{
    char folder[EVALUATION_CELL_BYTES];
    int code = case_folder(report, row, folder, sizeof folder);
    const bool counted = !isnan(row->value[EVALUATION_REQUESTED]);
    char budget[48] = "";
    if (counted || !isnan(row->value[EVALUATION_KEEP])) {
        snprintf(budget, sizeof budget, "_%s%.10g", counted ? "gaussians-" : "",
                 row->value[counted ? EVALUATION_REQUESTED : EVALUATION_KEEP]);
    }
    int length = snprintf(row->picture, sizeof row->picture, "%s%s%s%s.png", folder, label, report->to.suffix, budget);
    if (code == CLI_OK && (length < 0 || (size_t)length >= sizeof row->picture)) {
        code = cli_error(CLI_BAD_INPUT, "%s: too long for a picture's name", folder);
    }
    return code;
}

void evaluation_report_strip(evaluation_report *report, const char *label)
{
    if (report->page != NULL) {
        html_page_strip(report->page, label);
    }
}

int evaluation_report_row(evaluation_report *report, bool known, const evaluation_views *views, const char *label,
                          evaluation_row *row, uint8_t *render)
{
    int code = report->to.images != NULL && !known ? name_picture(report, label, row) : CLI_OK;
    if (code != CLI_OK) {
        return code;
    }
    report->rows[report->row_count++] = *row;
    report->known_count += known;
    if (!report->to.json && report->to.table == NULL) {
        cli_progress_end();
        evaluation_print_row(stdout, row, report->to.planar, report->to.wide);
    }
    cli_progress_within("rows", report->known_count, report->row_count, report->row_total);
    if (known) {
        return CLI_OK;
    }
    if (report->csv.table.file != NULL) {
        evaluation_csv_row(&report->csv.table, row);
    }
    if (report->page != NULL) {
        evaluation_page_render(report->page, views, row, render);
    }
    return report->to.images != NULL ? evaluation_write_render(report->to.images, views, row, render) : CLI_OK;
}

static bool of_case(const evaluation_row *row, const evaluation_row *names)
{
    return strcmp(row->scene, names->scene) == 0 && strcmp(row->context, names->context) == 0 &&
           strcmp(row->target, names->target) == 0;
}

void evaluation_report_refuse(evaluation_report *report, const evaluation_case *what, const char *reason)
{
    const bool planar = report->to.planar;
    evaluation_row names = {0};
    evaluation_name_case(&names, what);
    while (report->row_count > 0 && of_case(&report->rows[report->row_count - 1], &names)) {
        report->row_count--;
    }
    report->known_count = report->known_count < report->row_count ? report->known_count : report->row_count;
    cJSON *item = cJSON_CreateObject();
    cJSON_AddStringToObject(item, "scene", names.scene);
    if (!planar) {
        cJSON_AddStringToObject(item, "context", names.context);
        cJSON_AddStringToObject(item, "target", names.target);
    }
    cJSON_AddStringToObject(item, "reason", reason);
    cJSON_AddItemToArray(report->refused, item);
    (void)cli_error(CLI_OK, "left out: %s%s%s%s%s%s", planar ? "" : "context ", names.context,
                    planar ? "" : ", target ", names.target, planar ? "" : ": ", reason);
    report->row_total -= report->rows_each;
    cli_progress_within("rows", report->known_count, report->row_count, report->row_total);
}

/* ---- output at the end ------------------------------------------------------------------------------------------ */

static void print_json(const evaluation_report *report, const evaluation_row *means, uint32_t mean_count)
{
    cJSON *object = cJSON_CreateObject();
    cJSON *rows = cJSON_AddArrayToObject(object, "rows");
    for (uint32_t i = 0; i < report->row_count; i++) {
        cJSON_AddItemToArray(rows, evaluation_json(&report->rows[i]));
    }
    cJSON *mean_rows = cJSON_AddArrayToObject(object, "means");
    for (uint32_t i = 0; i < mean_count; i++) {
        cJSON_AddItemToArray(mean_rows, evaluation_json(&means[i]));
    }
    cJSON_AddItemReferenceToObject(object, "refused", report->refused);
    json_print(object);
}

/* Lists columns with the same value in every row above the table, because a phone shows few columns. */
static void note_columns(const evaluation_row *rows, uint32_t count, bool planar, bool same[EVALUATION_COLUMNS],
                         char *note, size_t note_bytes)
{
    char first[EVALUATION_CELL_BYTES], other[EVALUATION_CELL_BYTES];
    size_t length = 0;
    note[0] = '\0';
    for (uint32_t c = 0; c < EVALUATION_COLUMNS; c++) {
        same[c] = count > 1 && evaluation_glance(&rows[0], c, planar, first, sizeof first);
        for (uint32_t i = 1; i < count && same[c]; i++) {
            evaluation_glance(&rows[i], c, planar, other, sizeof other);
            same[c] = strcmp(first, other) == 0;
        }
        if (same[c] && first[0] != '\0' && length < note_bytes) {
            length += (size_t)snprintf(note + length, note_bytes - length, "%s%s %s",
                                       length == 0 ? "In every row: " : ", ", evaluation_column_name(c), first);
        }
    }
}

static void page_table(html_page *page, const char *heading, const evaluation_row *rows, uint32_t count, bool planar,
                       bool folded)
{
    char text[EVALUATION_CELL_BYTES], note[EVALUATION_CELL_BYTES * 4];
    bool same[EVALUATION_COLUMNS];
    note_columns(rows, count, planar, same, note, sizeof note);
    html_page_table(page, heading, note, folded);
    for (uint32_t c = 0; c < EVALUATION_COLUMNS; c++) {
        if (evaluation_glance(&rows[0], c, planar, text, sizeof text) && !same[c]) {
            html_page_table_cell(page, evaluation_column_name(c));
        }
    }
    html_page_table_end_row(page);
    for (uint32_t i = 0; i < count; i++) {
        for (uint32_t c = 0; c < EVALUATION_COLUMNS; c++) {
            if (evaluation_glance(&rows[i], c, planar, text, sizeof text) && !same[c]) {
                html_page_table_cell(page, text);
            }
        }
        html_page_table_end_row(page);
    }
}

static void page_refused(html_page *page, const cJSON *refused)
{
    const cJSON *item, *cell;
    html_page_table(page, "Refused", "", false);
    cJSON_ArrayForEach(cell, refused->child)
    {
        html_page_table_cell(page, cell->string);
    }
    html_page_table_end_row(page);
    cJSON_ArrayForEach(item, refused)
    {
        cJSON_ArrayForEach(cell, item)
        {
            html_page_table_cell(page, cell->valuestring);
        }
        html_page_table_end_row(page);
    }
}

static int finish_page(evaluation_report *report, const evaluation_row *means, uint32_t mean_count, bool several)
{
    char error[ERROR_BYTES] = "";
    if (several) {
        page_table(report->page, "Means", means, mean_count, report->to.planar, false);
    }
    page_table(report->page, "Scores", report->rows, report->row_count, report->to.planar, several);
    if (cJSON_GetArraySize(report->refused) > 0) {
        page_refused(report->page, report->refused);
    }
    if (html_page_write(report->page, report->page_file.stream) != 0) {
        return cli_error(CLI_BAD_INPUT, "%s: out of memory for the page", report->to.page);
    }
    if (t3r_whole_file_commit(&report->page_file, NULL, error, sizeof error) != 0) {
        return cli_error(CLI_BAD_INPUT, "%s", error);
    }
    return CLI_OK;
}

/* Finishes the report, without a mean if there is only one row. */
static int finish(evaluation_report *report)
{
    const int refused = cJSON_GetArraySize(report->refused);
    if (report->row_count == 0) {
        return cli_error(CLI_BAD_INPUT, "every case was refused");
    }
    evaluation_row *means = calloc(report->row_count, sizeof *means);
    if (means == NULL) {
        return cli_error(CLI_BAD_INPUT, "out of memory");
    }
    uint32_t mean_count = evaluation_means(report->rows, report->row_count, !report->to.planar, means);
    bool several = mean_count < report->row_count;
    if (report->to.json) {
        print_json(report, means, mean_count);
    }
    for (uint32_t i = 0; several && !report->to.json && report->to.table == NULL && i < mean_count; i++) {
        evaluation_print_row(stdout, &means[i], report->to.planar, report->to.wide);
    }
    int code = CLI_OK;
    if (report->to.table != NULL && !report->to.json &&
        !report->to.table(stdout, means, mean_count, report->to.planar)) {
        code = cli_error(CLI_BAD_INPUT, "out of memory");
    }
    if (code == CLI_OK && report->page != NULL) {
        code = finish_page(report, means, mean_count, several);
    }
    if (code == CLI_OK && refused > 0) {
        (void)cli_error(CLI_OK, "%d of %" PRIu32 " cases were refused and are in no mean", refused, report->case_total);
    }
    free(means);
    return code;
}

int evaluation_report_close(evaluation_report *report, int code)
{
    cli_progress_end();
    const bool is_whole = code == CLI_OK && report->row_count > 0;
    if (code == CLI_OK) {
        code = finish(report);
    }
    const int closed = csv_file_close(&report->csv, is_whole);
    code = code == CLI_OK ? closed : code;
    t3r_whole_file_abandon(&report->page_file);
    html_page_free(report->page);
    cJSON_Delete(report->refused);
    free(report->rows);
    return code;
}
