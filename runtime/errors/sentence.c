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

static void put_word(pen *p, const char *word)
{
    for (; *word != '\0'; word++) {
        put(p, *word);
    }
}

/* Writes the switches of a set of T3R_HAS_... bits as this library has them. */
static void put_switches(pen *p, uint64_t set)
{
#define SWITCH(FEATURE, name) "T3R_FEATURE_" #FEATURE "=" T3R_TEXT_(T3R_FEATURE_##FEATURE),
    static const char *const switches[] = {T3R_FEATURE_ROWS(SWITCH)};
    const char *before = "";
    for (size_t bit = 0; bit < sizeof switches / sizeof switches[0]; bit++) {
        if ((set >> bit & 1) != 0) {
            put_word(p, before);
            put_word(p, switches[bit]);
            before = ", ";
        }
    }
}

/* Writes a text with its numbers. Returns the number of the next one. */
static size_t put_text(pen *p, const char *text, const int64_t *number, size_t next)
{
    for (; *text != '\0'; text++) {
        if (*text == '#' || *text == '@') {
            put_number(p, number[next++], *text == '#');
        } else if (*text == '%') {
            put_switches(p, (uint64_t)number[next++]);
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
        put_word(&p, t3r_error_text(status));
    }
    *p.at = '\0';
    return text;
}
