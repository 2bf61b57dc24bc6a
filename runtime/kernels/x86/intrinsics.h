/* SPDX-License-Identifier: Apache-2.0 */
/* The processor's vector instructions, without a header of the C library. */
#ifndef T3R_KERNELS_X86_INTRINSICS_H
#define T3R_KERNELS_X86_INTRINSICS_H

#define _MM_MALLOC_H_INCLUDED /* gcc's header would include stdlib.h for an allocator that is not used here */
#include <immintrin.h>

#include "kernels/lanes/vectors/inline.h"

#endif
