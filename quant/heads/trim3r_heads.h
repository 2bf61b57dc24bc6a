/* The shipped heads: weight files (runtime/head/weights.h) as constants, each in its own source file, so that a
 * firmware contains only the heads that it names. */
#ifndef TRIM3R_HEADS_H
#define TRIM3R_HEADS_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Aligned to 16; can be bound in place, in flash. */
extern const uint8_t t3r_head_tiny[];  /* at most 400 multiply-accumulates a pixel, 4 KB */
extern const uint8_t t3r_head_small[]; /* 5 k, 48 KB */
extern const uint32_t t3r_head_tiny_bytes;
extern const uint32_t t3r_head_small_bytes;

#ifdef __cplusplus
}
#endif
#endif
