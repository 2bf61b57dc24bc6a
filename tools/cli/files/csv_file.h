/* SPDX-License-Identifier: Apache-2.0 */
/* A table that long work writes row by row. In a new table each row appears at once, so that interrupted work keeps its
 * rows. An existing table stays in place until the new one is complete. */
#ifndef TRIM3R_TOOLS_CSV_FILE_H
#define TRIM3R_TOOLS_CSV_FILE_H

#include <stdbool.h>

#include "cli/files/whole_file.h"
#include "cli/tables/csv.h"

typedef struct csv_file {
    csv_table table; /* its `file` is NULL until a table is open */
    const char *path;
    t3r_whole_file beside; /* the new table, written next to the existing one; its stream is `table.file` */
} csv_file;

/* These report on stderr and return an exit status of cli.h. */

/* Opens a table. more: rows are appended to the existing ones. *is_new: the table has no row yet, and needs its
 * heading. `path` is kept by reference. */
int csv_file_open(csv_file *file, const char *path, bool more, bool *is_new);
/* Closes the table; no effect if none is open. keep: keep the rows, else restore a table that was there. */
int csv_file_close(csv_file *file, bool keep);

#endif
