/* The variants for WebAssembly: none so far. */
#ifndef T3R_WASM_VARIANTS_H
#define T3R_WASM_VARIANTS_H

/* X(entry, features, function), as x86/variants.h has it. */
#define T3R_WASM_VARIANTS(X)

#endif
