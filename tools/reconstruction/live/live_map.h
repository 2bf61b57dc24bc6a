/* SPDX-License-Identifier: Apache-2.0 */
/* A map that follows a camera: chooses the keyframes among the frames, takes them within their time, and reports each.
 * replay, capture and the ROS node share it. */
#ifndef TRIM3R_TOOLS_LIVE_MAP_H
#define TRIM3R_TOOLS_LIVE_MAP_H

#include <stdbool.h>
#include <stdint.h>

#include "reconstruction/live/drawn_frame.h"
#include "reconstruction/live/live_options.h"
#include "reconstruction/live/live_row.h"
#include "reconstruction/live/pass_budget.h"
#include "reconstruction/reconstruction.h"
#include "recording/recording.h"
#include "trim3r_capture.h"

typedef struct live_map {
    reconstruction r; /* first: hooks get the map as this */
    reconstruction_options settings;
    live_options options;
    pass_budget budget;
    drawn_frame before; /* open if options.lines is given */
    uint32_t since;     /* frames since the last keyframe, which counts as 0 */
    uint32_t keyframes; /* so far */
    bool quiet;         /* no progress line */
} live_map;

/* Opens an empty map; the budget in percent refers to the first two keyframes of the recording. These return an exit
 * status of cli.h after a message; live_map_close() is due after CLI_OK. */
int live_map_open_recorded(live_map *map, const t3r_recording *recording, const char *path,
                           const reconstruction_options *settings, const live_options *options);
/* The same for frames to come: the settings give the working size and the budget as a count. */
int live_map_open(live_map *map, const reconstruction_options *settings, const live_options *options);
void live_map_close(live_map *map);

/* Binds an arena that was restored into map->r. */
int live_map_attach(live_map *map);

/* Takes the next frame in time, which has a pose and intrinsics. Returns whether it was offered to the map as a
 * keyframe, which fills the row. After an error in row->status the map is as t3r_stream_keyframe() leaves it, and the
 * next frame is due. */
bool live_map_frame(live_map *map, const t3r_capture_frame *frame, live_row *row);

#endif
