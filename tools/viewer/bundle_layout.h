/* SPDX-License-Identifier: Apache-2.0 */
/* The bundle: all input of a viewer's page, as bytes. bundle.c writes it, module/module.c reads it.
 *
 * Little-endian, in this order:
 *   u32    BUNDLE_MAGIC
 *   u32    words of the configuration, and as many u32: the fields of t3r_config in their order
 *   u32    context views, and frames: the context views come first
 *   u32    bytes of the head's weights; 0 = a head without weights
 *   u32    Gaussians of the scene
 *   i32    the exponent of that scene's frame, then 3 x i64: its origin
 *   u32    the degree of its harmonics, and 1 if its opacities are those of mip-splatting
 *   u32    how much finer its views are, and Gaussians far away: t3r_scene_file
 *   frames BUNDLE_FRAME_BYTES each: i32 fx, fy, cx, cy (Q16); 3 x i64 position (Q32); 4 x i32 rotation (Q30); u64 unit
 *          of depth (Q40), 0 = the frame has no depth; u32 1 = its picture does not reach all pixels
 *   then, each at the next multiple of BUNDLE_ALIGN from the start: the weights; for each frame RGB, 3 bytes a pixel,
 * if it has depth, 2 bytes a pixel, and if its picture does not reach all pixels, a byte a pixel, 0 = beyond the lens;
 * the Gaussians, BUNDLE_GAUSSIAN_BYTES each; those far away, BUNDLE_FAR_BYTES each; above degree 0 harmonics, i16 in
 * Q12. Frames have the working size. */
#ifndef TRIM3R_TOOLS_BUNDLE_LAYOUT_H
#define TRIM3R_TOOLS_BUNDLE_LAYOUT_H

#include "trim3r.h"

#define BUNDLE_MAGIC 0x33763374u /* "t3v3" */
#define BUNDLE_ALIGN 16u         /* alignment of weights */
#define BUNDLE_FRAME_BYTES 68u
/* Position, mantissas, exponent, view, colour, opacity, confidence, in the order of t3r_gaussian, without `reserved`.
 */
#define BUNDLE_GAUSSIAN_BYTES 41u
#define BUNDLE_FAR_BYTES 12u /* u32 index, then the bits of the double `times` */
#define BUNDLE_MOST_FRAMES 32u

_Static_assert(sizeof(t3r_config) % 4 == 0, "the configuration is words");
enum { BUNDLE_CONFIG_WORDS = sizeof(t3r_config) / 4 };

#endif
