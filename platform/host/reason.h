/* SPDX-License-Identifier: Apache-2.0 */
/* All of platform/ reports errors through this function. */
#ifndef T3R_PLATFORM_REASON_H
#define T3R_PLATFORM_REASON_H

#include <stddef.h>

/* Writes the reason, cut to fit and cleaned (text.h), since it may hold names and lines from files; error may be NULL.
 * Always returns -1, for use as `return t3r_reason(...)`. */
int t3r_reason(char *error, size_t error_bytes, const char *format, ...) __attribute__((format(printf, 3, 4)));

#endif
