/* SPDX-License-Identifier: Apache-2.0 */
#include "reconstruction/live/live_options.h"

#include <stdlib.h>
#include <string.h>

#include "cli/options/file_options.h"
#include "cli/options/option_values.h"
#include "reconstruction/live/live_row.h"
#include "reconstruction/options/settings.h"

enum { KEY_OVERLAP = 0x2000, KEY_AT_HAND, KEY_MAX_MS, KEY_SNAPSHOT };

static const struct argp_option options[] = {
    {"overlap", KEY_OVERLAP, "P%", 0,
     "least percent that a frame shares with the last keyframe; with less it becomes a keyframe too, 1..100", 5},
    {"at-hand", KEY_AT_HAND, "K", 0, "number of keyframes whose planes are kept, for refinement, 1..16 (4)", 5},
    {"max-ms", KEY_MAX_MS, "MS", 0,
     "milliseconds that a keyframe may take: passes of refinement that would take longer are left out, so bits and "
     "hashes differ between runs; 1..1000000",
     5},
    {"snapshot", KEY_SNAPSHOT, "N", 0,
     "keyframes after which the files of the map and of --state are replaced, each as a whole; 1..1000000 (at the end)",
     5},
    {"state", OPTION_TO(live_options, state), "FILE.t3s", OPTION_WRITES(FILE_STATE),
     "file of the whole stream: map, keyframes and position; a later run continues from it", 5},
    {"resume", OPTION_TO(live_options, resume), NULL, 0, "continue from --state; without that file, begin at the start",
     5},
    {"lines", OPTION_TO(live_options, lines), "FILE.jsonl|-", OPTION_WRITES(FILE_LINES) | OPTION_OR_WORD,
     "file to write a JSON object into for each frame that may become a keyframe, as soon as it is taken; - is stdout, "
     "in place of the text, and with --json before its object",
     5},
    {0},
};

static error_t parse(int key, char *arg, struct argp_state *state)
{
    live_options *o = state->input;
    double percent;
    uint32_t count;
    switch (key) {
    case KEY_OVERLAP:
        option_percents(state, "overlap", arg, &percent, 1, &count);
        o->overlap_q8 = (uint32_t)(percent * 2.56 + 0.5);
        return 0;
    case KEY_AT_HAND:
        o->at_hand = option_number(state, "at-hand", arg, 1, T3R_MAX_VIEWS);
        return 0;
    case KEY_MAX_MS:
        o->most_ms = option_decimal(state, "max-ms", arg, 1, 1e6);
        return 0;
    case KEY_SNAPSHOT:
        o->snapshot = option_number(state, "snapshot", arg, 1, 1000000);
        return 0;
    default:
        return option_field(key, arg, state);
    }
}

/* Adds the fields of a line below the options. */
static char *list_fields(int key, const char *text, void *input)
{
    enum { BYTES = 4096 };
    static const char heading[] = "Fields of --lines; a file that exists is replaced, or continued with --resume:\n";
    (void)input;
    char *whole = key == ARGP_KEY_HELP_POST_DOC ? malloc(BYTES) : NULL;
    if (whole == NULL) {
        return (char *)(uintptr_t)text; /* argp frees only a different text */
    }
    memcpy(whole, heading, sizeof heading);
    live_row_help(whole + sizeof heading - 1, BYTES - sizeof heading);
    return whole;
}

const struct argp live_argp = {.options = options, .parser = parse, .help_filter = list_fields};

void live_options_check(struct argp_state *state, const live_options *o)
{
    if (o->snapshot > 0 && o->scene == NULL && o->state == NULL) {
        argp_error(state, "--snapshot writes the file of the map or of --state: name one of them");
    } else if (o->resume && o->state == NULL) {
        argp_error(state, "--resume needs --state");
    }
}

bool live_options_print_lines(const live_options *o)
{
    return o->lines != NULL && strcmp(o->lines, "-") == 0;
}

const char *live_options_given(const live_options *o, const t3r_config *config)
{
    return o->every > 0        ? "every"
           : o->overlap_q8 > 0 ? "overlap"
           : o->at_hand > 0    ? "at-hand"
           : o->most_ms > 0    ? "max-ms"
           : o->snapshot > 0   ? "snapshot"
           : o->state != NULL  ? "state"
           : o->resume         ? "resume"
           : o->lines != NULL  ? "lines"
                               : stream_setting_given(config);
}
