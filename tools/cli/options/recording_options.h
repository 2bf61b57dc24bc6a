/* SPDX-License-Identifier: Apache-2.0 */
/* The options of every command that writes a recording: how its messages are stored. */
#ifndef TRIM3R_TOOLS_RECORDING_OPTIONS_H
#define TRIM3R_TOOLS_RECORDING_OPTIONS_H

#include <argp.h>
#include <stdbool.h>

#include "mcap/chunk_packer.h"
#include "recording/recording.h"

typedef struct recording_options {
    t3r_compression compression;
    bool unchunked;
} recording_options;

#define RECORDING_GROUP 25 /* group of these options in --help, after the settings of a build */

/* --compression, --unchunked. Each parent's parser passes a recording_options * in state->child_inputs[]; with neither,
 * frames are uncompressed chunks. */
extern const struct argp recording_argp;

/* Sets the options in a header. Returns 0, or -1 when memory is out. Call t3r_chunk_packer_close(header->packer) when
 * the recording is written, also after -1. */
int recording_options_apply(const recording_options *stored, t3r_recording_header *header);

#endif
