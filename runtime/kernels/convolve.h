/* SPDX-License-Identifier: Apache-2.0 */
/* The innermost loops of a learned head: compute a layer for a block of pixels, with all outputs and their
 * requantization in one call (SPEC.md, "Learned head: arithmetic"). */
#ifndef T3R_KERNEL_CONVOLVE_H
#define T3R_KERNEL_CONVOLVE_H

#include <stddef.h>
#include <stdint.h>

#define T3R_BLOCK_PIXELS 4    /* maximum columns of a block */
#define T3R_LAYER_OUTPUTS 128 /* maximum outputs of a layer */
#define T3R_LAYER_RUNS 6      /* maximum runs of a layer's taps: the rows of its kernel */
#define T3R_COLUMN_TAPS 16    /* columns are padded with zeros to a multiple of this */

/* A layer as in the weight file: little-endian numbers that t3r_weights_check() has accepted. Weights are aligned to
 * 1 byte, 16-bit ones to 2.
 *
 * An output's sums of products and bias are below 2^31 with 8-bit activations, in any order and any part,
 * and below 2^47 with 16-bit ones. */
typedef struct t3r_convolution {
    const uint8_t *weights;    /* [output][tap]; in a depthwise layer [tap][output] */
    uint32_t readable;         /* bytes from `weights` on that may be read, including any after the weights */
    const uint8_t *bias;       /* one an output: int32; with 16-bit activations int64 */
    const uint8_t *multiplier; /* one an output: int32 of 2^30..2^31 - 1 */
    const uint8_t *shift;      /* one an output: int8 of -30..15 */
    uint32_t taps, outputs;    /* taps of an output: places of the kernel, times the inputs unless the layer is
                                * depthwise */
    int16_t zero;              /* added after requantization */
    uint8_t weight_bits, activation_bits, output_bits; /* 8 or 16 each; 8-bit outputs only with 8-bit activations */
} t3r_convolution;

/* A block of consecutive pixels, with the activations under each pixel's kernel: [tap], or [place][output] in
 * a depthwise layer. Pixel i has `rows` runs of `run` activations; run r begins at x + r x pitch + i x step.
 *
 * For convolve and depthwise they are columns: int16, one run a pixel, x and step aligned to 16 bytes. Zeros follow the
 * taps up to a multiple of T3R_COLUMN_TAPS. There are 1..T3R_BLOCK_PIXELS.
 *
 * For convolve_packed they are strips: any number of pixels, aligned to an activation, in the format that t3r_kernels
 * states. T3R_STRIP_BEHIND activations after the last run may be read, with any values. */
typedef struct t3r_block {
    const void *x;
    uint32_t rows, pitch, run, step; /* in activations */
    uint32_t pixels;
} t3r_block;
#define T3R_STRIP_BEHIND 4u

/* Writes out[pixel x out_pitch + output], int8 or int16 by output_bits, for the block's pixels and all outputs. */
typedef void t3r_convolve_kernel(const t3r_convolution *layer, const t3r_block *block, void *out, uint32_t out_pitch);
typedef void t3r_depthwise_kernel(const t3r_convolution *layer, const t3r_block *block, void *out, uint32_t out_pitch);

t3r_convolve_kernel t3r_convolve_c;
t3r_depthwise_kernel t3r_depthwise_c;

/* --- packed layers: for instruction sets that need weights in their own order ----------------------------------- */

#define T3R_PACKED_OUTPUTS 8u /* outputs come in groups of this size, the last one padded */
#define T3R_PACKED_TAPS 4u    /* likewise the taps of a run */
#define T3R_PACKED_ALIGN 64u
#define T3R_PACKED_SCALING_BYTES 24u /* for each output: the scaling of its sum, in the variant's own format */

/* Returns the bytes of a packed layer, which is aligned to T3R_PACKED_ALIGN. */
static inline size_t t3r_packed_bytes(uint32_t rows, uint32_t run, uint32_t outputs)
{
    const size_t whole_run = (run + T3R_PACKED_TAPS - 1) / T3R_PACKED_TAPS * T3R_PACKED_TAPS;
    const size_t whole = (outputs + T3R_PACKED_OUTPUTS - 1) / T3R_PACKED_OUTPUTS * T3R_PACKED_OUTPUTS;
    return (whole * (rows * whole_run + T3R_PACKED_SCALING_BYTES) + T3R_PACKED_ALIGN - 1) / T3R_PACKED_ALIGN *
           T3R_PACKED_ALIGN;
}

/* Packs a layer of 8-bit weights and activations that is not depthwise, in the order that the same table's
 * convolve_packed reads. Its taps are `rows` runs, at most T3R_LAYER_RUNS. */
typedef void t3r_pack_layer_kernel(const t3r_convolution *layer, uint32_t rows, void *packed);

/* Computes the layer on a block of strips from pack_layer's output. Reads only outputs, zero and output_bits of
 * `layer`. */
typedef void t3r_convolve_packed_kernel(const t3r_convolution *layer, const void *packed, const t3r_block *block,
                                        void *out, uint32_t out_pitch);

#endif
