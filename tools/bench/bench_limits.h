/* Upper limits of the machine, measured next to the stages: multiply-adds of 8-bit numbers, and copying. */
#ifndef TRIM3R_TOOLS_BENCH_LIMITS_H
#define TRIM3R_TOOLS_BENCH_LIMITS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define BENCH_MULTIPLY_ADDS 400000000.0
#define BENCH_COPY_BYTES ((size_t)64 << 20)

/* Executes about that many multiply-adds of 8-bit numbers into 32-bit sums, all in registers, by the widest instruction
 * of these features (T3R_CPU_...). Returns the exact number. */
double bench_multiply_adds(uint32_t cpu);

/* Copies BENCH_COPY_BYTES, more than caches hold. */
void bench_copy(uint8_t *restrict to, const uint8_t *restrict from);

#endif
