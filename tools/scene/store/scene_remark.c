/* SPDX-License-Identifier: Apache-2.0 */
#include <inttypes.h>
#include <stdarg.h>
#include <stdio.h>

#include "host/text.h"
#include "scene/store/scene_store.h"

#define REMARK_BYTES 1024

void scene_remark(const scene_caller *caller, const char *path, const char *format, ...)
{
    char text[REMARK_BYTES];
    const int length = snprintf(text, sizeof text, "%s: ", path);
    if (length > 0 && (size_t)length < sizeof text) {
        va_list arguments;
        va_start(arguments, format);
        vsnprintf(text + length, sizeof text - (size_t)length, format, arguments);
        va_end(arguments);
    }
    t3r_text_clean(text); /* paths and files hold any text */
    caller->remark(caller->user, text);
}

void scene_remark_far(const scene_caller *caller, const char *path, uint32_t count, const char *done)
{
    scene_remark(caller, path,
                 "%" PRIu32 " Gaussians are over 1,000 times as far away as is typical of the scene: they are %s",
                 count, done);
}

void scene_remark_rounded(const scene_caller *caller, const char *path, double step, double width)
{
    scene_remark(caller, path,
                 "its positions are floats, so far from the origin in steps of %.3g, but half of the Gaussians are at "
                 "most %.3g wide: detail was lost where the file was written, which an offset or doubles would keep",
                 step, width);
}
