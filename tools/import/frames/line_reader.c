/* SPDX-License-Identifier: Apache-2.0 */
#include "import/frames/line_reader.h"

#include <string.h>

#include "host/text.h"
#include "mcap/reader_limits.h"

bool line_reader_at_limit(const line_reader *reader)
{
    return reader->bytes >= T3R_LIMIT_MODEL_BYTES;
}

bool line_reader_next(line_reader *r)
{
    uint32_t length = 0;
    int c = EOF;
    r->longer = false;
    while (!line_reader_at_limit(r) && (c = getc_unlocked(r->file)) != EOF) {
        r->bytes++;
        if (c == '\n') {
            break;
        }
        if (c == '\0' || length == LINE_READER_BYTES - 1) {
            r->longer = true;
        } else {
            r->line[length++] = (char)c;
        }
    }
    r->line[length] = '\0';
    if (r->number == 0) {
        const size_t mark = t3r_text_mark(t3r_text_of(r->line));
        memmove(r->line, r->line + mark, length + 1 - mark);
    }
    r->number++;
    return !line_reader_at_limit(r) && (c == '\n' || length > 0 || r->longer);
}
