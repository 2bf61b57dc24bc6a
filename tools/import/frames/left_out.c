/* SPDX-License-Identifier: Apache-2.0 */
#include "import/frames/left_out.h"

#include <inttypes.h>

#include "host/reason.h"

int left_out_refuse(const left_out *what, char *error, size_t error_bytes)
{
    const text_list *first = what->frames.count > 0 ? &what->frames : &what->depth;
    if (first->count == 0) {
        return 0;
    }
    return t3r_reason(error, error_bytes,
                      "--strict refuses what would be left out (frames: %" PRIu32 ", depth: %" PRIu32
                      "); the first: %s",
                      what->frames.count, what->depth.count, first->lines[0]);
}

void left_out_print(const left_out *what)
{
    text_list_print(&what->frames, "left out");
    text_list_print(&what->depth, "depth left out");
}

void left_out_add_json(const left_out *what, cJSON *object)
{
    cJSON_AddNumberToObject(object, "skipped", what->frames.count);
    text_list_add_json(&what->frames, object, "left_out");
    text_list_add_json(&what->depth, object, "depth_left_out");
}

void left_out_free(left_out *what)
{
    text_list_free(&what->frames);
    text_list_free(&what->depth);
}
