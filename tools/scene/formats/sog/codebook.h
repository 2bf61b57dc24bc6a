/* Represents numbers by indices into 256 fitted values. */
#ifndef TRIM3R_TOOLS_CODEBOOK_H
#define TRIM3R_TOOLS_CODEBOOK_H

#include <stddef.h>
#include <stdint.h>

enum { CODEBOOK_VALUES = 256 };

/* Fits the values, ascending, by a fixed number of rounds of K-means; sorts `numbers`, of which there is at least
 * one. */
void codebook_make(double *numbers, size_t count, double values[CODEBOOK_VALUES]);
/* Returns the index of the nearest value. */
uint8_t codebook_index(const double values[CODEBOOK_VALUES], double number);

#endif
