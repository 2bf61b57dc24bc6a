/* SPDX-License-Identifier: Apache-2.0 */
/* A small float head with every kind of layer, random but repeatable, ranges included. For tests and fuzzers. */
#ifndef T3R_TESTS_SAMPLE_HEAD_H
#define T3R_TESTS_SAMPLE_HEAD_H

#include <stddef.h>
#include <stdint.h>

#include "float_head.h"

/* Makes a head; free it with float_head_free(). */
void sample_head(float_head *head, uint64_t seed);

/* Returns a head as a .safetensors file, which the caller frees. */
uint8_t *sample_safetensors(const float_head *head, size_t *count);

#endif
