/* The head of a frame in a file of planes. All machines that read or write one are little-endian. */
#ifndef T3R_BAREMETAL_PLANES_H
#define T3R_BAREMETAL_PLANES_H

#include "trim3r.h"

typedef struct planes_head {
    t3r_camera camera;
    uint64_t depth_unit_q40; /* as in t3r_frame */
} planes_head;

#endif
