/* Writes a weight file as a C source: `const uint8_t t3r_head_NAME[]`, aligned to 16, and `const uint32_t
 * t3r_head_NAME_bytes`. heads/trim3r_heads.h declares the shipped ones. */
#ifndef T3R_QUANT_WEIGHT_SOURCE_H
#define T3R_QUANT_WEIGHT_SOURCE_H

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

/* `note` says where the head comes from: one line, without an end of a comment. */
void weight_source_write(FILE *to, const char *name, const char *note, const uint8_t *bytes, size_t count);

#endif
