/* SPDX-License-Identifier: Apache-2.0 */
/* Instructions of plain C on x86-64 in 1/1000 a unit of each kind of work, as gcc 12 -O2 makes them.
 * tests/proofs/work.py --fit makes this file. */
#include "planning/work.h"

const work_prices work_operations = {{
    [WORK_IMAGE] = 95987,
    [WORK_DEPTH] = 52733,
    [WORK_STEREO] = 6773632,
    [WORK_POINTMAP] = 619202,
    [WORK_COMPARISON] = 636405,
    [WORK_WAVELET] = 98633,
    [WORK_SEEDING] = 116151,
    [WORK_BATCHES] = 1181431,
    [WORK_LABELS] = 1471559,
    [WORK_CENTRES] = 23893,
    [WORK_NEIGHBOURS] = 0,
    [WORK_BUDGET] = 714760,
    [WORK_DISC_PIXELS] = 41268,
    [WORK_DISC_GAUSSIANS] = 2983103,
    [WORK_FEATURES] = 1361473,
    [WORK_LIFTS] = 5397629,
    [WORK_ACTIVATIONS] = 41889,
    [WORK_MACS] = 4560,
    [WORK_UNPACKED_MACS] = 4522,
    [WORK_REFINE_PIXELS] = 3087164,
    [WORK_REFINE_GAUSSIANS] = 9220889,
    [WORK_CORRECTIONS] = 4009991,
    [WORK_REMADE_PIXELS] = 638122,
    [WORK_RASTER_PIXELS] = 415340,
    [WORK_RASTER_GAUSSIANS] = 2221320,
}};
