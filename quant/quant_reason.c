/* SPDX-License-Identifier: Apache-2.0 */
#include "quant_reason.h"

#include <stdarg.h>
#include <stdio.h>

int quant_reason(char *error, size_t error_bytes, const char *format, ...)
{
    if (error == NULL || error_bytes == 0) {
        return -1;
    }
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(error, error_bytes, format, arguments);
    va_end(arguments);
    for (char *c = error; *c != '\0'; c++) {
        if (*c < ' ' || *c > '~') {
            *c = '?';
        }
    }
    return -1;
}
