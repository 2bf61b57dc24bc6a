/* The sources of this build by name. */
#include <stdio.h>
#include <string.h>

#include "capture_adapter.h"
#include "capture_module.h"
#include "reason.h"

#ifdef T3R_V4L2
#define V4L2_THERE true
#define V4L2_SAYS "cameras of Linux: a device such as /dev/video0"
#else
#define V4L2_THERE false
#define V4L2_SAYS "not in this build (it needs Linux; T3R_V4L2 was off when it was configured)"
#endif
#ifdef T3R_LIBCAMERA
#define LIBCAMERA_SAYS "cameras of libcamera: a number of its list, or a camera's id"
#else
#define LIBCAMERA_SAYS "not in this build (tools/setup --cameras, then configure again with T3R_LIBCAMERA=AUTO)"
#endif
#ifdef T3R_OPENCV
#define OPENCV_SAYS "VideoCapture of OpenCV: a film, pictures as p%03d.png, a stream's URL, a device's number"
#else
#define OPENCV_SAYS "not in this build (tools/setup --cameras, then configure again with T3R_OPENCV=AUTO)"
#endif

#if !defined T3R_LIBCAMERA || !defined T3R_OPENCV || !defined T3R_V4L2
static t3r_capture *absent(const char *what, const t3r_capture_settings *settings, char *error, size_t error_bytes)
{
    (void)what;
    (void)settings;
    t3r_reason(error, error_bytes, "this adapter is not in this build: trim3r capture --list says why");
    return NULL;
}
#endif

static t3r_capture *open_replay(const char *path, const t3r_capture_settings *settings, char *error, size_t error_bytes)
{
    return t3r_replay_open_repeated(path, settings->repeat, error, error_bytes);
}

static const struct {
    const char *name;
    bool there;
    const char *module, *says;
    t3r_capture *(*open)(const char *what, const t3r_capture_settings *settings, char *error, size_t error_bytes);
    void (*devices)(void (*say)(void *user, const char *line), void *user);
} adapters[] = {
    {"replay", true, NULL, "a recording, REC.mcap", open_replay, NULL},
#ifdef T3R_V4L2
    {"v4l2", V4L2_THERE, NULL, V4L2_SAYS, t3r_v4l2_open, t3r_v4l2_devices},
#else
    {"v4l2", V4L2_THERE, NULL, V4L2_SAYS, absent, NULL},
#endif
#ifdef T3R_LIBCAMERA
    {"libcamera", true, "libcamera", LIBCAMERA_SAYS, t3r_libcamera_open, t3r_libcamera_devices},
#else
    {"libcamera", false, NULL, LIBCAMERA_SAYS, absent, NULL},
#endif
#ifdef T3R_OPENCV
    {"opencv", true, "opencv", OPENCV_SAYS, t3r_opencv_open, NULL},
#else
    {"opencv", false, NULL, OPENCV_SAYS, absent, NULL},
#endif
};
#define ADAPTERS (sizeof adapters / sizeof adapters[0])

uint32_t t3r_capture_adapter_count(void)
{
    return ADAPTERS;
}

t3r_capture_adapter t3r_capture_adapter_of(uint32_t index)
{
    t3r_capture_adapter told = {.name = adapters[index].name, .available = adapters[index].there};
    const char *module = adapters[index].module;
    if (module != NULL && t3r_capture_module(module, told.says, sizeof told.says) == NULL) {
        told.available = false;
    } else {
        snprintf(told.says, sizeof told.says, "%s", adapters[index].says);
    }
    return told;
}

void t3r_capture_devices(const char *adapter, void (*say)(void *user, const char *line), void *user)
{
    for (uint32_t i = 0; i < ADAPTERS; i++) {
        if (strcmp(adapters[i].name, adapter) == 0 && adapters[i].devices != NULL) {
            adapters[i].devices(say, user);
        }
    }
}

#ifdef T3R_MJPEG
#define MJPEG_NAME "MJPG "
#else
#define MJPEG_NAME ""
#endif

const char *t3r_capture_formats(void)
{
    return "YUYV UYVY NV12 RGB3 BGR3 " MJPEG_NAME "GREY";
}

t3r_capture *t3r_capture_open(const char *source, const t3r_capture_settings *settings, char *error, size_t error_bytes)
{
    t3r_capture_settings filled;
    const char *wrong = t3r_capture_settings_fill(settings, &filled);
    if (wrong != NULL) {
        t3r_reason(error, error_bytes, "%s", wrong);
        return NULL;
    }
    const char *colon = strchr(source, ':');
    for (uint32_t i = 0; colon != NULL && i < ADAPTERS; i++) {
        size_t length = strlen(adapters[i].name);
        if ((size_t)(colon - source) == length && strncmp(source, adapters[i].name, length) == 0) {
            return adapters[i].open(colon + 1, &filled, error, error_bytes);
        }
    }
    t3r_reason(error, error_bytes, "%s: is none of replay:FILE, v4l2:DEVICE, libcamera:CAMERA, opencv:URL", source);
    return NULL;
}
