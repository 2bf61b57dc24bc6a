/* SPDX-License-Identifier: Apache-2.0 */
/* Text in lines of at most 80 columns. */
#ifndef TRIM3R_TOOLS_WRAPPED_H
#define TRIM3R_TOOLS_WRAPPED_H

#include <stdint.h>
#include <stdio.h>

/* Prints a label and the words of a text after it; every line but the first begins with `indent` spaces. The label is
 * padded to them. Lines end before column 80; a longer word has a line of its own. */
void wrapped_print(FILE *out, uint32_t indent, const char *label, const char *text);
/* Prints a label and a formatted text on stdout, likewise. */
__attribute__((format(printf, 3, 4))) void wrapped_printf(uint32_t indent, const char *label, const char *format, ...);

#endif
