/* SPDX-License-Identifier: Apache-2.0 */
/* The frames of one case in memory, to be perturbed: the context views, then the target, from the image stage (RGB and
 * Z16 of the working size, pinhole cameras). Recorded again, they give the same scene as the original recording. */
#ifndef TRIM3R_TOOLS_STRESS_CAPTURE_H
#define TRIM3R_TOOLS_STRESS_CAPTURE_H

#include <stdbool.h>
#include <stdint.h>

#include "evaluation/evaluation.h"
#include "recording/recording.h"

typedef struct stress_view {
    uint8_t *rgb;     /* width x height x 3 */
    uint16_t *depth;  /* width x height steps; 0 = none */
    bool colour_only; /* recorded without depth: the plane is zero */
    t3r_recorded_camera camera;
} stress_view;

typedef struct stress_capture {
    uint32_t width, height;
    uint32_t views; /* context views; the target is view[views] */
    double depth_unit;
    stress_view view[T3R_MAX_VIEWS + 1];
} stress_capture;

/* Returns false if out of memory; call stress_capture_free() in any case. Planes and cameras are zero. */
bool stress_capture_open(stress_capture *capture, uint32_t width, uint32_t height, uint32_t views, double depth_unit);
/* Reads the capture through the image stage. The working size comes from `settings`, otherwise from the first context
 * frame. Returns an exit status of cli.h; call stress_capture_free() in any case. */
int stress_capture_read(stress_capture *capture, const evaluation_case *what, const reconstruction_options *settings);
/* Returns false if out of memory; call stress_capture_free() in any case. */
bool stress_capture_copy(stress_capture *copy, const stress_capture *capture);
void stress_capture_free(stress_capture *capture);

/* Returns the number of context pixels with a depth. */
uint32_t stress_capture_valid(const stress_capture *capture);

/* Makes a recording in memory: frame i is view i. *bytes (free()) must outlive the recording. NULL after a message. */
t3r_recording *stress_capture_recording(const stress_capture *capture, uint8_t **bytes);

#endif
