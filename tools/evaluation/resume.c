/* SPDX-License-Identifier: Apache-2.0 */
#include "evaluation/resume.h"

#include <errno.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "cli/cli.h"
#include "cli/tables/csv_read.h"
#include "evaluation/table.h"
#include "host/file_bytes.h"

#define TABLE_MOST ((size_t)32 << 20) /* bytes: a row of some fifty takes ten times as many */

static bool older(const struct timespec *a, const struct timespec *b)
{
    return a->tv_sec != b->tv_sec ? a->tv_sec < b->tv_sec : a->tv_nsec < b->tv_nsec;
}

/* Checks the age: rows are valid as long as neither this program nor the inputs changed. */
static int check_age(const char *path, char *const *inputs, uint32_t input_count, const char *pruned)
{
    struct stat table, other;
    if (stat(path, &table) != 0) {
        return cli_error(CLI_BAD_INPUT, "%s: %s", path, strerror(errno));
    }
    for (uint32_t i = 0; i <= input_count + (pruned != NULL); i++) {
        const char *name = i == 0 ? "/proc/self/exe" : i <= input_count ? inputs[i - 1] : pruned;
        if (stat(name, &other) == 0 && older(&table.st_mtim, &other.st_mtim)) {
            return cli_error(
                CLI_BAD_INPUT,
                "%s is older than %s: its rows may be out of date; remove it, or touch it to go on with it", path,
                i == 0 ? "this program" : name);
        }
    }
    return CLI_OK;
}

static int check_heading(const csv_reader *reader)
{
    bool same = reader->cell_count == EVALUATION_COLUMNS;
    for (uint32_t i = 0; same && i < EVALUATION_COLUMNS; i++) {
        same = strcmp(reader->cell[i], evaluation_column_name(i)) == 0;
    }
    return same ? CLI_OK
                : cli_error(CLI_BAD_INPUT, "%s:1: not the columns of this program's eval: it cannot be resumed",
                            reader->name);
}

static bool make_room(evaluation_resume *resume)
{
    if (resume->count < resume->room) {
        return true;
    }
    uint32_t room = resume->room == 0 ? 256 : resume->room * 2;
    evaluation_row *rows = realloc(resume->rows, room * sizeof *rows);
    resume->rows = rows != NULL ? rows : resume->rows;
    char **texts = rows != NULL ? realloc(resume->texts, room * sizeof *texts) : NULL;
    resume->texts = texts != NULL ? texts : resume->texts;
    resume->room = texts != NULL ? room : resume->room;
    return texts != NULL;
}

static int add_row(evaluation_resume *resume, const csv_reader *reader, bool with_picture)
{
    if (reader->cell_count != EVALUATION_COLUMNS) {
        return cli_error(CLI_BAD_INPUT, "%s:%" PRIu32 ": %" PRIu32 " cells, not %u", reader->name, reader->line,
                         reader->cell_count, EVALUATION_COLUMNS);
    }
    /* the cells are stored one after the other */
    const char *last = reader->cell[EVALUATION_COLUMNS - 1], *cells[EVALUATION_COLUMNS];
    size_t bytes = (size_t)(last - reader->row) + strlen(last) + 1;
    char *text = make_room(resume) ? malloc(bytes) : NULL;
    if (text == NULL) {
        return cli_error(CLI_BAD_INPUT, "out of memory");
    }
    memcpy(text, reader->row, bytes);
    for (uint32_t i = 0; i < EVALUATION_COLUMNS; i++) {
        cells[i] = text + (reader->cell[i] - reader->row);
    }
    evaluation_row *row = &resume->rows[resume->count];
    resume->texts[resume->count++] = text;
    if (!evaluation_row_read(row, cells)) {
        return cli_error(CLI_BAD_INPUT, "%s:%" PRIu32 ": not a row of eval", reader->name, reader->line);
    }
    if (row->value[EVALUATION_BITS_EPOCH] != T3R_BITS_EPOCH) {
        return cli_error(CLI_BAD_INPUT, "%s:%" PRIu32 ": a row of bits epoch %s, not %d: it cannot be resumed",
                         reader->name, reader->line, last, T3R_BITS_EPOCH);
    }
    if (with_picture && row->picture[0] == '\0') {
        return cli_error(CLI_BAD_INPUT, "%s:%" PRIu32 ": the row has no picture: it cannot be resumed with --images",
                         reader->name, reader->line);
    }
    return CLI_OK;
}

static int read_table(evaluation_resume *resume, const char *path, const char *text, size_t bytes, bool with_pictures)
{
    csv_reader reader;
    char error[512] = "";
    csv_reader_open(&reader, path, text, bytes);
    int got = csv_reader_next(&reader, error, sizeof error);
    int code = got == 1 ? check_heading(&reader) : CLI_OK;
    while (code == CLI_OK && got == 1 && (got = csv_reader_next(&reader, error, sizeof error)) == 1) {
        code = add_row(resume, &reader, with_pictures);
    }
    return got < 0 ? cli_error(CLI_BAD_INPUT, "%s", error) : code;
}

int evaluation_resume_open(evaluation_resume *resume, const char *path, char *const *inputs, uint32_t input_count,
                           const char *scene, bool with_pictures)
{
    *resume = (evaluation_resume){0};
    if (access(path, F_OK) != 0) {
        return CLI_OK;
    }
    int code = check_age(path, inputs, input_count, scene);
    if (code != CLI_OK) {
        return code;
    }
    size_t bytes;
    char error[512] = "";
    char *text = (char *)t3r_file_bytes(path, TABLE_MOST, &bytes, error, sizeof error);
    if (text == NULL) {
        return cli_error(CLI_BAD_INPUT, "%s", error);
    }
    size_t whole = bytes;
    while (whole > 0 && text[whole - 1] != '\n') {
        whole--;
    }
    code = read_table(resume, path, text, whole, with_pictures);
    free(text);
    if (code == CLI_OK && whole < bytes && truncate(path, (off_t)whole) != 0) {
        code = cli_error(CLI_BAD_INPUT, "%s: %s", path, strerror(errno));
    }
    return code;
}

const evaluation_row *evaluation_resume_find(evaluation_resume *resume, const evaluation_row *named)
{
    for (uint32_t i = 0; i < resume->count; i++) {
        uint32_t at = (resume->next + i) % resume->count;
        if (evaluation_same(&resume->rows[at], named)) {
            resume->next = at + 1;
            return &resume->rows[at];
        }
    }
    return NULL;
}

void evaluation_resume_close(evaluation_resume *resume)
{
    for (uint32_t i = 0; i < resume->count; i++) {
        free(resume->texts[i]);
    }
    free(resume->texts);
    free(resume->rows);
    *resume = (evaluation_resume){0};
}
