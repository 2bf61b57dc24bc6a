/* SPDX-License-Identifier: Apache-2.0 */
/* Instructions of plain C on x86-64 in 1/1000 a unit of each kind of work, as gcc 12 -O2 makes them.
 * tests/proofs/work.py --fit makes this file. */
#include "planning/work.h"

const work_prices work_operations = {{
    [WORK_IMAGE] = 96839,
    [WORK_DEPTH] = 52884,
    [WORK_STEREO] = 20638310,
    [WORK_POINTMAP] = 715606,
    [WORK_COMPARISON] = 627170,
    [WORK_WAVELET] = 98708,
    [WORK_SEEDING] = 116248,
    [WORK_BATCHES] = 1177179,
    [WORK_LABELS] = 1477107,
    [WORK_CENTRES] = 23855,
    [WORK_NEIGHBOURS] = 0,
    [WORK_BUDGET] = 726833,
    [WORK_DISC_PIXELS] = 39236,
    [WORK_DISC_GAUSSIANS] = 2853592,
    [WORK_FEATURES] = 1346381,
    [WORK_LIFTS] = 5125870,
    [WORK_ACTIVATIONS] = 43285,
    [WORK_MACS] = 4548,
    [WORK_UNPACKED_MACS] = 4514,
    [WORK_REFINE_PIXELS] = 5500980,
    [WORK_REFINE_GAUSSIANS] = 12142756,
    [WORK_CORRECTIONS] = 0,
    [WORK_REMADE_PIXELS] = 62255,
    [WORK_RASTER_PIXELS] = 508748,
    [WORK_RASTER_GAUSSIANS] = 2545825,
}};
