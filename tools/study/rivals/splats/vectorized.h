/* SPDX-License-Identifier: Apache-2.0 */
/* Instruction sets for the float loops of the rivals, so that their times compare with those of trim3r's kernels. */
#ifndef TRIM3R_TOOLS_RIVALS_VECTORIZED_H
#define TRIM3R_TOOLS_RIVALS_VECTORIZED_H

/* clang has __has_feature, gcc the macros. */
#ifdef __has_feature
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer) || __has_feature(memory_sanitizer)
#define RIVAL_SANITIZED
#endif
#elif defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define RIVAL_SANITIZED
#endif

/* Before a function: the compiler makes variants of it for AVX2 and AVX-512, and the loader chooses the widest that the
 * processor has. Functions that it calls in a loop are RIVAL_INLINE, so that they are part of each variant. Sanitizers
 * do not work with functions that the loader chooses. */
#if defined(__x86_64__) && defined(__gnu_linux__) && !defined(RIVAL_SANITIZED)
#define RIVAL_VARIANTS __attribute__((target_clones("default", "arch=x86-64-v3", "arch=x86-64-v4")))
#else
#define RIVAL_VARIANTS
#endif
#define RIVAL_INLINE static inline __attribute__((always_inline))

#endif
