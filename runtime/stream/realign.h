/* SPDX-License-Identifier: Apache-2.0 */
/* Moves the map after poses that jumped (SPEC.md, "Pieces"). */
#ifndef T3R_REALIGN_H
#define T3R_REALIGN_H

#include <stdbool.h>

#include "trim3r.h"

/* Finds out how far poses have jumped since the last keyframe, with the developed frame in the slot, and moves the map
 * and all keyframes as far. report: the figures of the frame, which are measured again. Returns T3R_OK with
 * report->realigned, or without it if the frame does not agree with the map from anywhere near; the map is then as it
 * was. */
t3r_status t3r_realign(t3r_runtime *rt, uint32_t slot, t3r_stream_report *report);

#endif
