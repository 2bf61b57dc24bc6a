/* SPDX-License-Identifier: Apache-2.0 */
/* Scattering, eight pixels at a time. */
#include "kernels/x86/variants.h"

#ifdef T3R_X86

#include "lanes_sse41.h"

#include "kernels/lanes/vectors/pixels_of_eight.h"

#define SCATTER t3r_scatter_sse41
#define T3R_SCATTER T3R_SSE41
#define SCATTER_ADD(sum, a, b) add(sum, OF_LANES(madd_epi16)(a, b))
#include "kernels/lanes/scatter_pixels.h"

#else
typedef int t3r_no_scatter_sse41; /* a file may not be empty */
#endif
