/* SPDX-License-Identifier: Apache-2.0 */
/* The rows of a stress test as tables: CSV, JSON, terminal. */
#ifndef TRIM3R_TOOLS_STRESS_TABLE_H
#define TRIM3R_TOOLS_STRESS_TABLE_H

#include <cjson/cJSON.h>

#include "cli/tables/csv.h"
#include "study/stress/measure.h"

void stress_csv_header(csv_table *table);
void stress_csv_row(csv_table *table, const stress_row *row);
/* Returns an object of all columns, null where one does not apply; NULL if out of memory. */
cJSON *stress_json(const stress_row *row);

/* Returns the mean over the cases with the perturbation, strength, method and budget of `like`; NaN if none was
 * measured. `refused` (may be NULL): the number of refused ones. */
double stress_mean(const stress_row *rows, uint32_t count, const stress_row *like, stress_value value,
                   uint32_t *refused);

/* Prints a table for each budget and measure: a line for each perturbation and strength, a column for each method. */
void stress_print_tables(FILE *out, const stress_row *rows, uint32_t count, const stress_contest *contest);
/* "0.5 stops", "4 px", "10^3", "" */
void stress_strength(const stress_row *row, char *text, size_t bytes);

#endif
