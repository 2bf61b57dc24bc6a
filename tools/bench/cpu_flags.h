/* SPDX-License-Identifier: Apache-2.0 */
/* The system's report about the processor. */
#ifndef TRIM3R_TOOLS_CPU_FLAGS_H
#define TRIM3R_TOOLS_CPU_FLAGS_H

#define CPU_FLAGS_BYTES 1024

/* Gets its vector extensions as the system names them; "" if unknown. */
void cpu_flags(char flags[CPU_FLAGS_BYTES]);
/* Gets its name; "" if unknown. */
void cpu_name(char name[CPU_FLAGS_BYTES]);

#endif
