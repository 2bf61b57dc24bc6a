/* Adapters written in C++ are modules beside the program, loaded when they are asked for: their libraries need not be
 * where they are not used, and cost nothing where they are. */
#ifndef T3R_PLATFORM_CAPTURE_MODULE_H
#define T3R_PLATFORM_CAPTURE_MODULE_H

#include <stddef.h>

/* The table `t3r_shim` of the module "NAME", from the folder of the program, else from where the system looks for
 * libraries. Stays loaded. NULL with a reason in error[]. */
const void *t3r_capture_module(const char *name, char *error, size_t error_bytes);

#endif
