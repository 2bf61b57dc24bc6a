/* SPDX-License-Identifier: Apache-2.0 */
/* Tests of whole builds run plain C, which sanitizers slow down tenfold. Under sanitizers they use the processor's
 * vector kernels instead: the bits are the same, and tests/kernels checks both with sanitizers. */
#ifndef TRIM3R_TESTS_SANITIZED_CPU_H
#define TRIM3R_TESTS_SANITIZED_CPU_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "host/cpu.h"
#include "sanitized.h"
#include "trim3r.h"

/* Call after t3r_init() and after t3r_attach(), which both choose plain C. */
static inline void vectors_if_sanitized(t3r_runtime *rt)
{
#if T3R_SANITIZED && !defined T3R_COVERAGE /* coverage counts the branches of plain C */
    assert_int_equal(t3r_set_cpu(rt, t3r_cpu_features()), T3R_OK);
#else
    (void)rt;
#endif
}

#endif
