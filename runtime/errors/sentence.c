/* SPDX-License-Identifier: Apache-2.0 */
#include "sentence.h"

#include <stdbool.h>

/* A text that is being written; `left` counts the bytes before its end. */
typedef struct pen {
    char *at;
    size_t left;
} pen;

static void put(pen *p, char c)
{
    if (p->left > 0) {
        *p->at++ = c;
        p->left--;
    }
}

static void put_number(pen *p, int64_t number, bool is_signed)
{
    const bool is_negative = is_signed && number < 0;
    uint64_t rest = is_negative ? 0 - (uint64_t)number : (uint64_t)number;
    char digits[20]; /* of 2^64 - 1 */
    size_t count = 0;
    do {
        digits[count++] = (char)('0' + rest % 10);
        rest /= 10;
    } while (rest > 0);
    if (is_negative) {
        put(p, '-');
    }
    while (count > 0) {
        put(p, digits[--count]);
    }
}

/* Writes a text with its numbers. Returns the number of the next one. */
static size_t put_text(pen *p, const char *text, const int64_t *number, size_t next)
{
    for (; *text != '\0'; text++) {
        if (*text == '#' || *text == '@') {
            put_number(p, number[next++], *text == '#');
        } else {
            put(p, *text);
        }
    }
    return next;
}

const char *t3r_sentence(t3r_status status, t3r_status found, const t3r_fault *fault, char *text, size_t bytes)
{
    if (text == NULL || bytes == 0) {
        return t3r_error_text(status);
    }
    pen p = {text, bytes - 1};
    if (status == found && status != T3R_OK) {
        const size_t next = put_text(&p, fault->text, fault->number, 0);
        if (fault->after != NULL) {
            (void)put_text(&p, fault->after, fault->number, next);
        }
    } else {
        for (const char *word = t3r_error_text(status); *word != '\0'; word++) {
            put(&p, *word);
        }
    }
    *p.at = '\0';
    return text;
}
