/* SPDX-License-Identifier: Apache-2.0 */
/* Remarks on a recording, one after the other, and places in it. */
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "host/text.h"
#include "recording_index.h"

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

const char *t3r_recording_file_name(const t3r_recording *recording, uint32_t file)
{
    return recording->files.count > 1 ? strrchr(recording->files.paths[file], '/') + 1 : "";
}

const char *t3r_recording_place_text(const t3r_recording *recording, uint32_t file, t3r_mcap_place place,
                                     char text[T3R_RECORDING_PLACE_BYTES])
{
    char at[T3R_MCAP_PLACE_BYTES];
    const char *name = t3r_recording_file_name(recording, file);
    snprintf(text, T3R_RECORDING_PLACE_BYTES, "%s%s%s", t3r_mcap_place_text(place, at), name[0] != '\0' ? " of " : "",
             name);
    return text;
}
