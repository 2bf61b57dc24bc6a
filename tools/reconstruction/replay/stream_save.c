/* SPDX-License-Identifier: Apache-2.0 */
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#include "cli/cli.h"
#include "core/hash.h"
#include "reconstruction/replay/stream_run.h"

/* Hashes the stamps and sizes of the frames before `next`, and the colours of the last of them. */
static uint64_t hash_frames(const t3r_recording *recording, uint32_t next)
{
    uint64_t hash = T3R_HASH_START;
    t3r_recorded_message colour = {0};
    for (uint32_t frame = 0; frame < next; frame++) {
        colour = t3r_recording_frame_message(recording, frame, T3R_USE_COLOUR);
        hash = t3r_hash_u64(t3r_hash_u64(hash, (uint64_t)colour.stamp_ns), colour.bytes);
    }
    return t3r_hash_bytes(hash, colour.data, colour.bytes);
}

int stream_save(stream_run *s, const live_row *row)
{
    const size_t rows = s->is.row_count * sizeof *s->rows, held = s->is.held_count * sizeof *s->held;
    const size_t bytes = sizeof s->is + rows + held;
    uint8_t *more = malloc(bytes);
    if (more == NULL) {
        return cli_error(CLI_BAD_INPUT, "out of memory");
    }
    s->is.frames_hash = s->options->live.state != NULL ? hash_frames(s->recording, s->is.next) : 0;
    memcpy(more, &s->is, sizeof s->is);
    memcpy(more + sizeof s->is, s->rows, rows);
    memcpy(more + sizeof s->is + rows, s->held, held);
    const int code = live_output_snapshot(&s->output, &s->map, row, more, bytes);
    free(more);
    return code;
}

/* Whether rows and frames held back are those of a run over the first `is->next` frames. */
static bool is_sound(const stream_counts *is, const live_row *rows, const held_back *held)
{
    bool sound = is->drawn <= is->held_count;
    for (uint32_t i = 0; i < is->row_count && sound; i++) {
        sound = rows[i].frame < is->next && live_row_is_sound(&rows[i]);
    }
    for (uint32_t i = 0; i < is->held_count && sound; i++) {
        sound = held[i].frame < is->next;
    }
    return sound;
}

static int take(stream_run *s, const live_state *state)
{
    const char *path = s->options->live.state;
    const uint32_t frames = t3r_recording_frame_count(s->recording);
    const uint8_t *more = state->more;
    stream_counts is;
    if (state->more_bytes < sizeof is) {
        return cli_error(CLI_BAD_INPUT, "%s: not the state of a replay", path);
    }
    memcpy(&is, more, sizeof is);
    const size_t rows = is.row_count * sizeof *s->rows, held = is.held_count * sizeof *s->held;
    if (is.next > frames || is.row_count > is.next || is.held_count > is.next ||
        state->more_bytes != sizeof is + rows + held || is.frames_hash != hash_frames(s->recording, is.next)) {
        return cli_error(CLI_BAD_INPUT, "%s: the state of another recording than %s", path, s->path);
    }
    memcpy(s->rows, more + sizeof is, rows);
    memcpy(s->held, more + sizeof is + rows, held);
    if (!is_sound(&is, s->rows, s->held)) {
        return cli_error(CLI_BAD_INPUT, "%s: damaged", path);
    }
    s->is = is;
    s->resumed_at = is.next;
    (void)cli_error(CLI_OK, "%s: continues at frame %" PRIu32 ", after %" PRIu32 " keyframes", path, is.next,
                    s->map.keyframes);
    return CLI_OK;
}

int stream_open(stream_run *s)
{
    live_state state;
    int code = live_output_open(&s->output, &s->map, !s->options->json, &state, &s->resumed);
    if (code == CLI_OK && s->resumed) {
        code = take(s, &state);
    }
    free(state.more);
    return code;
}
