/* SPDX-License-Identifier: Apache-2.0 */
#include "study/chart/texts.h"

#include <stdlib.h>
#include <string.h>

#define FIRST_SLOTS 64u
#define PROBES_MOST 160u /* with half of the slots free, a million random texts need at most 80 */

/* FNV-1a. Texts can be made to collide, hence the bound on probes. */
static uint32_t hash_of(const char *text)
{
    uint32_t hash = 2166136261u;
    for (const char *p = text; *p != '\0'; p++) {
        hash = (hash ^ (unsigned char)*p) * 16777619u;
    }
    return hash;
}

/* Returns the slot that holds the text or would hold it; NULL after PROBES_MOST other texts. */
static uint32_t *find(const chart_texts *texts, const char *text)
{
    uint32_t mask = texts->slots - 1, i = hash_of(text) & mask, probes = 0;
    while (texts->slot[i] != 0 && strcmp(texts->text[texts->slot[i] - 1], text) != 0) {
        if (++probes > PROBES_MOST) {
            return NULL;
        }
        i = (i + 1) & mask;
    }
    return &texts->slot[i];
}

static int grow(chart_texts *texts)
{
    uint32_t slots = texts->slots == 0 ? FIRST_SLOTS : texts->slots * 2;
    uint32_t *slot = calloc(slots, sizeof *slot);
    char **text = realloc(texts->text, slots / 2 * sizeof *text);
    if (text != NULL) {
        texts->text = text;
    }
    if (slot == NULL || text == NULL) {
        free(slot);
        return -1;
    }
    free(texts->slot);
    texts->slot = slot;
    texts->slots = slots;
    texts->room = slots / 2;
    for (uint32_t i = 0; i < texts->count; i++) {
        uint32_t *place = find(texts, texts->text[i]);
        if (place == NULL) {
            return -1;
        }
        *place = i + 1;
    }
    return 0;
}

int chart_texts_number(chart_texts *texts, const char *text, uint32_t *number)
{
    if (texts->count == texts->room && grow(texts) != 0) {
        return -1;
    }
    uint32_t *slot = find(texts, text);
    if (slot == NULL) {
        return -1;
    }
    if (*slot == 0) {
        char *own = strdup(text);
        if (own == NULL) {
            return -1;
        }
        texts->text[texts->count++] = own;
        *slot = texts->count;
    }
    *number = *slot - 1;
    return 0;
}

void chart_texts_free(chart_texts *texts)
{
    for (uint32_t i = 0; i < texts->count; i++) {
        free(texts->text[i]);
    }
    free(texts->text);
    free(texts->slot);
    *texts = (chart_texts){0};
}
