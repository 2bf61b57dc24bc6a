/* The page of `trim3r view`: one HTML file that holds the runtime as WebAssembly, a bundle, and what shows them. It
 * fetches nothing. */
#ifndef TRIM3R_TOOLS_VIEWER_PAGE_H
#define TRIM3R_TOOLS_VIEWER_PAGE_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

#include "viewer/bundle.h"

#define PAGE_NAME_BYTES 32

typedef struct viewer_page {
    const char *title;
    bundle data;                    /* its frames have pictures */
    const bundle_frame *viewpoints; /* where the page can look from, one at least; the first is the start */
    char (*names)[PAGE_NAME_BYTES]; /* of the viewpoints */
    uint32_t viewpoint_count;
    uint32_t valid_points; /* of the context views; 0 = the page cannot build */
    uint32_t gaussians;    /* the budget that it begins with */
    bool hashed;           /* `hash` is what that build has here */
    uint64_t hash;
} viewer_page;

/* Whether this program was built with the module, for which clang and wasm-ld were there. */
bool viewer_page_is_built(void);

/* 0, or -1 when memory is out; whether `out` took it all is the caller's to ask. */
int viewer_page_write(const viewer_page *page, FILE *out);

#endif
