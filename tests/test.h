/* SPDX-License-Identifier: Apache-2.0 */
/* Programs of cmocka without a list of their tests: TEST(name) { ... } is one. They run in the order of the file. */
#ifndef T3R_TESTS_TEST_H
#define T3R_TESTS_TEST_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

enum { MOST_TESTS = 64, FIRST_PRIORITY = 1000 };

static struct CMUnitTest all_tests[MOST_TESTS]; /* cmocka passes over those without a name */
static size_t test_count;
static int (*before_all_tests)(void **state);
static int (*after_all_tests)(void **state);

#define TEST(test) TEST_WITH(test, NULL, NULL)

/* A test that one function prepares and another one cleans up after. */
#define TEST_WITH(test, before, after)                                                                                 \
    static void test(void **state);                                                                                    \
    __attribute__((constructor(FIRST_PRIORITY + __LINE__))) static void add_test_##test(void)                          \
    {                                                                                                                  \
        if (test_count == MOST_TESTS) {                                                                                \
            abort();                                                                                                   \
        }                                                                                                              \
        all_tests[test_count++] = (struct CMUnitTest){#test, test, before, after, NULL};                               \
    }                                                                                                                  \
    static void test(__attribute__((unused)) void **state)

/* The same for the program's tests together. */
#define ALL_TESTS_WITH(before, after)                                                                                  \
    __attribute__((constructor)) static void add_fixtures(void)                                                        \
    {                                                                                                                  \
        before_all_tests = before;                                                                                     \
        after_all_tests = after;                                                                                       \
    }

int main(void)
{
    return cmocka_run_group_tests(all_tests, before_all_tests, after_all_tests);
}

#endif
