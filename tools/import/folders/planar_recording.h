/* A single image as a recording. */
#ifndef TRIM3R_TOOLS_PLANAR_RECORDING_H
#define TRIM3R_TOOLS_PLANAR_RECORDING_H

#include <stdint.h>

#include "recording/recording.h"

/* Makes a recording in memory of one image, cropped and averaged to width x height as import does: a single view of a
 * plane two units away, with a focal length of `width` pixels. *bytes (free()) must outlive it. Returns NULL after a
 * message. */
t3r_recording *planar_recording(char *path, uint32_t width, uint32_t height, uint8_t **bytes);

#endif
