/* SPDX-License-Identifier: Apache-2.0 */
/* A video from pictures, by the program ffmpeg. */
#ifndef TRIM3R_TOOLS_VIDEO_H
#define TRIM3R_TOOLS_VIDEO_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <sys/types.h>

#include "cli/files/whole_file.h"

typedef struct video {
    FILE *pictures; /* into ffmpeg; NULL = it is not open */
    pid_t encoder;
    t3r_whole_file file; /* its part is what ffmpeg writes */
    size_t picture_bytes;
} video;

/* Whether a path has the suffix of a video: .mp4, .mkv, .mov or .webm. */
bool video_is_named(const char *path);
/* Starts ffmpeg for pictures of RGB, without gaps between rows. SIGPIPE is ignored from here on. Returns 0, or -1 with
 * the reason in error[], also where there is no ffmpeg. */
int video_begin(video *v, const char *path, uint32_t width, uint32_t height, double rate, char *error,
                size_t error_bytes);
/* Returns 0, or -1 when ffmpeg takes no more. */
int video_add(video *v, const uint8_t *rgb);
/* Ends the video. whole: all pictures were added; the file then appears. Returns 0, or -1 with the reason in error[].
 * No effect on a video that is not open. */
int video_end(video *v, bool whole, char *error, size_t error_bytes);

#endif
