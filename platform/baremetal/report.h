/* Messages of the firmware: lines of text without a C library's printf. */
#ifndef T3R_BAREMETAL_REPORT_H
#define T3R_BAREMETAL_REPORT_H

#include <stdint.h>

/* Prints the four texts in a row as a line. */
void report_text(const char *a, const char *b, const char *c, const char *d);
/* Prints "name 123". */
void report_number(const char *name, uint32_t value);
/* Prints "hash name 0123456789abcdef". */
void report_hash(const char *name, uint64_t hash);
/* Prints "error: what 123" and ends the program. */
_Noreturn void report_failure(const char *what, uint32_t value);
/* Prints "error: function() returned minus 123" and ends the program. */
_Noreturn void report_refusal(const char *function, uint32_t value);
/* Returns the head of a PPM of this size: "P6 64 64 255" and a line end. Valid until the next call. */
const char *report_ppm_head(uint32_t width, uint32_t height);

#endif
