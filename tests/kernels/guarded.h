/* SPDX-License-Identifier: Apache-2.0 */
/* Buffers that show who reads or writes beyond them: each ends or begins at a page that nobody may touch, and what lies
 * beside it on its own pages is looked at afterwards. */
#ifndef T3R_TESTS_GUARDED_H
#define T3R_TESTS_GUARDED_H

#include <stddef.h>
#include <stdint.h>

/* Gives all buffers back. Where the next ones lie follows from the seed. */
void guarded_begin(uint64_t seed);

/* A buffer aligned to `align` and, as a rule, to no more: at the end of its pages or near their beginning. */
void *guarded_take(size_t bytes, size_t align);

/* What was written beside a buffer, as text; NULL: nothing. */
const char *guarded_broken(void);

/* Runs function(context) and returns what it returns, or a text when it touches a forbidden page. */
const char *guarded_run(const char *(*function)(void *context), void *context);

#endif
