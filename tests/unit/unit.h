/* SPDX-License-Identifier: Apache-2.0 */
/* Shared by the unit tests: their main() and repeatable noise. */
#ifndef T3R_TESTS_UNIT_H
#define T3R_TESTS_UNIT_H

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "noise.h"
#include "test.h"

/* Allocates exactly count x bytes, so that a sanitizer notices an access beyond. */
static inline void *unit_array(size_t count, size_t bytes)
{
    void *memory = calloc(count, bytes);
    assert_non_null(memory);
    return memory;
}

#endif
