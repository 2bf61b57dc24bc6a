#include "report.h"

#include <string.h>

#include "semihost.h"
#include "text_length.h"

enum { LINE_BYTES = 256, NUMBER_BYTES = 11 };

/* Writes the value as decimal digits into `text`. */
static const char *decimal(uint32_t value, char text[NUMBER_BYTES])
{
    char *at = text + NUMBER_BYTES - 1;
    *at = '\0';
    do {
        *--at = (char)('0' + value % 10);
        value /= 10;
    } while (value > 0);
    return at;
}

static void append(char *line, const char *text)
{
    const size_t used = text_length(line), count = text_length(text), room = LINE_BYTES - 1 - used;
    memcpy(line + used, text, count < room ? count : room);
    line[used + (count < room ? count : room)] = '\0';
}

void report_text(const char *a, const char *b, const char *c, const char *d)
{
    const char *const texts[] = {a, b, c, d};
    char line[LINE_BYTES] = "";
    for (size_t i = 0; i < sizeof texts / sizeof texts[0]; i++) {
        append(line, texts[i]);
    }
    line[LINE_BYTES - 2] = '\0';
    append(line, "\n");
    semihost_print(line);
}

void report_number(const char *name, uint32_t value)
{
    char text[NUMBER_BYTES];
    report_text(name, " ", decimal(value, text), "");
}

void report_hash(const char *name, uint64_t hash)
{
    char text[17];
    for (int i = 0; i < 16; i++) {
        text[i] = "0123456789abcdef"[hash >> (60 - 4 * i) & 15];
    }
    text[16] = '\0';
    report_text("hash ", name, " ", text);
}

_Noreturn void report_failure(const char *what, uint32_t value)
{
    char text[NUMBER_BYTES];
    report_text("error: ", what, " ", decimal(value, text));
    semihost_exit(1);
}

_Noreturn void report_refusal(const char *function, uint32_t value)
{
    char text[NUMBER_BYTES];
    report_text("error: ", function, "() returned minus ", decimal(value, text));
    semihost_exit(1);
}

const char *report_ppm_head(uint32_t width, uint32_t height)
{
    static char head[LINE_BYTES];
    char text[NUMBER_BYTES];
    head[0] = '\0';
    append(head, "P6 ");
    append(head, decimal(width, text));
    append(head, " ");
    append(head, decimal(height, text));
    append(head, " 255\n");
    return head;
}
