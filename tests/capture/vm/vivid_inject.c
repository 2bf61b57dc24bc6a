/* SPDX-License-Identifier: Apache-2.0 */
/* vivid_inject DEVICE CONTROL VALUE: sets one V4L2 control; numbers as in C. */
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/ioctl.h>

#include <linux/videodev2.h>

int main(int argc, char **argv)
{
    if (argc != 4) {
        return 2;
    }
    int fd = open(argv[1], O_RDWR | O_NONBLOCK);
    struct v4l2_control control = {.id = (__u32)strtoul(argv[2], NULL, 0), .value = (__s32)strtol(argv[3], NULL, 0)};
    if (fd < 0 || ioctl(fd, VIDIOC_S_CTRL, &control) != 0) {
        perror(argv[1]);
        return 1;
    }
    return 0;
}
