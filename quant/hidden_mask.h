/* A head that does not see what was pruned: its weight file with two features of the mask taken for constants. */
#ifndef T3R_QUANT_HIDDEN_MASK_H
#define T3R_QUANT_HIDDEN_MASK_H

#include <stddef.h>
#include <stdint.h>

/* A copy of the weight file, which t3r_weights_error() passes, for which every pixel is retained (feature 3: 127) at
 * density 1 (feature 5: 64): no weight reads the two, and what they would add to each sum stands in the biases. So its
 * outputs are those of the file itself on such features wherever no kernel reaches beyond the picture; there the file
 * itself reads 0, its copy the constants. The changed blocks follow the others, which may share bytes.
 *
 * *count its bytes; free() them. NULL without memory. Sound again but for its size, if the file was near the largest:
 * t3r_weights_error() tells. */
uint8_t *hidden_mask_make(const uint8_t *file, size_t *count);

#endif
