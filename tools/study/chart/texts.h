/* SPDX-License-Identifier: Apache-2.0 */
/* Each text once, numbered from 0 in order of first appearance. */
#ifndef TRIM3R_TOOLS_CHART_TEXTS_H
#define TRIM3R_TOOLS_CHART_TEXTS_H

#include <stdint.h>

typedef struct chart_texts {
    char **text; /* `count` of them */
    uint32_t count, room;
    uint32_t *slot; /* open addressing: index + 1, 0 = free; a power of two of them, at most half in use */
    uint32_t slots;
} chart_texts; /* all zeros: none yet */

/* The text's number, added when it is new: 0, or -1 without memory or where too many collide. */
int chart_texts_number(chart_texts *texts, const char *text, uint32_t *number);
void chart_texts_free(chart_texts *texts);

#endif
