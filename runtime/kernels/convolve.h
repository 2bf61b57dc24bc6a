/* The innermost loops of a learned head: a block of pixels through a layer, all outputs and their requantization in one
 * call (SPEC.md, "Learned head: arithmetic"). */
#ifndef T3R_KERNEL_CONVOLVE_H
#define T3R_KERNEL_CONVOLVE_H

#include <stddef.h>
#include <stdint.h>

#define T3R_BLOCK_PIXELS 4    /* most columns of a block */
#define T3R_LAYER_OUTPUTS 128 /* most outputs of a layer */
#define T3R_LAYER_RUNS 6      /* most runs of a layer's taps: the rows of its kernel */
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
 * x + r x pitch + i x step.
 *
 * For convolve and depthwise they are columns: int16, one run a pixel, x and step aligned to 16 bytes; behind the taps
 * stand zeros up to a multiple of T3R_COLUMN_TAPS. There are 1..T3R_BLOCK_PIXELS.
 *
 * For convolve_packed they are strips: any number of pixels, aligned to an activation, in the format that t3r_kernels
 * states. T3R_STRIP_BEHIND activations behind the last run may be read, whatever they are. */
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

/* --- packed layers: for instruction sets that want weights in an order of their own ------------------------------ */

#define T3R_PACKED_OUTPUTS 8u /* outputs come in groups of so many, the last one filled up */
#define T3R_PACKED_TAPS 4u    /* and so do the taps of a run */
#define T3R_PACKED_ALIGN 64u
#define T3R_PACKED_SCALING_BYTES 24u /* of an output: how its sum is scaled, as the variant wants it */

/* Bytes of a layer, to be aligned to T3R_PACKED_ALIGN. */
static inline size_t t3r_packed_bytes(uint32_t rows, uint32_t run, uint32_t outputs)
{
    const size_t whole_run = (run + T3R_PACKED_TAPS - 1) / T3R_PACKED_TAPS * T3R_PACKED_TAPS;
    const size_t whole = (outputs + T3R_PACKED_OUTPUTS - 1) / T3R_PACKED_OUTPUTS * T3R_PACKED_OUTPUTS;
    return (whole * (rows * whole_run + T3R_PACKED_SCALING_BYTES) + T3R_PACKED_ALIGN - 1) / T3R_PACKED_ALIGN *
           T3R_PACKED_ALIGN;
}

/* Brings a layer of 8-bit weights and activations that is not depthwise to the order in which convolve_packed of the
 * same table reads it. Its taps are `rows` runs, at most T3R_LAYER_RUNS. */
typedef void t3r_pack_layer_kernel(const t3r_convolution *layer, uint32_t rows, void *packed);

/* The layer at a block of its strips, out of what pack_layer wrote; of `layer` itself outputs, zero and output_bits
 * alone are read. */
typedef void t3r_convolve_packed_kernel(const t3r_convolution *layer, const void *packed, const t3r_block *block,
                                        void *out, uint32_t out_pitch);

#endif
