/* The head of a frame in a file of planes. Every machine that reads or writes one is little-endian. */
#ifndef T3R_BAREMETAL_PLANES_H
#define T3R_BAREMETAL_PLANES_H

#include "trim3r.h"

typedef struct planes_head {
    t3r_camera camera;
    uint64_t depth_unit_q40; /* of t3r_frame */
} planes_head;

#endif
