/* V4L2 capture over a table of system calls: how tests stand in for the kernel. */
#ifndef T3R_PLATFORM_V4L2_H
#define T3R_PLATFORM_V4L2_H

#include "capture.h"
#include "v4l2_system.h"

/* Of a system in the place of Linux; the table is copied. Settings are filled (capture_adapter.h). */
t3r_capture *t3r_v4l2_open_on(const t3r_v4l2_system *system, const char *device, const t3r_capture_settings *settings,
                              char *error, size_t error_bytes);

/* A line for each device of this machine. */
void t3r_v4l2_devices(void (*say)(void *user, const char *line), void *user);

#endif
