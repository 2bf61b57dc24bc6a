/* Remarks on a recording, one after the other. */
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "recording_index.h"
#include "host/text.h"

void t3r_recording_remark(t3r_recording *recording, const char *format, ...)
{
    size_t used = strlen(recording->note);
    if (used > 0 && used + 3 < sizeof recording->note) {
        memcpy(recording->note + used, "; ", 3);
        used += 2;
    }
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(recording->note + used, sizeof recording->note - used, format, arguments);
    va_end(arguments);
    t3r_text_clean(recording->note + used);
}
