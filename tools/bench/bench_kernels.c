/* SPDX-License-Identifier: Apache-2.0 */
#include "bench/bench_kernels.h"

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/text/wrapped.h"
#include "host/cpu.h"
#include "kernels/variants.h"

_Static_assert(T3R_VARIANTS_COUNT <= BENCH_KERNELS_MOST, "the list holds every entry");

/* Returns the highest of the features, which names the variant; the others are its prerequisites. */
static uint32_t last_feature(uint32_t features)
{
    while ((features & (features - 1)) != 0) {
        features &= features - 1;
    }
    return features;
}

static uint32_t add(bench_kernel *list, uint32_t count, const char *entry, bool is_taken, uint32_t features)
{
    uint32_t at = 0;
    while (at < count && strcmp(list[at].entry, entry) != 0) {
        at++;
    }
    if (at == count) {
        list[count++] = (bench_kernel){entry, "c"};
    }
    if (is_taken) {
        t3r_cpu_describe(last_feature(features), list[at].set, sizeof list[at].set);
    }
    return count;
}

uint32_t bench_kernels_of(const t3r_kernels *kernels, bench_kernel list[BENCH_KERNELS_MOST])
{
    uint32_t count = 0;
    (void)kernels;
#define ADD(entry, features, function) count = add(list, count, #entry, kernels->entry == (function), features);
    T3R_VARIANTS(ADD)
    return count;
}

static void describe(const t3r_kernels *kernels, FILE *out)
{
    bench_kernel list[BENCH_KERNELS_MOST];
    const uint32_t count = bench_kernels_of(kernels, list);
    bool listed[BENCH_KERNELS_MOST] = {false};
    for (uint32_t i = 0; i < count; i++) {
        if (listed[i]) {
            continue;
        }
        fprintf(out, "%s%s:", i == 0 ? "" : "; ", list[i].set);
        for (uint32_t k = i; k < count; k++) {
            if (strcmp(list[k].set, list[i].set) == 0) {
                fprintf(out, " %s", list[k].entry);
                listed[k] = true;
            }
        }
    }
}

void bench_kernels_print(const t3r_kernels *kernels, uint32_t indent)
{
    char *text = NULL;
    size_t bytes;
    FILE *out = open_memstream(&text, &bytes);
    if (out != NULL) {
        describe(kernels, out);
        fclose(out);
    }
    wrapped_print(stdout, indent, "kernels", text != NULL ? text : "out of memory");
    free(text);
}

void bench_kernels_add_json(cJSON *root, const t3r_kernels *kernels)
{
    bench_kernel list[BENCH_KERNELS_MOST];
    const uint32_t count = bench_kernels_of(kernels, list);
    cJSON *object = cJSON_AddObjectToObject(root, "kernels");
    for (uint32_t i = 0; i < count; i++) {
        cJSON_AddStringToObject(object, list[i].entry, list[i].set);
    }
}
