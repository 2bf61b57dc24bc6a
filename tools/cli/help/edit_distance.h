/* How far two words are apart, for "did you mean". */
#ifndef TRIM3R_TOOLS_EDIT_DISTANCE_H
#define TRIM3R_TOOLS_EDIT_DISTANCE_H

#include <stdint.h>

#define EDIT_DISTANCE_NEAR 2u /* of a word that may be meant */

/* Letters to insert, delete or replace; UINT32_MAX where a word is longer than 63 bytes. */
uint32_t edit_distance(const char *a, const char *b);

#endif
