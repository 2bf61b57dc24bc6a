/* SPDX-License-Identifier: Apache-2.0 */
/* The processor that runs the kernels. */
#ifndef T3R_KERNELS_PROCESSOR_H
#define T3R_KERNELS_PROCESSOR_H

#include <stdint.h>

/* Returns the T3R_CPU_... features that the processor can have. On x86-64 these are the features that the processor and
 * its operating system have; elsewhere those of the architecture, or of the core that a firmware is compiled for. */
uint32_t t3r_processor_features(void);

#endif
