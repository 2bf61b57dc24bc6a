/* Which of a device's formats is captured: what the runtime reads, at the wished size and rate where there is such. */
#ifndef T3R_PLATFORM_V4L2_FORMAT_H
#define T3R_PLATFORM_V4L2_FORMAT_H

#include <stdbool.h>
#include <stdint.h>

#include <linux/videodev2.h>

#include "trim3r.h"
#include "v4l2_system.h"

typedef struct t3r_v4l2_format {
    const char *name; /* its FourCC */
    uint32_t fourcc;
    t3r_pixel_format pixels; /* of depth: none; of MJPG: what it becomes */
    bool depth, jpeg;
} t3r_v4l2_format;

/* Those of this build in order of preference: as they come before what has to be decoded, colour before grey. */
extern const t3r_v4l2_format t3r_v4l2_formats[];
extern const uint32_t t3r_v4l2_format_count;

/* An ioctl that a signal interrupted is made again, at most 16 times. */
int t3r_v4l2_ioctl(const t3r_v4l2_system *system, int fd, unsigned long request, void *argument);

typedef struct t3r_v4l2_wish {
    bool depth;
    const char *format; /* a FourCC; NULL = any */
    uint32_t width, height, rate_millihertz;
} t3r_v4l2_wish;

typedef struct t3r_v4l2_choice {
    const t3r_v4l2_format *format;
    uint32_t width, height; /* as enumerated; the driver has the last word */
} t3r_v4l2_choice;

/* The format whose nearest size is nearest, of these one that reaches the rate, of these the most preferred. NULL, or
 * why there is none. */
const char *t3r_v4l2_choose(const t3r_v4l2_system *system, int fd, const t3r_v4l2_wish *wish, t3r_v4l2_choice *choice);

/* "YUYV" as text. */
const char *t3r_v4l2_fourcc_text(uint32_t fourcc, char text[5]);

#endif
