/* The innermost loops of a learned head: a block of pixels through a layer, all outputs and their requantization in one
 * call (SPEC.md, "Learned head: arithmetic"). */
#ifndef T3R_KERNEL_CONVOLVE_H
#define T3R_KERNEL_CONVOLVE_H

#include <stdint.h>

#define T3R_BLOCK_PIXELS 4    /* most columns of a block of 16-bit activations; of 8-bit ones twice as many */
#define T3R_LAYER_OUTPUTS 128 /* most outputs of a layer */
#define T3R_COLUMN_TAPS 16    /* a column goes on with zeros up to a multiple of so many activations */

/* A layer as the weight file has it: little-endian numbers, which t3r_weights_check() passed. Weights are aligned to
 * 1 byte, 2 where they have 16 bits.
 *
 * With 8-bit activations the sums of an output's products and its bias are below 2^31, in any order and in any part,
 * with 16-bit ones below 2^47. */
typedef struct t3r_convolution {
    const uint8_t *weights;    /* [output][tap]; of a depthwise layer [tap][output] */
    uint32_t readable;         /* bytes from `weights` on that may be read, be they weights or not */
    const uint8_t *bias;       /* of an output: int32; with 16-bit activations int64 */
    const uint8_t *multiplier; /* of an output: int32 of 2^30..2^31 - 1 */
    const uint8_t *shift;      /* of an output: int8 of -30..15 */
    uint32_t taps, outputs;    /* taps of an output: of a depthwise layer the kernel's places, else these x inputs */
    int16_t zero;              /* added to what is requantized */
    uint8_t weight_bits, activation_bits, output_bits; /* 8 or 16 each; 8-bit outputs only of 8-bit activations */
} t3r_convolution;

/* A block of pixels that follow each other, and the activations under the kernel of each: [tap], or [place][output] of
 * a depthwise layer. Those of pixel i are `rows` runs of `run` activations, one behind the other: run r begins at
 * row[r] + first + i x step. They come in one of two ways.
 *
 * As columns: gathered, one run a pixel, aligned to 16 bytes as is the step; behind the taps stand zeros up to a
 * multiple of T3R_COLUMN_TAPS. There are at most T3R_BLOCK_PIXELS, or twice that where activations are of 8 bits.
 *
 * As rows: where they lie, any number of pixels, not aligned, in runs of at least T3R_COLUMN_TAPS activations. Nothing
 * beyond the runs may be read. So come 8-bit activations alone, and only where t3r_kernels wants those in 8 bits.
 *
 * An activation is int8 or int16, as t3r_kernels says of 8-bit activations; 16-bit ones are int16. */
typedef struct t3r_block {
    const uint8_t *const *row;
    uint32_t first, rows, run, step; /* in activations */
    uint32_t pixels;
} t3r_block;

/* Writes out[pixel x out_pitch + output], int8 or int16 by output_bits, for the block's pixels and all outputs. */
typedef void t3r_convolve_kernel(const t3r_convolution *layer, const t3r_block *block, void *out, uint32_t out_pitch);
typedef void t3r_depthwise_kernel(const t3r_convolution *layer, const t3r_block *block, void *out, uint32_t out_pitch);

t3r_convolve_kernel t3r_convolve_c;
t3r_depthwise_kernel t3r_depthwise_c;

#endif
