/* The one way in which platform/ says what went wrong. */
#ifndef T3R_PLATFORM_REASON_H
#define T3R_PLATFORM_REASON_H

#include <stddef.h>

/* Writes the reason, cut to fit and cleaned (text.h), since names and lines from files stand in it; error may be NULL.
 * Always -1, so that `return t3r_reason(...)` reads well. */
int t3r_reason(char *error, size_t error_bytes, const char *format, ...) __attribute__((format(printf, 3, 4)));

#endif
