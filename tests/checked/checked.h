/* SPDX-License-Identifier: Apache-2.0 */
/* A bound of the runtime's arithmetic that does not hold ends the program and says where. Every file is compiled with
 * this first, so it includes nothing: glibc's own end of an assertion does. */
#ifndef T3R_CHECKED_H
#define T3R_CHECKED_H

extern void __assert_fail(const char *text, const char *file, unsigned line, const char *function)
    __attribute__((noreturn, nothrow));

#define T3R_BOUND(condition) ((condition) ? (void)0 : __assert_fail(#condition, __FILE__, __LINE__, __func__))

#endif
