/* SPDX-License-Identifier: Apache-2.0 */
#include "v4l2_format.h"

#include <errno.h>
#include <string.h>

#define MOST_LISTED 256u /* formats, sizes, intervals: cuts off a driver that lists without end */

const t3r_v4l2_format t3r_v4l2_formats[] = {
    {"YUYV", V4L2_PIX_FMT_YUYV, T3R_PIXEL_YUYV, false, false},
    {"UYVY", V4L2_PIX_FMT_UYVY, T3R_PIXEL_UYVY, false, false},
    {"NV12", V4L2_PIX_FMT_NV12, T3R_PIXEL_NV12, false, false},
    {"RGB3", V4L2_PIX_FMT_RGB24, T3R_PIXEL_RGB24, false, false},
    {"BGR3", V4L2_PIX_FMT_BGR24, T3R_PIXEL_BGR24, false, false},
#ifdef T3R_MJPEG
    {"MJPG", V4L2_PIX_FMT_MJPEG, T3R_PIXEL_RGB24, false, true},
#endif
    {"GREY", V4L2_PIX_FMT_GREY, T3R_PIXEL_GREY, false, false},
    {"Z16 ", V4L2_PIX_FMT_Z16, T3R_PIXEL_FORMAT_COUNT, true, false},
    {"Y16 ", V4L2_PIX_FMT_Y16, T3R_PIXEL_FORMAT_COUNT, true, false},
};
const uint32_t t3r_v4l2_format_count = sizeof t3r_v4l2_formats / sizeof t3r_v4l2_formats[0];

int t3r_v4l2_ioctl(const t3r_v4l2_system *system, int fd, unsigned long request, void *argument)
{
    int result = -1;
    for (int tries = 0; tries < 16; tries++) {
        result = system->ioctl(system->user, fd, request, argument);
        if (result >= 0 || errno != EINTR) {
            break;
        }
    }
    return result;
}

static bool offers(const t3r_v4l2_system *system, int fd, uint32_t fourcc)
{
    for (uint32_t i = 0; i < MOST_LISTED; i++) {
        struct v4l2_fmtdesc listed = {.index = i, .type = V4L2_BUF_TYPE_VIDEO_CAPTURE};
        if (t3r_v4l2_ioctl(system, fd, VIDIOC_ENUM_FMT, &listed) != 0) {
            return false;
        }
        if (listed.pixelformat == fourcc) {
            return true;
        }
    }
    return false;
}

static uint32_t distance(uint32_t a, uint32_t b)
{
    return a > b ? a - b : b - a;
}

static uint32_t snapped(uint32_t wish, uint32_t low, uint32_t high, uint32_t step)
{
    uint32_t inside = wish < low ? low : wish > high ? high : wish;
    return step > 1 ? low + (inside - low) / step * step : inside;
}

/* Finds the nearest size of this format; the wish itself if the driver lists none. Returns the distance from the wish.
 */
static uint32_t nearest_size(const t3r_v4l2_system *system, int fd, uint32_t fourcc, const t3r_v4l2_wish *wish,
                             uint32_t *width, uint32_t *height)
{
    uint32_t best = UINT32_MAX;
    for (uint32_t i = 0; i < MOST_LISTED; i++) {
        struct v4l2_frmsizeenum size = {.index = i, .pixel_format = fourcc};
        if (t3r_v4l2_ioctl(system, fd, VIDIOC_ENUM_FRAMESIZES, &size) != 0) {
            break;
        }
        bool discrete = size.type == V4L2_FRMSIZE_TYPE_DISCRETE;
        const struct v4l2_frmsize_stepwise *s = &size.stepwise;
        uint32_t w = discrete ? size.discrete.width : snapped(wish->width, s->min_width, s->max_width, s->step_width);
        uint32_t h =
            discrete ? size.discrete.height : snapped(wish->height, s->min_height, s->max_height, s->step_height);
        uint32_t away = distance(w, wish->width) + distance(h, wish->height);
        if (away < best) {
            best = away;
            *width = w;
            *height = h;
        }
        if (!discrete) {
            break;
        }
    }
    if (best == UINT32_MAX) {
        *width = wish->width;
        *height = wish->height;
        return 0;
    }
    return best;
}

/* Whether some interval is short enough for the rate, within 1 %. True if the driver lists none. */
static bool reaches_rate(const t3r_v4l2_system *system, int fd, uint32_t fourcc, uint32_t width, uint32_t height,
                         uint32_t rate_millihertz)
{
    for (uint32_t i = 0; i < MOST_LISTED; i++) {
        struct v4l2_frmivalenum interval = {.index = i, .pixel_format = fourcc, .width = width, .height = height};
        if (t3r_v4l2_ioctl(system, fd, VIDIOC_ENUM_FRAMEINTERVALS, &interval) != 0) {
            return i == 0;
        }
        bool discrete = interval.type == V4L2_FRMIVAL_TYPE_DISCRETE;
        struct v4l2_fract shortest = discrete ? interval.discrete : interval.stepwise.min;
        /* compares with 1000 / rate_millihertz seconds, multiplied by all denominators */
        if ((uint64_t)shortest.numerator * rate_millihertz * 99 <= (uint64_t)shortest.denominator * 1000 * 100) {
            return true;
        }
        if (!discrete) {
            return false;
        }
    }
    return false;
}

const char *t3r_v4l2_choose(const t3r_v4l2_system *system, int fd, const t3r_v4l2_wish *wish, t3r_v4l2_choice *choice)
{
    uint64_t best = UINT64_MAX;
    bool known = wish->format == NULL;
    for (uint32_t i = 0; i < t3r_v4l2_format_count; i++) {
        const t3r_v4l2_format *format = &t3r_v4l2_formats[i];
        bool wished = wish->format == NULL || strncmp(format->name, wish->format, strlen(wish->format)) == 0;
        if (format->depth != wish->depth || !wished) {
            continue;
        }
        known = true;
        if (!offers(system, fd, format->fourcc)) {
            continue;
        }
        uint32_t width, height;
        uint64_t away = nearest_size(system, fd, format->fourcc, wish, &width, &height);
        bool slow = wish->rate_millihertz != 0 &&
                    !reaches_rate(system, fd, format->fourcc, width, height, wish->rate_millihertz);
        uint64_t score = away * 2 + slow; /* the first of equals wins */
        if (score < best) {
            best = score;
            *choice = (t3r_v4l2_choice){format, width, height};
        }
    }
    if (!known) {
        return "the format is not one that is read";
    }
    if (best == UINT64_MAX) {
        return wish->depth            ? "the device offers neither Z16 nor Y16"
               : wish->format != NULL ? "the device does not offer the format"
                                      : "the device offers no format that is read";
    }
    return NULL;
}
