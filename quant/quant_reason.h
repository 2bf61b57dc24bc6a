/* The one way in which quant/ says what went wrong. */
#ifndef T3R_QUANT_REASON_H
#define T3R_QUANT_REASON_H

#include <stddef.h>

/* Writes the reason, cut to fit, '?' for what is not printable ASCII (names come from untrusted files); error may be
 * NULL. Always -1, so that `return quant_reason(...)` reads well. */
int quant_reason(char *error, size_t error_bytes, const char *format, ...) __attribute__((format(printf, 3, 4)));

#endif
