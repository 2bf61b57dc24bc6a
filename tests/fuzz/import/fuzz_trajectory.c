/* SPDX-License-Identifier: Apache-2.0 */
/* Any text as a trajectory: an error, or poses in the order of their times, and between them interpolated ones. */
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "import/poses/trajectory.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    trajectory t;
    char error[256] = "";
    char *text = malloc(size + 1);
    if (text == NULL) {
        return 0;
    }
    memcpy(text, data, size);
    text[size] = '\0';
    int status = trajectory_parse(text, "t", &t, error, sizeof error);
    if ((status != 0) != (error[0] != '\0') || (status == 0) != (t.count > 0)) {
        abort();
    }
    for (size_t i = 0; status == 0 && i < t.count; i++) {
        rigid pose;
        if (i > 0 && t.poses[i].stamp_ns <= t.poses[i - 1].stamp_ns) {
            abort();
        }
        if (!trajectory_at(&t, t.poses[i].stamp_ns, &pose) || memcmp(&pose, &t.poses[i].pose, sizeof pose) != 0) {
            abort();
        }
        if (trajectory_at(&t, t.poses[i].stamp_ns + 1, &pose) &&
            !(fabs(pose.position[0]) < 2147483649.0 && isfinite(pose.rotation[0]))) {
            abort();
        }
    }
    trajectory_free(&t);
    free(text);
    return 0;
}
