/* SPDX-License-Identifier: Apache-2.0 */
#include "capture/live_stream.h"

#include <inttypes.h>
#include <stdlib.h>

#include "cli/cli.h"

int live_stream_open(live_stream *stream, const reconstruction_options *settings, const live_options *options,
                     const t3r_capture_frame *like, bool prints_table)
{
    reconstruction_options sized = *settings;
    live_state state;
    bool resumed;
    if (sized.config.width == 0) {
        sized.config.width = like->frame.width;
        sized.config.height = like->frame.height;
    }
    int code = live_map_open(&stream->map, &sized, options);
    if (code != CLI_OK) {
        return code;
    }
    stream->is_open = stream->map.quiet = true; /* capture draws its own line */
    code = live_output_open(&stream->output, &stream->map, prints_table, &state, &resumed);
    free(state.more);
    if (code == CLI_OK && resumed) {
        (void)cli_error(CLI_OK, "%s: continues after %" PRIu32 " keyframes", options->state, stream->map.keyframes);
    }
    return code;
}

int live_stream_row(live_stream *stream, const live_row *row)
{
    const int code = live_output_row(&stream->output, &stream->map, row);
    return code == CLI_OK ? live_output_snapshot(&stream->output, &stream->map, row, NULL, 0) : code;
}

int live_stream_save(live_stream *stream)
{
    return stream->is_open && stream->map.keyframes > 0
               ? live_output_snapshot(&stream->output, &stream->map, NULL, NULL, 0)
               : CLI_OK;
}

void live_stream_close(live_stream *stream)
{
    if (stream->is_open) {
        live_output_close(&stream->output);
        live_map_close(&stream->map);
        stream->is_open = false;
    }
}
