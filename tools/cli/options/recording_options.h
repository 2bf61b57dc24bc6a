/* The options of every command that writes a recording: how its messages are stored. */
#ifndef TRIM3R_TOOLS_RECORDING_OPTIONS_H
#define TRIM3R_TOOLS_RECORDING_OPTIONS_H

#include <argp.h>
#include <stdbool.h>

#include "mcap/chunk_packer.h"

typedef struct recording_options {
    t3r_compression compression;
    bool unchunked;
} recording_options;

#define RECORDING_GROUP 25 /* of these options in --help, behind the settings of a build */

/* --compression, --unchunked. Each parent's parser hands a recording_options * on in state->child_inputs[]; without
 * either, frames are chunks that are not compressed. */
extern const struct argp recording_argp;

/* Sets what the options say in a header. 0, or -1 when memory is out. t3r_chunk_packer_close(header->packer) when the
 * recording is written, also behind -1. */
int recording_options_apply(const recording_options *stored, t3r_recording_header *header);

#endif
