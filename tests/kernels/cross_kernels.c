/* SPDX-License-Identifier: Apache-2.0 */
/* Tests every variant that an emulated processor has against plain C: `cross_kernels ROUNDS` tries that many seeds
 * of each. It needs no library, so that any cross compiler can build it. Exit 0: the same bits. */
#include <stdio.h>

#include "host/cpu.h"
#include "judge.h"

/* A wrong variant is found within this many rounds. */
enum { ROUNDS_FOR_WRONG = 400 };

/* With this seed refinement multiplies -2^15 by itself, which saturates in instructions that double a product. */
enum { SEED_OF_LEAST_SQUARED = 496 };

static bool finds_wrong_ones(void)
{
    wrong_variant wrong[WRONG_VARIANTS];
    make_wrong_variants(wrong);
    for (int i = 0; i < WRONG_VARIANTS; i++) {
        uint64_t seed;
        const judged_seeds seeds = {.first = 1, .rounds = ROUNDS_FOR_WRONG};
        if (judge(&wrong[i].kernels, checked_entry_named(wrong[i].entry), seeds, &seed) == NULL) {
            fprintf(stderr, "blind: a wrong %s was not noticed\n", wrong[i].entry);
            return false;
        }
    }
    return true;
}

int main(int argc, char **argv)
{
    if (argc != 2) {
        fprintf(stderr, "usage: cross_kernels ROUNDS\n");
        return 2;
    }
    char has[64];
    uint32_t tested;
    const judged_seeds seeds = {.first = 1, .rounds = strtoull(argv[1], NULL, 10)};
    const judged_seeds edge = {.first = SEED_OF_LEAST_SQUARED, .rounds = 1};
    const bool fine = finds_wrong_ones() && judge_variants(t3r_cpu_features(), edge, &tested) &&
                      judge_variants(t3r_cpu_features(), seeds, &tested);
    if (fine) {
        t3r_cpu_describe(t3r_cpu_features(), has, sizeof has);
        printf("%u variants of %s have the bits of plain C\n", tested, has);
    }
    return fine && tested > 0 ? 0 : 1;
}
