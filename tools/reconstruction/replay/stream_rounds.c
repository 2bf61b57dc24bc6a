/* SPDX-License-Identifier: Apache-2.0 */
#include <inttypes.h>
#include <stdlib.h>

#include "cli/cli.h"
#include "cli/files/recorded_frame.h"
#include "reconstruction/replay/stream_run.h"

/* Returns the step that takes `count` keyframes once each in an order in which neighbours lie far apart: coprime to
 * the count, and near its golden section. */
static uint32_t mixing_step(uint32_t count)
{
    for (uint32_t step = (uint32_t)(count * 0.382 + 0.5); step > 1; step--) {
        uint32_t a = step, b = count;
        while (b > 0) {
            const uint32_t rest = a % b;
            a = b;
            b = rest;
        }
        if (a == 1) {
            return step;
        }
    }
    return 1;
}

static int show(stream_run *s, uint32_t frame, uint32_t round)
{
    t3r_runtime *rt = s->map.r.runtime;
    t3r_capture_frame captured;
    char reason[T3R_ERROR_BYTES];
    const int code = recorded_frame_read(s->recording, s->path, frame, &captured);
    if (code != CLI_OK) {
        return code;
    }
    const t3r_status status = t3r_stream_again(rt, &captured.frame, &captured.camera, round);
    if (status == T3R_OK || status == T3R_ERR_CAMERA) { /* out of the map's range: the map has left it behind */
        return CLI_OK;
    }
    return cli_error(
        CLI_BAD_INPUT, "%s: frame %" PRIu32 ": %s", s->path, frame,
        t3r_stream_again_error(status, rt, &captured.frame, &captured.camera, round, reason, sizeof reason));
}

int stream_rounds(stream_run *s)
{
    uint32_t *taken = malloc((s->is.row_count + 1) * sizeof *taken), count = 0;
    if (taken == NULL) {
        return cli_error(CLI_BAD_INPUT, "out of memory");
    }
    for (uint32_t i = 0; i < s->is.row_count; i++) {
        if (live_row_is_taken(&s->rows[i])) {
            taken[count++] = s->rows[i].frame;
        }
    }
    const uint32_t step = mixing_step(count), all = count * s->options->rounds;
    const double start = cli_now();
    int code = CLI_OK;
    for (uint32_t i = 0; i < all && code == CLI_OK; i++) {
        cli_progress_within("keyframes shown again", 0, i, all);
        code = show(s, taken[(uint64_t)(i % count) * step % count], i / count + 1);
    }
    s->rounds_seconds = cli_now() - start;
    cli_progress_end();
    free(taken);
    return code;
}
