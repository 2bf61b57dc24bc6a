/* SPDX-License-Identifier: Apache-2.0 */
#include "judge.h"

#include <stdio.h>

#include "guarded.h"
#include "host/cpu.h"

typedef struct trial {
    const t3r_kernels *kernels;
    kernel_check *check;
    uint64_t seed;
} trial;

static const char *run_trial(void *context)
{
    const trial *t = context;
    uint64_t seed = t->seed;
    guarded_begin(seed);
    const char *found = t->check(t->kernels, &seed);
    return found != NULL ? found : guarded_broken();
}

const char *judge_at(const t3r_kernels *kernels, const checked_entry *entry, uint64_t seed)
{
    trial t = {kernels, entry->check, seed};
    return run_trial(&t);
}

const char *judge(const t3r_kernels *kernels, const checked_entry *entry, judged_seeds seeds, uint64_t *seed)
{
    for (*seed = seeds.first; *seed - seeds.first < seeds.rounds; ++*seed) {
        trial t = {kernels, entry->check, *seed};
        const char *found = guarded_run(run_trial, &t);
        if (found != NULL) {
            return found;
        }
    }
    return NULL;
}

bool judge_named(const t3r_kernels *kernels, const checked_entry *entry, judged_seeds seeds, const char *name)
{
    uint64_t seed;
    const char *found = judge(kernels, entry, seeds, &seed);
    if (found != NULL) {
        fprintf(stderr, "%s, %s: %s (seed %llu)\n", entry->name, name, found, (unsigned long long)seed);
    }
    return found == NULL;
}

bool judge_variants(uint32_t processor, judged_seeds seeds, uint32_t *tested)
{
    bool fine = true;
    *tested = 0;
    for (const checked_variant *v = checked_variants; v->entry != NULL; v++) {
        if ((v->features & ~processor) == 0) {
            char name[64];
            t3r_kernels kernels;
            t3r_cpu_describe(v->features, name, sizeof name);
            t3r_kernels_choose(&kernels, v->features);
            fine &= judge_named(&kernels, checked_entry_named(v->entry), seeds, name);
            ++*tested;
        }
    }
    return fine;
}
