/* SPDX-License-Identifier: Apache-2.0 */
/* Any text as the table that eval --resume continues: an error, or rows. */
#define _GNU_SOURCE /* memfd_create() */
#include <math.h>
#include <string.h>

#include "cli/cli.h"
#include "evaluation/resume.h"
#include "evaluation/table.h"
#include "fuzz/memory_file.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/* Returns the heading of this program's tables, followed by the bytes. */
static uint8_t *with_heading(const uint8_t *data, size_t size, size_t *count)
{
    size_t room = 1;
    for (uint32_t i = 0; i < EVALUATION_COLUMNS; i++) {
        room += strlen(evaluation_column_name(i)) + 1;
    }
    char *text = malloc(room + size);
    size_t used = 0;
    for (uint32_t i = 0; i < EVALUATION_COLUMNS; i++) {
        used +=
            (size_t)sprintf(text + used, "%s%c", evaluation_column_name(i), i + 1 < EVALUATION_COLUMNS ? ',' : '\n');
    }
    memcpy(text + used, data, size);
    *count = used + size;
    return (uint8_t *)text;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char path[MEMORY_FILE_PATH_BYTES], error[512] = "";
    size_t count;
    uint8_t *text = with_heading(data, size, &count);
    int descriptor = memory_file(text, count, path);
    evaluation_resume resume;
    cli_keep_errors(error, sizeof error);
    int code = evaluation_resume_open(&resume, path, NULL, 0, NULL, false);
    if ((code != CLI_OK) != (error[0] != '\0')) {
        abort();
    }
    for (uint32_t i = 0; code == CLI_OK && i < resume.count; i++) {
        /* a row without a budget equals no other, not even itself */
        if (evaluation_resume_find(&resume, &resume.rows[i]) == NULL && !isnan(resume.rows[i].value[EVALUATION_KEEP])) {
            abort();
        }
    }
    evaluation_resume_close(&resume);
    close(descriptor);
    free(text);
    return 0;
}
