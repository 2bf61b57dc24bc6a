/* SPDX-License-Identifier: Apache-2.0 */
/* V4L2 capture over a table of system calls, so that tests can replace the kernel. */
#ifndef T3R_PLATFORM_V4L2_H
#define T3R_PLATFORM_V4L2_H

#include "trim3r_capture.h"
#include "v4l2_system.h"

/* Opens a device with these system calls instead of Linux's; the table is copied. Settings must be filled
 * (capture_adapter.h). */
t3r_capture *t3r_v4l2_open_on(const t3r_v4l2_system *system, const char *device, const t3r_capture_settings *settings,
                              char *error, size_t error_bytes);

/* Passes a line for each device of this machine to `say`. */
void t3r_v4l2_devices(void (*say)(void *user, const char *line), void *user);

#endif
