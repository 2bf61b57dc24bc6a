/* SPDX-License-Identifier: Apache-2.0 */
/* Adapters written in C++ are modules next to the program, loaded on demand, so that the libraries that they need may
 * be absent if unused. */
#ifndef T3R_PLATFORM_CAPTURE_MODULE_H
#define T3R_PLATFORM_CAPTURE_MODULE_H

#include <stddef.h>

/* Returns the table `t3r_shim` of the module "NAME". The module is searched for in the program's folder, then where the
 * system looks for libraries, and stays loaded. Returns NULL with a reason in error[] on failure. */
const void *t3r_capture_module(const char *name, char *error, size_t error_bytes);

#endif
