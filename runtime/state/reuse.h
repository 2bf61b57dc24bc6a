/* What a build takes over from the one before (t3r_config.warm): noted when an analysis is made, forgotten when a build
 * fails. */
#ifndef T3R_REUSE_H
#define T3R_REUSE_H

#include <stdbool.h>
#include <stdint.h>

#include "trim3r.h"

typedef struct t3r_reuse {
    uint32_t views;   /* bit v: depth, marks and the kept texture of view v are of the planes it has */
    uint32_t centres; /* 1 = the kept SuperClusters are of the scene's frame; 0 = the next build begins anew */
} t3r_reuse;

/* Whether view v need not be looked at by itself again. */
bool t3r_is_reused(const t3r_runtime *rt, uint32_t v);

/* View v gets other planes. */
void t3r_reuse_no_view(t3r_runtime *rt, uint32_t v);

/* The next build begins anew. */
void t3r_reuse_nothing(t3r_runtime *rt);

/* The views in the arena were analysed, so the next build may follow. Before anything works where SuperClusters are. */
void t3r_reuse_all(t3r_runtime *rt);

/* The plane that keeps the texture of view v before it is blurred. */
uint16_t *t3r_kept_texture(const t3r_runtime *rt, uint32_t v);

#endif
