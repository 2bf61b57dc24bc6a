/* SPDX-License-Identifier: Apache-2.0 */
#include "host/reason.h"

#ifdef T3R_HEIF

#include <dlfcn.h>
#include <pthread.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#include "pictures/heif_functions.h"

#define LIBRARY "libheif.so.1" /* of all versions 1.x */

static const struct row {
    const char *name;
    size_t at; /* of the function's address in the table */
} rows[] = {
#define HEIF_ROW(name) {"heif_" #name, offsetof(heif_functions, name)},
    HEIF_FUNCTIONS(HEIF_ROW)
#undef HEIF_ROW
};

static pthread_once_t loaded = PTHREAD_ONCE_INIT;
static heif_functions functions;
static bool complete;
static char missing[160];

static void load(void)
{
    void *library = dlopen(LIBRARY, RTLD_NOW | RTLD_LOCAL);
    complete = library != NULL;
    for (size_t i = 0; i < sizeof rows / sizeof *rows && complete; i++) {
        const void *function = dlsym(library, rows[i].name);
        complete = function != NULL;
        memcpy((char *)&functions + rows[i].at, &function, sizeof function);
    }
    if (!complete) {
        snprintf(missing, sizeof missing, "%s", dlerror());
    }
}

const heif_functions *heif_functions_load(char *error, size_t error_bytes)
{
    pthread_once(&loaded, load);
    if (!complete) {
        t3r_reason(error, error_bytes, "libheif does not load (%s); HEIC and AVIF need it (Debian: libheif1)", missing);
    }
    return complete ? &functions : NULL;
}

#endif
