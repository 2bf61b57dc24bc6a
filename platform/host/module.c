/* SPDX-License-Identifier: Apache-2.0 */
#include "host/module.h"

#include <dlfcn.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "host/reason.h"

static void *load(const char *file)
{
    char path[1024];
    ssize_t length = readlink("/proc/self/exe", path, sizeof path - 1);
    if (length > 0) {
        path[length] = '\0';
        char *slash = strrchr(path, '/');
        size_t folder = slash == NULL ? 0 : (size_t)(slash - path) + 1;
        snprintf(path + folder, sizeof path - folder, "%s", file);
        void *module = dlopen(path, RTLD_NOW | RTLD_LOCAL);
        if (module != NULL || access(path, F_OK) == 0) {
            return module;
        }
    }
    return dlopen(file, RTLD_NOW | RTLD_LOCAL);
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
