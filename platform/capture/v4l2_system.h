/* SPDX-License-Identifier: Apache-2.0 */
/* The system calls of V4L2 capture as a table, so that a test can play the kernel. Failures are reported like the
 * system's: -1 (map: NULL) and errno. */
#ifndef T3R_PLATFORM_V4L2_SYSTEM_H
#define T3R_PLATFORM_V4L2_SYSTEM_H

#include <poll.h>
#include <stddef.h>
#include <stdint.h>

typedef struct t3r_v4l2_system {
    void *user;
    int (*open)(void *user, const char *path); /* O_RDWR | O_NONBLOCK | O_CLOEXEC */
    int (*ioctl)(void *user, int fd, unsigned long request, void *argument);
    void *(*map)(void *user, int fd, size_t bytes, int64_t offset); /* shared mapping; NULL = failed */
    int (*unmap)(void *user, void *memory, size_t bytes);
    int (*poll)(void *user, struct pollfd *fds, uint32_t count, int timeout_ms);
    int (*close)(void *user, int fd);
    int64_t (*now_ns)(void *user); /* CLOCK_MONOTONIC */
} t3r_v4l2_system;

extern const t3r_v4l2_system t3r_v4l2_kernel;

#endif
