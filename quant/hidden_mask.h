/* SPDX-License-Identifier: Apache-2.0 */
/* Makes a head ignore the pruning: a weight file in which two features of the mask are constants. */
#ifndef T3R_QUANT_HIDDEN_MASK_H
#define T3R_QUANT_HIDDEN_MASK_H

#include <stddef.h>
#include <stdint.h>

/* Returns a copy of the weight file, which t3r_weights_error() must accept, that behaves as if every pixel were
 * retained (feature 3: 127) at density 1 (feature 5: 64): no weight reads the two features, and the biases contain
 * their contributions. So the outputs equal the file's own on such features wherever no kernel reaches beyond the
 * picture; there the file itself reads 0, its copy the constants. The changed blocks follow the others, which may share
 * bytes.
 *
 * *count is its size; free() the bytes. Returns NULL without memory. The copy may be invalid only by its size, if the
 * file was near the largest: check it by t3r_weights_error(). */
uint8_t *hidden_mask_make(const uint8_t *file, size_t *count);

#endif
