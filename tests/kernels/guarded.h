/* SPDX-License-Identifier: Apache-2.0 */
/* Buffers that detect accesses outside them: each ends or begins at an inaccessible page, and the neighbouring bytes
 * on its own pages are checked afterwards. */
#ifndef T3R_TESTS_GUARDED_H
#define T3R_TESTS_GUARDED_H

#include <stddef.h>
#include <stdint.h>

/* Frees all buffers. The seed decides where the next ones are placed. */
void guarded_begin(uint64_t seed);

/* Returns a buffer aligned to `align` and usually to no more: at the end of its pages or near their beginning. */
void *guarded_take(size_t bytes, size_t align);

/* Returns what was written next to a buffer, as text; NULL: nothing. */
const char *guarded_broken(void);

/* Runs function(context) and returns its result, or a text if it touches a forbidden page. */
const char *guarded_run(const char *(*function)(void *context), void *context);

#endif
