/* SPDX-License-Identifier: Apache-2.0 */
/* Outputs for the rows of an evaluation as they arrive: the terminal or one JSON object, a CSV file, pictures, a
 * page. */
#ifndef TRIM3R_TOOLS_EVALUATION_REPORT_H
#define TRIM3R_TOOLS_EVALUATION_REPORT_H

#include <cjson/cJSON.h>

#include "cli/files/csv_file.h"
#include "cli/files/whole_file.h"
#include "evaluation/evaluation.h"
#include "evaluation/resume.h"
#include "evaluation/settings.h"
#include "pictures/html_page.h"

typedef struct evaluation_outputs {
    const char *csv, *images, *page; /* paths; NULL = none */
    bool json, planar;
    bool wide;   /* rows have all main columns, not only those that fit 80 characters */
    bool resume; /* add to the rows of `csv` */
    /* Prints one table of the means at the end instead of rows as they arrive; NULL = rows. False if out of memory. */
    bool (*table)(FILE *out, const evaluation_row *means, uint32_t count, bool planar);
    bool folder_each;                       /* a folder within `images` for each scene */
    char suffix[EVALUATION_SETTINGS_BYTES]; /* part of picture names: settings of all rows that are not the default */
} evaluation_outputs;

typedef struct evaluation_report {
    evaluation_outputs to;
    csv_file csv;
    html_page *page;
    t3r_whole_file page_file;
    evaluation_row *rows; /* room for all */
    uint32_t row_count, row_total;
    uint32_t known_count;           /* how many of row_count were in the table already */
    uint32_t case_total, rows_each; /* of a case */
    cJSON *refused;                 /* cases: objects of scene, context, target, reason */
} evaluation_report;

/* These report on stderr and return an exit status of cli.h. */

/* Opens every output possible, so that a bad path is reported before the work. Call evaluation_report_close() in any
 * case. */
int evaluation_report_open(evaluation_report *report, const evaluation_outputs *to, uint32_t cases, uint32_t rows_each);
/* Whether there are pictures or a page; otherwise views and renders are not used. */
bool evaluation_report_shows(const evaluation_report *report);
/* Adds the recorded views of the following rows. */
int evaluation_report_case(evaluation_report *report, const evaluation_views *views, const evaluation_case *what);
/* Writes a heading for the following rows. */
void evaluation_report_strip(evaluation_report *report, const char *label);
/* Names the row's `picture` when there are pictures. */
/* `known`: the row was in the table already. */
int evaluation_report_row(evaluation_report *report, bool known, const evaluation_views *views, const char *label,
                          evaluation_row *row, uint8_t *render);
/* Drops the case of the last or the next rows: it is reported, and is in no mean and no table. */
void evaluation_report_refuse(evaluation_report *report, const evaluation_case *what, const char *reason);
/* Writes means, JSON and page if `code` is CLI_OK; otherwise no partial page. Returns `code`, or an error of its own;
 * CLI_BAD_INPUT if every case was refused. */
int evaluation_report_close(evaluation_report *report, int code);

#endif
