/* Explains a status of the runtime to the user. */
#ifndef TRIM3R_TOOLS_RECONSTRUCTION_ERROR_H
#define TRIM3R_TOOLS_RECONSTRUCTION_ERROR_H

#include <stddef.h>

#include "trim3r.h"

/* Explains what `status` means for this arena and configuration; returns the corresponding exit status. */
int reconstruction_error(t3r_status status, const char *what, const t3r_config *config, size_t arena_bytes);

#endif
