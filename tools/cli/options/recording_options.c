/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/options/recording_options.h"

#include <string.h>

#include "cli/options/option_values.h"

enum { KEY_COMPRESSION = 0x190 };

static const struct argp_option options[] = {
    {NULL, 0, NULL, 0, "How messages are stored in the recording:", RECORDING_GROUP},
    {"compression", KEY_COMPRESSION, "none|zstd|lz4", 0, "compression of the frames (none)", RECORDING_GROUP},
    {"unchunked", OPTION_TO(recording_options, unchunked), NULL, 0,
     "write messages without chunks and without their index, as a microcontroller does", RECORDING_GROUP},
    {0},
};

static t3r_compression parse_compression(struct argp_state *state, const char *text)
{
    for (uint32_t i = 0; i < T3R_COMPRESSION_COUNT; i++) {
        if (strcmp(text, t3r_compression_names[i]) == 0) {
            return (t3r_compression)i;
        }
    }
    argp_error(state, "--compression does not know '%s'; there are none, zstd, lz4", text);
    return T3R_COMPRESSION_NONE;
}

static error_t parse(int key, char *argument, struct argp_state *state)
{
    recording_options *o = state->input;
    switch (key) {
    case KEY_COMPRESSION:
        o->compression = parse_compression(state, argument);
        return 0;
    case ARGP_KEY_END:
        if (o->unchunked && o->compression != T3R_COMPRESSION_NONE) {
            argp_error(state, "--compression packs chunks, which --unchunked leaves out");
        }
        return 0;
    default:
        return option_field(key, argument, state);
    }
}

const struct argp recording_argp = {.options = options, .parser = parse};

int recording_options_apply(const recording_options *stored, t3r_recording_header *header)
{
    header->unchunked = stored->unchunked;
    header->packer = t3r_chunk_packer_open(stored->compression);
    return header->packer == NULL && stored->compression != T3R_COMPRESSION_NONE ? -1 : 0;
}
