/* SPDX-License-Identifier: Apache-2.0 */
/* Edit distance of two words, for "did you mean". */
#ifndef TRIM3R_TOOLS_EDIT_DISTANCE_H
#define TRIM3R_TOOLS_EDIT_DISTANCE_H

#include <stdint.h>

#define EDIT_DISTANCE_NEAR 2u /* largest distance of a suggested word */

/* Returns the number of letters to insert, delete or replace; UINT32_MAX if a word is longer than 63 bytes. */
uint32_t edit_distance(const char *a, const char *b);

#endif
