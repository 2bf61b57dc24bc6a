/* SPDX-License-Identifier: Apache-2.0 */
/* All of quant/ reports errors through this function. */
#ifndef T3R_QUANT_REASON_H
#define T3R_QUANT_REASON_H

#include <stddef.h>

/* Writes the reason, cut to fit, with '?' for what is not printable ASCII (names come from untrusted files); error may
 * be NULL. Always returns -1, for use as `return quant_reason(...)`. */
int quant_reason(char *error, size_t error_bytes, const char *format, ...) __attribute__((format(printf, 3, 4)));

#endif
