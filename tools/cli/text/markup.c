/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/text/markup.h"

void markup_text(FILE *out, const char *text)
{
    for (const char *p = text; *p != '\0'; p++) {
        switch (*p) {
        case '&':
            fputs("&amp;", out);
            break;
        case '<':
            fputs("&lt;", out);
            break;
        case '>':
            fputs("&gt;", out);
            break;
        case '"':
            fputs("&quot;", out);
            break;
        case '\'':
            fputs("&#39;", out);
            break;
        default:
            fputc(*p, out);
        }
    }
}

void markup_base64(FILE *out, const uint8_t *bytes, size_t count)
{
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (size_t i = 0; i < count; i += 3) {
        uint32_t b1 = i + 1 < count ? bytes[i + 1] : 0, b2 = i + 2 < count ? bytes[i + 2] : 0;
        uint32_t word = (uint32_t)bytes[i] << 16 | b1 << 8 | b2;
        char text[4] = {digits[word >> 18], digits[word >> 12 & 63], '=', '='};
        if (i + 1 < count) {
            text[2] = digits[word >> 6 & 63];
        }
        if (i + 2 < count) {
            text[3] = digits[word & 63];
        }
        fwrite(text, 1, sizeof text, out);
    }
}
