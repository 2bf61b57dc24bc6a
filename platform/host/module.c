/* SPDX-License-Identifier: Apache-2.0 */
#define _GNU_SOURCE /* dladdr() */
#include "host/module.h"

#include <dlfcn.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "host/reason.h"

/* Loads a file from the folder that `beside` is in. Returns NULL if it is not there or does not load; *there says
 * which. */
static void *load_beside(const char *beside, const char *file, bool *there)
{
    char path[1024];
    const char *slash = strrchr(beside, '/');
    const int length =
        snprintf(path, sizeof path, "%.*s%s", slash == NULL ? 0 : (int)(slash - beside) + 1, beside, file);
    *there = slash != NULL && length > 0 && (size_t)length < sizeof path && access(path, F_OK) == 0;
    return *there ? dlopen(path, RTLD_NOW | RTLD_LOCAL) : NULL;
}

static void *load(const char *file)
{
    static const char here;
    char program[1024];
    Dl_info library;
    bool there = false;
    void *module = NULL;
    const ssize_t length = readlink("/proc/self/exe", program, sizeof program - 1);
    if (length > 0) {
        program[length] = '\0';
        module = load_beside(program, file, &there);
    }
    if (!there && dladdr(&here, &library) != 0 && library.dli_fname != NULL) {
        module = load_beside(library.dli_fname, file, &there);
    }
    return there ? module : dlopen(file, RTLD_NOW | RTLD_LOCAL);
}

const void *t3r_module_table(const char *name, char *error, size_t error_bytes)
{
    char file[64];
    snprintf(file, sizeof file, "libtrim3r_%s.so", name);
    void *module = load(file);
    const void *shim = module == NULL ? NULL : dlsym(module, "t3r_shim");
    if (shim == NULL) {
        const char *why = dlerror();
        t3r_reason(error, error_bytes, "its module does not load: %s", why != NULL ? why : "no table in it");
    }
    return shim;
}
