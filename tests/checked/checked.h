/* SPDX-License-Identifier: Apache-2.0 */
/* A violated bound of the runtime's arithmetic ends the program and prints its place. This is included before every
 * file, so it includes nothing and calls glibc's function for failed assertions. */
#ifndef T3R_CHECKED_H
#define T3R_CHECKED_H

extern void __assert_fail(const char *text, const char *file, unsigned line, const char *function)
    __attribute__((noreturn, nothrow));

#define T3R_BOUND(condition) ((condition) ? (void)0 : __assert_fail(#condition, __FILE__, __LINE__, __func__))

#endif
