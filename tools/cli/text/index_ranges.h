/* SPDX-License-Identifier: Apache-2.0 */
/* Lists of numbers with ranges: "0,4-6,10:20:5". */
#ifndef TRIM3R_TOOLS_INDEX_RANGES_H
#define TRIM3R_TOOLS_INDEX_RANGES_H

#include <stdint.h>

/* Parses numbers and ranges separated by commas: "3"; "0-3", "0:3", the numbers from 0 to 3; "0:11:2", every second of
 * those from 0 to 11. Writes 1 to `most` of them in the order of the text. Returns NULL, or the reason why not. */
const char *index_ranges_parse(const char *text, uint32_t *values, uint32_t most, uint32_t *count);

#endif
