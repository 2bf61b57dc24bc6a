/* The way of the data, from the planes of the context views to the scene. */
#ifndef T3R_PIPELINE_H
#define T3R_PIPELINE_H

#include "trim3r.h"

/* Depth, pointmap, wavelet, superclusters: all that does not depend on the budget. */
t3r_status t3r_analyse(t3r_runtime *rt);
/* Budget and head: the scene. */
t3r_status t3r_build_scene(t3r_runtime *rt);

#endif
