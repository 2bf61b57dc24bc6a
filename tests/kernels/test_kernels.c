/* SPDX-License-Identifier: Apache-2.0 */
/* Every entry of the table of kernels, in plain C and in each variant that this processor has: random and extreme
 * values, odd lengths, buffers next to inaccessible pages. A failure names the variant and its input's seed;
 * `test_kernels ENTRY SEED` repeats it. `test_kernels --rounds N FIRST` tries N seeds of each from FIRST on. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>

#include <cmocka.h>

#include "host/cpu.h"
#include "judge.h"
#include "kernels/variants.h"

static judged_seeds seeds = {.first = 1, .rounds = 400};

static void plain_c(void **state)
{
    (void)state;
    bool fine = true;
    for (size_t i = 0; i < checked_entries_count; i++) {
        fine &= judge_named(&t3r_kernels_c, &checked_entries[i], seeds, "plain C");
    }
    assert_true(fine);
}

static void variants(void **state)
{
    (void)state;
    uint32_t tested;
    const bool fine = judge_variants(t3r_cpu_features(), seeds, &tested);
    print_message("%u variants\n", tested);
    assert_true(fine);
}

/* Each feature chooses its row of the variants' lists, and without features none is chosen. */
static void masks_choose(void **state)
{
    (void)state;
    t3r_kernels none, one;
    t3r_kernels_choose(&none, 0);
    assert_memory_equal(&none, &t3r_kernels_c, sizeof none);
#define CHOSEN(entry, features, function)                                                                              \
    t3r_kernels_choose(&one, features);                                                                                \
    assert_true(one.entry == (function));                                                                              \
    assert_true(t3r_kernels_c.entry != (function));                                                                    \
    assert_true((one.pack_layer == NULL) == (one.convolve_packed == NULL));                                            \
    assert_true((one.nearest == t3r_nearest_c) == (one.nearest_begin == t3r_nearest_begin_c));
    T3R_VARIANTS(CHOSEN)
    (void)one;
}

static void wrong_ones_are_found(void **state)
{
    (void)state;
    wrong_variant wrong[WRONG_VARIANTS];
    make_wrong_variants(wrong);
    for (int i = 0; i < WRONG_VARIANTS; i++) {
        uint64_t seed;
        const char *found = judge(&wrong[i].kernels, checked_entry_named(wrong[i].entry), seeds, &seed);
        assert_non_null(found);
        print_message("%s: %s (seed %llu)\n", wrong[i].entry, found, (unsigned long long)seed);
    }
}

/* Runs one entry with one seed in all variants that the processor has, for a debugger. */
static int run_one(const char *name, const char *seed)
{
    t3r_kernels kernels;
    t3r_kernels_choose(&kernels, t3r_cpu_features());
    const checked_entry *entry = checked_entry_named(name);
    if (entry == NULL) {
        fprintf(stderr, "no entry %s\n", name);
        return 2;
    }
    const char *found = judge_at(&kernels, entry, strtoull(seed, NULL, 10));
    printf("%s, seed %s: %s\n", name, seed, found == NULL ? "fine" : found);
    return found != NULL;
}

int main(int argc, char **argv)
{
    const struct CMUnitTest long_tests[] = {cmocka_unit_test(plain_c), cmocka_unit_test(variants)};
    if (argc == 4 && strcmp(argv[1], "--rounds") == 0) {
        seeds = (judged_seeds){.first = strtoull(argv[3], NULL, 10), .rounds = strtoull(argv[2], NULL, 10)};
        return cmocka_run_group_tests_name("kernels, many rounds", long_tests, NULL, NULL);
    }
    const struct CMUnitTest tests[] = {cmocka_unit_test(plain_c), cmocka_unit_test(variants),
                                       cmocka_unit_test(masks_choose), cmocka_unit_test(wrong_ones_are_found)};
    return argc == 3 ? run_one(argv[1], argv[2]) : cmocka_run_group_tests_name("kernels", tests, NULL, NULL);
}
