/* SPDX-License-Identifier: Apache-2.0 */
/* States the headers that a program was compiled with. The host library compares them with its own, as the runtime does
 * (trim3r_interface.h). */
#ifndef TRIM3R_PROGRAM_H
#define TRIM3R_PROGRAM_H

#include <stdint.h>

#include "trim3r.h"

/* No version changes this struct. */
typedef struct t3r_program {
    uint64_t digest;     /* of the structs of trim3r.h and of the header whose call takes it */
    uint32_t features;   /* T3R_HAS_... */
    const char *version; /* "major.minor.patch" */
} t3r_program;

static inline t3r_program t3r_program_of(uint64_t digest)
{
    t3r_program program;
    program.digest = digest;
    program.features = T3R_FEATURES_BUILT;
    program.version = T3R_VERSION;
    return program;
}

#endif
