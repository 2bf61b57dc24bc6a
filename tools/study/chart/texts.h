/* SPDX-License-Identifier: Apache-2.0 */
/* Each text once, numbered from 0 in order of first appearance. */
#ifndef TRIM3R_TOOLS_CHART_TEXTS_H
#define TRIM3R_TOOLS_CHART_TEXTS_H

#include <stdint.h>

typedef struct chart_texts {
    char **text; /* `count` texts */
    uint32_t count, room;
    uint32_t *slot; /* open addressing: index + 1, 0 = free; the size is a power of two, at most half is in use */
    uint32_t slots;
} chart_texts; /* all zeros: none yet */

/* Finds the text's number; adds the text if it is new. Returns 0, or -1 if out of memory or if too many texts
 * collide. */
int chart_texts_number(chart_texts *texts, const char *text, uint32_t *number);
void chart_texts_free(chart_texts *texts);

#endif
