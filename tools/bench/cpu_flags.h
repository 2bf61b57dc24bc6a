/* What the system says of the processor. */
#ifndef TRIM3R_TOOLS_CPU_FLAGS_H
#define TRIM3R_TOOLS_CPU_FLAGS_H

#define CPU_FLAGS_BYTES 1024

/* Its vector extensions, as the system names them; "" where it names none. */
void cpu_flags(char flags[CPU_FLAGS_BYTES]);
/* Its name; "" where it has none. */
void cpu_name(char name[CPU_FLAGS_BYTES]);

#endif
