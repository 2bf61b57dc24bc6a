/* SPDX-License-Identifier: Apache-2.0 */
/* Explains a status of the runtime to the user. */
#ifndef TRIM3R_TOOLS_RECONSTRUCTION_ERROR_H
#define TRIM3R_TOOLS_RECONSTRUCTION_ERROR_H

#include <stddef.h>
#include <stdint.h>

#include "trim3r.h"
#include "trim3r_capture.h"

/* Explains what `status` means for this arena and configuration; returns the corresponding exit status. */
int reconstruction_error(t3r_status status, const char *what, const t3r_config *config, size_t arena_bytes);

/* Explains why t3r_render() drew nothing. */
int reconstruction_render_error(t3r_status status, const char *what, const t3r_runtime *runtime,
                                const t3r_camera *camera, const t3r_target *target);

/* Explains why t3r_add_view() did not take frame `index` of a recording (NULL: of a camera). */
int reconstruction_view_error(t3r_status status, const t3r_runtime *runtime, const char *path, uint32_t index,
                              const t3r_capture_frame *frame);

#endif
