/* SPDX-License-Identifier: Apache-2.0 */
#include "weight_source.h"

#define COLUMNS 120

void weight_source_write(FILE *to, const char *name, const char *note, const uint8_t *bytes, size_t count)
{
    fprintf(to,
            "/* The head `%s` as a weight file (runtime/head/weights.h): %s. Written by trim3r quantize. */\n"
            "#include <stdint.h>\n"
            "\n"
            "extern const uint8_t t3r_head_%s[];\n"
            "extern const uint32_t t3r_head_%s_bytes;\n"
            "\n"
            "/* clang-format off */\n"
            "_Alignas(16) const uint8_t t3r_head_%s[] = {",
            name, note, name, name, name);
    for (size_t i = 0, column = COLUMNS; i < count; i++) {
        const size_t wide = bytes[i] < 10 ? 2 : bytes[i] < 100 ? 3 : 4;
        column = column + wide > COLUMNS ? 0 : column;
        fprintf(to, "%s%u,", column == 0 ? "\n" : "", (unsigned)bytes[i]);
        column += wide;
    }
    fprintf(to,
            "\n};\n"
            "/* clang-format on */\n"
            "const uint32_t t3r_head_%s_bytes = sizeof t3r_head_%s;\n",
            name, name);
}
