/* SPDX-License-Identifier: Apache-2.0 */
/* Outputs for the rows of a stress test: the terminal or one JSON object, a CSV file, a page of worst cases. */
#ifndef TRIM3R_TOOLS_STRESS_REPORT_H
#define TRIM3R_TOOLS_STRESS_REPORT_H

#include "cli/files/csv_file.h"
#include "cli/files/whole_file.h"
#include "study/stress/measure.h"
#include "study/stress/page.h"

typedef struct stress_outputs {
    const char *csv, *page; /* paths; NULL: none */
    bool json;
    uint32_t worst; /* cells on the page */
} stress_outputs;

typedef struct stress_report {
    stress_outputs to;
    const stress_contest *contest;
    csv_file csv;
    t3r_whole_file page_file;
    stress_album album;
    stress_row *rows; /* room for all */
    uint32_t row_count, row_total;
} stress_report;

/* Opens every output that can be opened, so that a bad path is reported before the work. Like the next two, reports on
 * stderr and returns an exit status of cli.h; call stress_report_close() in any case. */
int stress_report_open(stress_report *report, const stress_outputs *to, const stress_contest *contest, uint32_t cells);
/* Adds the rows of a cell, with pictures as in stress_album_offer(). */
int stress_report_cell(stress_report *report, const stress_row *rows, const uint8_t *renders, const uint8_t *plain,
                       const stress_case *c, const perturbation *p);
/* Writes tables, verdict, JSON and page when `code` is CLI_OK. Returns `code`, an error of its own, or CLI_BAD_INPUT
 * if an invariant is broken. */
int stress_report_close(stress_report *report, int code);

#endif
