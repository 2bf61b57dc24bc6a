/* SPDX-License-Identifier: Apache-2.0 */
/* Compares a program with its library. */
#ifndef T3R_PLATFORM_PROGRAM_CHECK_H
#define T3R_PLATFORM_PROGRAM_CHECK_H

#include <stdbool.h>
#include <stddef.h>

#include "trim3r_program.h"

/* Whether the program was compiled with the headers and the features of this library; else error[] has both versions,
 * and the features that only one of them has. */
bool t3r_program_fits(t3r_program program, t3r_program library, char *error, size_t error_bytes);

#endif
