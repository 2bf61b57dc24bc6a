/* The variants of all architectures in this build. */
#ifndef T3R_KERNEL_VARIANTS_H
#define T3R_KERNEL_VARIANTS_H

#include "core/fixed.h"

#include "arm/variants.h"
#include "wasm/variants.h"
#include "x86/variants.h"

/* X(entry, features, function). The rows of an architecture go from the narrowest instruction set to the widest; the
 * last one that the processor supports is used. */
#define T3R_VARIANTS(X) T3R_X86_VARIANTS(X) T3R_ARM_VARIANTS(X) T3R_WASM_VARIANTS(X)

/* One architecture uses bytes; the others have none of its kernels. */
#define T3R_STRIP_BYTES(cpu) T3R_MIN(T3R_X86_STRIP_BYTES(cpu), T3R_ARM_STRIP_BYTES(cpu))

/* Number of variants. Code that only variants use can be left out of a build without any. */
#define T3R_ONE_MORE_(entry, features, function) +1
enum { T3R_VARIANTS_COUNT = 0 T3R_VARIANTS(T3R_ONE_MORE_) };

#endif
