/* SPDX-License-Identifier: Apache-2.0 */
/* The V4L2 devices of this machine, for `trim3r capture --list`. */
#include <errno.h>
#include <stdio.h>
#include <string.h>

#include "v4l2.h"
#include "v4l2_format.h"

#define MOST_NODES 64

static void say_node(int fd, const char *path, void (*say)(void *user, const char *line), void *user)
{
    const t3r_v4l2_system *system = &t3r_v4l2_kernel;
    struct v4l2_capability can = {0};
    if (t3r_v4l2_ioctl(system, fd, VIDIOC_QUERYCAP, &can) != 0) {
        return;
    }
    uint32_t caps = (can.capabilities & V4L2_CAP_DEVICE_CAPS) != 0 ? can.device_caps : can.capabilities;
    if ((caps & V4L2_CAP_VIDEO_CAPTURE) == 0) {
        return;
    }
    char line[256];
    int used =
        snprintf(line, sizeof line, "v4l2:%s  %.32s (%.16s):", path, (const char *)can.card, (const char *)can.driver);
    for (uint32_t i = 0; i < 64 && used < (int)sizeof line - 8; i++) {
        struct v4l2_fmtdesc listed = {.index = i, .type = V4L2_BUF_TYPE_VIDEO_CAPTURE};
        if (t3r_v4l2_ioctl(system, fd, VIDIOC_ENUM_FMT, &listed) != 0) {
            break;
        }
        for (uint32_t k = 0; k < t3r_v4l2_format_count; k++) {
            if (t3r_v4l2_formats[k].fourcc == listed.pixelformat) {
                used += snprintf(line + used, sizeof line - (size_t)used, " %.4s", t3r_v4l2_formats[k].name);
            }
        }
    }
    say(user, line);
}

void t3r_v4l2_devices(void (*say)(void *user, const char *line), void *user)
{
    const t3r_v4l2_system *system = &t3r_v4l2_kernel;
    for (int i = 0; i < MOST_NODES; i++) {
        char path[32];
        snprintf(path, sizeof path, "/dev/video%d", i);
        int fd = system->open(NULL, path);
        if (fd >= 0) {
            say_node(fd, path, say, user);
            (void)system->close(NULL, fd);
        } else if (errno != ENOENT) {
            char line[128];
            snprintf(line, sizeof line, "v4l2:%s  cannot be opened: %s", path, strerror(errno));
            say(user, line);
        }
    }
}
