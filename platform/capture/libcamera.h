/* SPDX-License-Identifier: Apache-2.0 */
/* Capture by libcamera through its module's table, so that tests can replace the library. */
#ifndef T3R_PLATFORM_LIBCAMERA_H
#define T3R_PLATFORM_LIBCAMERA_H

#include "libcamera_shim.h"
#include "trim3r_capture.h"

/* Opens a camera with the given module. Settings must be filled (capture_adapter.h). */
t3r_capture *t3r_libcamera_open_on(const t3r_libcamera_shim *shim, const char *camera,
                                   const t3r_capture_settings *settings, char *error, size_t error_bytes);

#endif
