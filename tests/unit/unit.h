/* SPDX-License-Identifier: Apache-2.0 */
/* Shared by the unit tests: cmocka's includes and repeatable noise. */
#ifndef T3R_TESTS_UNIT_H
#define T3R_TESTS_UNIT_H

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "noise.h"

/* Allocates exactly count x bytes, so that a sanitizer notices an access beyond. */
static inline void *unit_array(size_t count, size_t bytes)
{
    void *memory = calloc(count, bytes);
    assert_non_null(memory);
    return memory;
}

#endif
