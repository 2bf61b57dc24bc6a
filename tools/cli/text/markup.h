/* SPDX-License-Identifier: Apache-2.0 */
/* Common parts of writing SVG and HTML. */
#ifndef TRIM3R_TOOLS_MARKUP_H
#define TRIM3R_TOOLS_MARKUP_H

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

/* Writes a text as content or as an attribute's value in either kind of quotes. */
void markup_text(FILE *out, const char *text);
void markup_base64(FILE *out, const uint8_t *bytes, size_t count);

#endif
