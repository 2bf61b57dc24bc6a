/* SPDX-License-Identifier: Apache-2.0 */
#include "reason.h"

#include <stdarg.h>
#include <stdio.h>

#include "text.h"

int t3r_reason(char *error, size_t error_bytes, const char *format, ...)
{
    if (error != NULL && error_bytes > 0) {
        va_list arguments;
        va_start(arguments, format);
        vsnprintf(error, error_bytes, format, arguments);
        va_end(arguments);
        t3r_text_clean(error);
    }
    return -1;
}
