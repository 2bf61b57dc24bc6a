/* What a status of the runtime means to a user. */
#ifndef TRIM3R_TOOLS_RECONSTRUCTION_ERROR_H
#define TRIM3R_TOOLS_RECONSTRUCTION_ERROR_H

#include <stddef.h>

#include "trim3r.h"

/* Says what `status` means for this arena and configuration; returns the exit status that belongs to it. */
int reconstruction_error(t3r_status status, const char *what, const t3r_config *config, size_t arena_bytes);

#endif
