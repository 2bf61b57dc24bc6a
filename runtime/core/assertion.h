/* SPDX-License-Identifier: Apache-2.0 */
/* Checks at which a debug build may stop: compile the runtime with these macros defined. */
#ifndef T3R_ASSERTION_H
#define T3R_ASSERTION_H

/* Checks how the library is called. */
#ifndef T3R_ASSERT
#define T3R_ASSERT(condition) ((void)0)
#endif

/* Checks the bounds that the library's arithmetic relies on. The option T3R_CHECK_FIXED stops at them; clang's static
 * analyzer takes them as given. */
#ifndef T3R_BOUND
#ifdef __clang_analyzer__
#define T3R_BOUND(condition) ((condition) ? (void)0 : __builtin_unreachable())
#else
#define T3R_BOUND(condition) ((void)0)
#endif
#endif

#endif
