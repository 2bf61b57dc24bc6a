/* Input for calibrating a head: recordings and plain images through the runtime, at several budgets. */
#ifndef TRIM3R_TOOLS_CALIBRATION_INPUT_H
#define TRIM3R_TOOLS_CALIBRATION_INPUT_H

#include <stdint.h>

#include "calibrate.h"

/* Percent of the valid points that each input goes through with. */
#define CALIBRATION_BUDGETS                                                                                            \
    {                                                                                                                  \
        100, 40, 20, 10, 5                                                                                             \
    }
#define CALIBRATION_PAIRS 4u /* context pairs of a recording: of its triplets, else of its frames, evenly spread */

/* Adds a recording (.mcap), or an image as a plane of width x height as in `eval --planar`. Returns an exit status
 * of cli.h, after a message unless it is CLI_OK. */
int calibration_input(calibration *c, char *path, uint32_t width, uint32_t height);

#endif
