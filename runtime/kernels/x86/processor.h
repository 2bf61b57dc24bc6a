/* SPDX-License-Identifier: Apache-2.0 */
/* The x86-64 processor that runs the kernels. */
#ifndef T3R_X86_PROCESSOR_H
#define T3R_X86_PROCESSOR_H

#include <stdint.h>

/* Returns the T3R_CPU_... features that the processor and its operating system have. */
uint32_t t3r_x86_features(void);

#endif
