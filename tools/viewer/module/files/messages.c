/* SPDX-License-Identifier: Apache-2.0 */
/* The program's messages in a page: an error is the answer's text, a warning a remark. */
#include <stdarg.h>
#include <stdio.h>

#include "answer.h"
#include "cli/cli.h"

static char *kept;
static size_t kept_bytes;

int cli_error(int code, const char *format, ...)
{
    char text[sizeof answer.text];
    va_list values;
    va_start(values, format);
    vsnprintf(text, sizeof text, format, values);
    va_end(values);
    if (kept != NULL) {
        snprintf(kept, kept_bytes, "%s", text);
    } else if (code == CLI_OK) {
        answer_remark(text);
    } else {
        snprintf(answer.text, sizeof answer.text, "%s", text);
    }
    return code;
}

void cli_keep_errors(char *text, size_t bytes)
{
    kept = text;
    kept_bytes = bytes;
}

/* The page says that it reads a file, and how far is not known. */
void cli_progress(const char *what, uint32_t done, uint32_t total)
{
    (void)what;
    (void)done;
    (void)total;
}

void cli_progress_end(void)
{
}
