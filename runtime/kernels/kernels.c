/* SPDX-License-Identifier: Apache-2.0 */
/* Chooses the variant of each kernel for a processor. */
#include "kernels.h"

#include "variants.h"

#define CHOOSE(entry, features, function)                                                                              \
    if ((cpu & (features)) == (features)) {                                                                            \
        table->entry = function;                                                                                       \
    }

void t3r_kernels_choose(t3r_kernels *table, uint32_t cpu)
{
    *table = t3r_kernels_c;
    (void)cpu;
    T3R_VARIANTS(CHOOSE)
    table->strip_bytes = T3R_STRIP_BYTES(cpu);
    table->features = cpu;
}

uint32_t t3r_kernels_features(void)
{
    /* All but one are 0. NOLINTNEXTLINE(misc-redundant-expression) */
    return T3R_X86_FEATURES | T3R_ARM_FEATURES | T3R_WASM_FEATURES;
}
