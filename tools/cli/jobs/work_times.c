/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/jobs/work_times.h"

#include <stdio.h>

#include "cli/cli.h"

static const struct {
    const char *key, *word;
} names[WORK_KINDS] = {
    [WORK_READ] = {"read_ms", "read"},     [WORK_POSES] = {"pose_ms", "poses"},  [WORK_BUILD] = {"build_ms", "build"},
    [WORK_DRAW] = {"render_ms", "render"}, [WORK_WRITE] = {"write_ms", "write"},
};

void work_times_begin(work_times *times)
{
    *times = (work_times){.since = cli_now()};
}

void work_times_end(work_times *times, work_kind kind)
{
    const double now = cli_now();
    times->seconds[kind] += now - times->since;
    times->since = now;
}

void work_times_pass(work_times *times)
{
    times->since = cli_now();
}

void work_times_add_json(cJSON *object, const work_times *times)
{
    for (int kind = 0; kind < WORK_KINDS; kind++) {
        if (times->seconds[kind] > 0) {
            cJSON_AddNumberToObject(object, names[kind].key, times->seconds[kind] * 1e3);
        }
    }
}

const char *work_times_text(const work_times *times, char text[WORK_TIMES_BYTES])
{
    size_t length = 0;
    text[0] = '\0';
    for (int kind = 0; kind < WORK_KINDS && length < WORK_TIMES_BYTES; kind++) {
        if (times->seconds[kind] > 0) {
            length += (size_t)snprintf(text + length, WORK_TIMES_BYTES - length, "%s%s %.1f ms", length > 0 ? ", " : "",
                                       names[kind].word, times->seconds[kind] * 1e3);
        }
    }
    return text;
}
