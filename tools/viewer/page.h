/* SPDX-License-Identifier: Apache-2.0 */
/* The page of `trim3r view`: one HTML file that contains the runtime as WebAssembly, a bundle, and the viewer. It
 * fetches nothing, unless it follows a growing map. */
#ifndef TRIM3R_TOOLS_VIEWER_PAGE_H
#define TRIM3R_TOOLS_VIEWER_PAGE_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

#include "viewer/bundle.h"

#define PAGE_NAME_BYTES 32

typedef struct viewer_page {
    const char *title;
    bundle data;                    /* its frames must have pictures */
    const bundle_frame *viewpoints; /* places to look from, at least one; the page starts at the first */
    char (*names)[PAGE_NAME_BYTES]; /* of the viewpoints */
    uint32_t viewpoint_count;
    const t3r_camera *path; /* where the recording's camera was */
    uint32_t path_count;
    uint32_t valid_points; /* of the context views; 0 = the page cannot build */
    uint32_t gaussians;    /* the initial budget */
    bool is_file;          /* the scene is that of a file; else the one that the page builds first */
    bool hashed;           /* `hash` is the hash of that build here */
    uint64_t hash;
    bool is_served; /* it has threads, which a page in a file may not have */
    bool follows;   /* the page asks its server for a growing map: follow.h */
} viewer_page;

/* Whether this program contains the module, which needs clang and wasm-ld at build time. */
bool viewer_page_is_built(void);

/* Writes the page. Returns 0, or -1 when memory is out; the caller must check `out` for write errors. */
int viewer_page_write(const viewer_page *page, FILE *out);

#endif
