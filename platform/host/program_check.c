/* SPDX-License-Identifier: Apache-2.0 */
#include "program_check.h"

#include <stdio.h>

#include "reason.h"

#define TEXT_BYTES 160

/* Writes "0.2.0", or "0.2.0 without stereo, streams", which the other side has. */
static void describe(t3r_program one, t3r_program other, char text[TEXT_BYTES])
{
    static const struct {
        uint32_t bit;
        const char *name;
    } rows[] = {
#define ROW(FEATURE, name) {T3R_HAS_##FEATURE, #name},
        T3R_FEATURE_ROWS(ROW)
#undef ROW
    };
    const char *before = " without ";
    int length = snprintf(text, TEXT_BYTES, "%.32s", one.version);
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        if ((other.features & ~one.features & rows[i].bit) != 0) {
            length += snprintf(text + length, TEXT_BYTES - (size_t)length, "%s%s", before, rows[i].name);
            before = ", ";
        }
    }
}

bool t3r_program_fits(t3r_program program, t3r_program library, char *error, size_t error_bytes)
{
    char its[TEXT_BYTES], own[TEXT_BYTES];
    if (program.digest == library.digest) {
        return true;
    }
    describe(program, library, its);
    describe(library, program, own);
    t3r_reason(
        error, error_bytes,
        "the program was compiled with other headers than its library's: of trim3r %s, and the library is trim3r "
        "%s: compile it again",
        its, own);
    return false;
}
