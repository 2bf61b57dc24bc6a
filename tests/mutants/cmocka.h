/* SPDX-License-Identifier: Apache-2.0 */
/* cmocka for programs that end at the first failed expectation: compiled and run in a fraction of a second. With
 * T3R_TESTS_TAKEN_AWAY they run no test at all. */
#ifndef T3R_TESTS_MUTANTS_CMOCKA_H
#define T3R_TESTS_MUTANTS_CMOCKA_H

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#define assert_true(condition) ((condition) ? (void)0 : exit(1))
#define assert_false(condition) assert_true(!(condition))
#define assert_int_equal(a, b) assert_true((uintmax_t)(a) == (uintmax_t)(b))
#define assert_ptr_equal(a, b) assert_true((const void *)(a) == (const void *)(b))
#define assert_non_null(pointer) assert_true((pointer) != NULL)
#define assert_memory_equal(a, b, bytes) assert_true(memcmp(a, b, bytes) == 0)
#define fail_msg(...) exit(1)

struct CMUnitTest {
    const char *name;
    void (*test)(void **state);
    int (*before)(void **state), (*after)(void **state);
    void *state;
};

#ifdef T3R_TESTS_TAKEN_AWAY
#define cmocka_run_group_tests(tests, before, after) 0
#else
#define cmocka_run_group_tests(tests, before, after) run_tests(tests)

static inline int run_tests(const struct CMUnitTest *test)
{
    for (; test->name != NULL; test++) {
        test->test(NULL);
    }
    return 0;
}
#endif

#endif
