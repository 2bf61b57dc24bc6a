/* A table that long work writes a row at a time. Where no rows stand, each appears at once, so that work which is cut
 * off leaves what it made. A table that was there keeps its place until the new one is whole. */
#ifndef TRIM3R_TOOLS_CSV_FILE_H
#define TRIM3R_TOOLS_CSV_FILE_H

#include <stdbool.h>

#include "cli/tables/csv.h"
#include "cli/files/whole_file.h"

typedef struct csv_file {
    csv_table table; /* its `file` is NULL until a table is open */
    const char *path;
    whole_file beside; /* what is written beside a table that was there; its stream is `table.file` */
} csv_file;

/* These report on stderr and return an exit status of cli.h. */

/* more: rows are added to those that stand there. *is_new: the table has no row yet, and needs its heading. `path` is
 * kept by reference. */
int csv_file_open(csv_file *file, const char *path, bool more, bool *is_new);
/* keep: the rows are to stand, else a table that was there comes back. Nothing where none is open. */
int csv_file_close(csv_file *file, bool keep);

#endif
