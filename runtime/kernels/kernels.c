/* Which variant of each kernel a processor gets. Rows of a room come from the narrowest instruction set to the widest:
 * the last one that the processor has stays. */
#include "kernels.h"

#include "arm/variants.h"
#include "wasm/variants.h"
#include "x86/variants.h"

#define CHOOSE(entry, features, function)                                                                              \
    if ((cpu & (features)) == (features)) {                                                                            \
        table->entry = function;                                                                                       \
    }

void t3r_kernels_choose(t3r_kernels *table, uint32_t cpu)
{
    *table = t3r_kernels_c;
    (void)cpu;
    T3R_X86_VARIANTS(CHOOSE)
    T3R_ARM_VARIANTS(CHOOSE)
    T3R_WASM_VARIANTS(CHOOSE)
}
