/* The calibration input of a head: recordings and plain images through the runtime, at several budgets. */
#ifndef TRIM3R_TOOLS_CALIBRATION_INPUT_H
#define TRIM3R_TOOLS_CALIBRATION_INPUT_H

#include <stdint.h>

#include "calibrate.h"

/* Budgets of each input, in percent of the valid points. */
#define CALIBRATION_BUDGETS                                                                                            \
    {                                                                                                                  \
        100, 40, 20, 10, 5                                                                                             \
    }
#define CALIBRATION_PAIRS 4u /* context pairs of a recording: its triplets', else evenly spaced frames */

/* Runs a recording (.mcap), or an image as a plane of width x height as in `eval --planar`. Returns an exit status of
 * cli.h, after a message unless it is CLI_OK. */
int calibration_input(calibration *c, char *path, uint32_t width, uint32_t height);

#endif
