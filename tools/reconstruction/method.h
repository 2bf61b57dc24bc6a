/* SPDX-License-Identifier: Apache-2.0 */
/* A way to make a scene of a recording: ours, and those that a program adds to it (tools/study has rivals). */
#ifndef TRIM3R_TOOLS_METHOD_H
#define TRIM3R_TOOLS_METHOD_H

#include <stdbool.h>
#include <stddef.h>

#include "reconstruction/reconstruction.h"

/* What a method's scenes of one context have in common, made when first needed: many budgets share it. All zero:
 * nothing is made. Context, settings and recording must not change until it is closed. */
typedef struct method_source {
    void *made;
    void (*close)(void *made);
} method_source;

static inline void method_source_close(method_source *source)
{
    if (source->made != NULL) {
        source->close(source->made);
    }
    *source = (method_source){0};
}

typedef struct method {
    const char *name;
    bool allocates; /* it chooses points by the settings' allocation */
    bool refines;   /* it refines what the head makes of them */
    /* Makes *made, to be closed, at the budget of `options`, and fills *account. An exit status of cli.h. */
    int (*build)(method_source *source, const t3r_recording *recording, const char *path,
                 const reconstruction_options *options, reconstruction *made, reconstruction_account *account);
} method;

/* reconstruction_build() */
extern const method method_trim3r;

#endif
