/* The sources of this build by name. */
#include <stdio.h>
#include <string.h>

#include "capture_adapter.h"
#include "capture_module.h"
#include "host/reason.h"
#include "host/text.h"

/* Every adapter, in the order of the list; for one that was left out, the message for its user. */
#define ALWAYS(name) HERE(name)
#ifdef T3R_V4L2
#define WITH_V4L2 HERE(v4l2)
#else
#define WITH_V4L2 ABSENT("v4l2", "DEVICE", "it needs Linux; T3R_V4L2 was off when it was configured")
#endif
#ifdef T3R_LIBCAMERA
#define WITH_LIBCAMERA HERE(libcamera)
#else
#define WITH_LIBCAMERA                                                                                                 \
    ABSENT("libcamera", "CAMERA", "tools/setup --cameras, then configure again with T3R_LIBCAMERA=AUTO")
#endif
#ifdef T3R_OPENCV
#define WITH_OPENCV HERE(opencv)
#else
#define WITH_OPENCV ABSENT("opencv", "URL", "tools/setup --cameras, then configure again with T3R_OPENCV=AUTO")
#endif
#define SOURCES ALWAYS(replay) WITH_V4L2 WITH_LIBCAMERA WITH_OPENCV

#define HERE(name) extern const t3r_capture_source t3r_source_##name;
#define ABSENT(name, argument, why)
SOURCES
#undef HERE
#undef ABSENT

typedef struct source_row {
    const t3r_capture_source *source; /* NULL: not in this build */
    const char *name, *argument, *why;
} source_row;

static const source_row rows[] = {
#define HERE(name) {&t3r_source_##name, #name, NULL, NULL},
#define ABSENT(name, argument, why) {NULL, name, argument, "not in this build (" why ")"},
    SOURCES
#undef HERE
#undef ABSENT
};
#define ROWS (sizeof rows / sizeof rows[0])

uint32_t t3r_capture_adapter_count(void)
{
    return ROWS;
}

t3r_capture_adapter t3r_capture_adapter_of(uint32_t index)
{
    const t3r_capture_source *source = rows[index].source;
    t3r_capture_adapter told = {.name = rows[index].name, .available = source != NULL};
    if (source != NULL && source->module != NULL &&
        t3r_capture_module(source->module, told.says, sizeof told.says) == NULL) {
        told.available = false;
    } else {
        snprintf(told.says, sizeof told.says, "%s", source != NULL ? source->says : rows[index].why);
    }
    return told;
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
    for (uint32_t i = 0; i < ROWS; i++) {
        const t3r_capture_source *source = rows[i].source;
        if (source != NULL && source->devices != NULL && strcmp(source->name, adapter) == 0) {
            source->devices(say_clean, &to);
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
    for (uint32_t i = 0; i < ROWS && length < sizeof known; i++) {
        const char *argument = rows[i].source != NULL ? rows[i].source->argument : rows[i].argument;
        length += (size_t)snprintf(known + length, sizeof known - length, "%s%s:%s", i == 0 ? "" : ", ", rows[i].name,
                                   argument);
    }
    t3r_reason(error, error_bytes, "%s: is none of %s", what, known);
    return NULL;
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
    for (uint32_t i = 0; colon != NULL && i < ROWS; i++) {
        size_t length = strlen(rows[i].name);
        if ((size_t)(colon - source) != length || strncmp(source, rows[i].name, length) != 0) {
            continue;
        }
        if (rows[i].source != NULL) {
            return rows[i].source->open(colon + 1, &filled, error, error_bytes);
        }
        t3r_reason(error, error_bytes, "this adapter is not in this build: trim3r capture --list says why");
        return NULL;
    }
    return refuse_unknown(source, error, error_bytes);
}
