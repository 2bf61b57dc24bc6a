/* Matrices as text files of numbers. */
#ifndef TRIM3R_TOOLS_MATRIX_TEXT_H
#define TRIM3R_TOOLS_MATRIX_TEXT_H

#include <stdint.h>

#define MATRIX_NUMBERS_MOST 16u

/* Parses numbers separated by blanks, commas or line ends, row by row. Infinities and NaN are allowed, since some
 * programs mark lost poses with them. Returns NULL, or what is wrong: another character, more than
 * MATRIX_NUMBERS_MOST. */
const char *matrix_text_parse(const char *text, double numbers[MATRIX_NUMBERS_MOST], uint32_t *count);

#endif
