/* SPDX-License-Identifier: Apache-2.0 */
#include "study/stress/report.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/cli.h"
#include "cli/tables/json_output.h"
#include "study/stress/table.h"
#include "study/stress/verdict.h"

#define ERROR_BYTES 512

int stress_report_open(stress_report *report, const stress_outputs *to, const stress_contest *contest, uint32_t cells)
{
    char error[ERROR_BYTES] = "";
    *report = (stress_report){.to = *to, .contest = contest, .row_total = cells * stress_row_count(contest)};
    report->rows = calloc(report->row_total, sizeof *report->rows);
    if (report->rows == NULL) {
        return cli_error(CLI_BAD_INPUT, "out of memory");
    }
    if (to->page != NULL && whole_file_begin(&report->page_file, to->page, error, sizeof error) != 0) {
        return cli_error(CLI_BAD_INPUT, "%s", error);
    }
    if (to->csv != NULL) {
        bool is_new;
        if (csv_file_open(&report->csv, to->csv, false, &is_new) != CLI_OK) {
            return CLI_BAD_INPUT;
        }
        stress_csv_header(&report->csv.table);
    }
    cli_progress_within("rows", 0, 0, report->row_total);
    return CLI_OK;
}

int stress_report_cell(stress_report *report, const stress_row *rows, const uint8_t *renders, const uint8_t *plain,
                       const stress_case *c, const perturbation *p)
{
    uint32_t count = stress_row_count(report->contest);
    memcpy(report->rows + report->row_count, rows, count * sizeof *rows);
    report->row_count += count;
    for (uint32_t i = 0; i < count && report->csv.table.file != NULL; i++) {
        stress_csv_row(&report->csv.table, &rows[i]);
    }
    cli_progress_within("rows", 0, report->row_count, report->row_total);
    if (report->to.page != NULL && !stress_album_offer(&report->album, rows, renders, plain, c, report->contest, p)) {
        return cli_error(CLI_BAD_INPUT, "out of memory");
    }
    return CLI_OK;
}

static void print_json(const stress_report *report)
{
    cJSON *object = cJSON_CreateObject();
    cJSON *rows = cJSON_AddArrayToObject(object, "rows");
    for (uint32_t i = 0; i < report->row_count; i++) {
        cJSON_AddItemToArray(rows, stress_json(&report->rows[i]));
    }
    json_add_integer(object, "broken", stress_broken(report->rows, report->row_count));
    json_print(object);
}

static int write_page(stress_report *report)
{
    char error[ERROR_BYTES] = "";
    if (stress_album_write(&report->album, report->to.worst, report->rows, report->row_count, report->contest,
                           report->page_file.stream) != 0) {
        return cli_error(CLI_BAD_INPUT, "%s: out of memory for the page", report->to.page);
    }
    return t3r_whole_file_commit(&report->page_file, NULL, error, sizeof error) != 0
               ? cli_error(CLI_BAD_INPUT, "%s", error)
               : CLI_OK;
}

static int finish(stress_report *report)
{
    if (report->to.json) {
        print_json(report);
    } else {
        stress_print_tables(stdout, report->rows, report->row_count, report->contest);
        stress_print_verdict(stdout, report->rows, report->row_count, report->contest);
    }
    int code = report->to.page != NULL ? write_page(report) : CLI_OK;
    uint32_t broken = stress_broken(report->rows, report->row_count);
    if (code == CLI_OK && broken > 0) {
        code = cli_error(CLI_BAD_INPUT, "%u rows break an invariant", (unsigned)broken);
    }
    return code;
}

int stress_report_close(stress_report *report, int code)
{
    cli_progress_end();
    const bool is_whole = code == CLI_OK; /* independent of the rows */
    if (code == CLI_OK) {
        code = finish(report);
    }
    const int closed = csv_file_close(&report->csv, is_whole);
    code = code == CLI_OK ? closed : code;
    t3r_whole_file_abandon(&report->page_file);
    stress_album_free(&report->album);
    free(report->rows);
    return code;
}
