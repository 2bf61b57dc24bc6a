/* SPDX-License-Identifier: Apache-2.0 */
/* The sources of this build by name. */
#include <stdio.h>
#include <string.h>

#include "capture_adapter.h"
#include "host/module.h"
#include "host/program_check.h"
#include "host/reason.h"
#include "host/text.h"

extern const t3r_capture_source t3r_source_replay, t3r_source_v4l2, t3r_source_libcamera, t3r_source_opencv;

/* An adapter that is not in this build fails to open, with the reason. */
#ifndef T3R_V4L2
const t3r_capture_source t3r_source_v4l2 = {
    .name = "v4l2",
    .argument = "DEVICE",
    .says = "not in this build (it needs Linux; T3R_V4L2 was off when it was configured)",
};
#endif
#ifndef T3R_LIBCAMERA
const t3r_capture_source t3r_source_libcamera = {
    .name = "libcamera",
    .argument = "CAMERA",
    .says = "not in this build (tools/setup --cameras, then configure again with T3R_LIBCAMERA=AUTO)",
};
#endif
#ifndef T3R_OPENCV
const t3r_capture_source t3r_source_opencv = {
    .name = "opencv",
    .argument = "URL",
    .says = "not in this build (tools/setup --cameras, then configure again with T3R_OPENCV=AUTO)",
};
#endif

/* In the order of the list. */
static const t3r_capture_source *const sources[] = {&t3r_source_replay, &t3r_source_v4l2, &t3r_source_libcamera,
                                                    &t3r_source_opencv};
#define SOURCES (sizeof sources / sizeof sources[0])

uint32_t t3r_capture_adapter_count(void)
{
    return SOURCES;
}

t3r_capture_adapter t3r_capture_adapter_of(uint32_t index)
{
    const t3r_capture_source *source = sources[index];
    t3r_capture_adapter adapter = {.name = source->name, .available = source->open != NULL};
    if (source->module != NULL && t3r_module_table(source->module, adapter.says, sizeof adapter.says) == NULL) {
        adapter.available = false;
    } else {
        snprintf(adapter.says, sizeof adapter.says, "%s", source->says);
    }
    return adapter;
}

/* Devices name themselves, so a line may hold any text. */
typedef struct listener {
    void (*say)(void *user, const char *line);
    void *user;
} listener;

static void say_clean(void *user, const char *line)
{
    const listener *to = user;
    char text[512];
    t3r_text_copy(text, sizeof text, t3r_text_of(line));
    to->say(to->user, text);
}

void t3r_capture_devices(const char *adapter, void (*say)(void *user, const char *line), void *user)
{
    listener to = {say, user};
    for (uint32_t i = 0; i < SOURCES; i++) {
        if (sources[i]->devices != NULL && strcmp(sources[i]->name, adapter) == 0) {
            sources[i]->devices(say_clean, &to);
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

static t3r_capture *refuse_unknown(const char *what, char *error, size_t error_bytes)
{
    char known[256] = "";
    size_t length = 0;
    for (uint32_t i = 0; i < SOURCES && length < sizeof known; i++) {
        length += (size_t)snprintf(known + length, sizeof known - length, "%s%s:%s", i == 0 ? "" : ", ",
                                   sources[i]->name, sources[i]->argument);
    }
    t3r_reason(error, error_bytes, "%s: is none of %s", what, known);
    return NULL;
}

t3r_capture *t3r_capture_open_as(t3r_program program, const char *source, const t3r_capture_settings *settings,
                                 char *error, size_t error_bytes)
{
    t3r_capture_settings filled;
    if (!t3r_program_fits(program, t3r_capture_program(), error, error_bytes)) {
        return NULL;
    }
    const char *wrong = t3r_capture_settings_fill(settings, &filled);
    if (wrong != NULL) {
        t3r_reason(error, error_bytes, "%s", wrong);
        return NULL;
    }
    const char *colon = strchr(source, ':');
    for (uint32_t i = 0; colon != NULL && i < SOURCES; i++) {
        const size_t length = strlen(sources[i]->name);
        if ((size_t)(colon - source) != length || strncmp(source, sources[i]->name, length) != 0) {
            continue;
        }
        if (sources[i]->open != NULL) {
            return sources[i]->open(colon + 1, &filled, error, error_bytes);
        }
        t3r_reason(error, error_bytes, "this adapter is not in this build: trim3r capture --list says why");
        return NULL;
    }
    return refuse_unknown(source, error, error_bytes);
}
