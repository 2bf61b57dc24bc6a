/* Switches that take a part of the method away, so that tests and evaluations can measure what it is worth. They are no
 * settings: no product has a use for them, and every one makes scenes worse. */
#ifndef T3R_ABLATION_H
#define T3R_ABLATION_H

#include <stdint.h>

#include "trim3r.h"

/* All 0: the method as it is. */
typedef struct t3r_ablation {
    uint32_t shuffle;   /* 1 = SuperClusters exchange their textures at random. */
    uint32_t unadapted; /* 1 = Heads see every point as retained, so that splats stay as small as pixels. */
} t3r_ablation;

/* Holds from the next build on, also after t3r_reset() and t3r_attach(). NULL takes nothing away. A shuffle takes place
 * in the analysis: a rebuild does not change it. */
t3r_status t3r_set_ablation(t3r_runtime *rt, const t3r_ablation *ablation);

#endif
