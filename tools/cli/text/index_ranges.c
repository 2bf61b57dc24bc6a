/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/text/index_ranges.h"

#include <stdbool.h>
#include <stddef.h>

typedef struct range {
    uint32_t first, last, step;
} range;

/* Reads a decimal number at *text that fits 32 bits; *text moves past it. */
static bool read_number(const char **text, uint32_t *value)
{
    const char *p = *text;
    uint64_t x = 0;
    while (*p >= '0' && *p <= '9' && x <= UINT32_MAX) {
        x = x * 10 + (uint64_t)(*p++ - '0');
    }
    const bool read = p > *text && x <= UINT32_MAX;
    *value = (uint32_t)x;
    *text = p;
    return read;
}

/* Reads "A", "A-B", "A:B" or "A:B:STEP". */
static bool read_range(const char **text, range *r)
{
    if (!read_number(text, &r->first)) {
        return false;
    }
    *r = (range){r->first, r->first, 1};
    if (**text != '-' && **text != ':') {
        return true;
    }
    const bool stepped = *(*text)++ == ':';
    if (!read_number(text, &r->last)) {
        return false;
    }
    if (stepped && **text == ':') {
        ++*text;
        return read_number(text, &r->step);
    }
    return true;
}

const char *index_ranges_parse(const char *text, uint32_t *values, uint32_t most, uint32_t *count)
{
    uint32_t n = 0;
    for (;; text++) {
        range r;
        if (!read_range(&text, &r) || (*text != '\0' && *text != ',')) {
            return "takes numbers and ranges with commas between";
        }
        if (r.last < r.first) {
            return "has a range that ends before it begins";
        }
        if (r.step == 0) {
            return "has a range in steps of 0";
        }
        for (uint64_t at = r.first; at <= r.last; at += r.step) {
            if (n == most) {
                return "names too many";
            }
            values[n++] = (uint32_t)at;
        }
        if (*text == '\0') {
            *count = n;
            return NULL;
        }
    }
}
