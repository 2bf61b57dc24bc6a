/* SPDX-License-Identifier: Apache-2.0 */
/* A small build and view of the built-in room, whose hash is the same on every machine. */
#ifndef TRIM3R_TOOLS_SELF_CHECK_H
#define TRIM3R_TOOLS_SELF_CHECK_H

#include <stdint.h>

#include "cli/options/processor_options.h"

/* Hash of this version: the stages of the build chained, then the view. */
#define SELF_CHECK_HASH UINT64_C(0xb74997d17807bf2e)

/* Builds two views of 64x64 with depth, 400 Gaussians by the head `small`, four passes of refinement, and draws the
 * view between them, with these threads and processor features. Returns CLI_OK, or an exit status after a message. */
int self_check_run(const processor_options *processor, uint64_t *hash);

#endif
