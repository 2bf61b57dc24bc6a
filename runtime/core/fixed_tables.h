/* The tables of logarithm and power of two, for code that looks up several numbers at once. */
#ifndef T3R_FIXED_TABLES_H
#define T3R_FIXED_TABLES_H

#include <stdint.h>

extern const uint32_t t3r_log2_table_q20[129]; /* log2(1 + i / 128), nearest */
extern const uint32_t t3r_exp2_table_q20[129]; /* 2^(i / 128), nearest */

#endif
