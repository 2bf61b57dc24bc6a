/* SPDX-License-Identifier: Apache-2.0 */
/* A method that makes a scene from a recording: trim3r's, and those that a program adds (tools/study has rivals). */
#ifndef TRIM3R_TOOLS_METHOD_H
#define TRIM3R_TOOLS_METHOD_H

#include <stdbool.h>
#include <stddef.h>

#include "reconstruction/reconstruction.h"

/* Data shared by a method's scenes of one context, made when first needed, because many budgets use it. All zero:
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
    bool refines;   /* it refines the head's Gaussians */
    /* Makes *made, to be closed, at the budget of `options`, and fills *account. An exit status of cli.h. */
    int (*build)(method_source *source, const t3r_recording *recording, const char *path,
                 const reconstruction_options *options, reconstruction *made, reconstruction_account *account);
} method;

/* reconstruction_build() */
extern const method method_trim3r;

#endif
