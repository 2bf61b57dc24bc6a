/* SPDX-License-Identifier: Apache-2.0 */
/* Parts written in C++ are modules next to the program, loaded on demand: the libraries that they need may be absent
 * where they are not used. */
#ifndef T3R_PLATFORM_MODULE_H
#define T3R_PLATFORM_MODULE_H

#include <stddef.h>

/* Returns the table `t3r_shim` of the module "NAME". The module is searched for in the program's folder, in the host
 * library's, then where the system looks for libraries, and stays loaded. Returns NULL with a reason in error[] on
 * failure. */
const void *t3r_module_table(const char *name, char *error, size_t error_bytes);

#endif
