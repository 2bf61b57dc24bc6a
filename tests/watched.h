/* Plain C is what the tests of a whole build run, but sanitizers make it ten times as slow: with them the processor's
 * own vectors, whose bits are the same. tests/kernels compares these with plain C, with sanitizers, too. */
#ifndef TRIM3R_TESTS_WATCHED_H
#define TRIM3R_TESTS_WATCHED_H

#include "cpu.h"
#include "sanitized.h"
#include "trim3r.h"

/* After t3r_init() and t3r_attach(). */
static inline void quicker_where_watched(t3r_runtime *rt)
{
    assert_int_equal(t3r_set_cpu(rt, T3R_SANITIZED ? t3r_cpu_features() : 0), T3R_OK);
}

#endif
