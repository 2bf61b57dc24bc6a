/* SPDX-License-Identifier: Apache-2.0 */
/* Rows of an evaluation as cells of a table: the one list of columns that CSV, JSON, terminal and page share. */
#ifndef TRIM3R_TOOLS_EVALUATION_TABLE_H
#define TRIM3R_TOOLS_EVALUATION_TABLE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include <cjson/cJSON.h>

#include "cli/tables/csv.h"
#include "evaluation/evaluation.h"

#define EVALUATION_COLUMNS 35u
#define EVALUATION_CELL_BYTES 512u /* of any cell, including the terminator */

/* Stable order; NULL past the last. */
const char *evaluation_column_name(uint32_t column);
/* Writes the cell as text; "" if it does not apply. */
void evaluation_cell(const evaluation_row *row, uint32_t column, char *text, size_t bytes);

void evaluation_csv_header(csv_table *table);
void evaluation_csv_row(csv_table *table, const evaluation_row *row);
/* Reads a row from evaluation_cell()'s texts; those of method, allocate, depth, wavelet and ablation must outlive
 * the row. False if a number is invalid or a text too long. */
bool evaluation_row_read(evaluation_row *row, const char *const cells[EVALUATION_COLUMNS]);
/* Whether two rows have the same budget. */
bool evaluation_same_budget(const evaluation_row *a, const evaluation_row *b);
/* Whether two rows are of the same case, contestant, budget and settings. */
bool evaluation_same(const evaluation_row *a, const evaluation_row *b);
/* Returns an object of all columns, null where one does not apply; NULL if out of memory. */
cJSON *evaluation_json(const evaluation_row *row);

/* Averages rows that differ only in context and target (by_scene), or also in the scene, in order of first appearance;
 * decibels are averaged as decibels, and inapplicable cells are skipped. Returns the number of means, at most `count`.
 */
uint32_t evaluation_means(const evaluation_row *rows, uint32_t count, bool by_scene, evaluation_row *means);

/* Writes a cell for terminal and page: the main columns of recordings or of planar images, with fewer digits. False
 * if the column is not one of them. */
bool evaluation_glance(const evaluation_row *row, uint32_t column, bool planar, char *text, size_t bytes);
/* Print these columns for a terminal: all, or with `wide` false those that fit 80 characters. */
void evaluation_print_header(FILE *out, bool planar, bool wide);
void evaluation_print_row(FILE *out, const evaluation_row *row, bool planar, bool wide);

#endif
