/* The allocation `given`: which points are retained is told by the caller, how densely they stand is counted
 * (SPEC.md, "Budget"). */
#ifndef T3R_IMPORTANCE_H
#define T3R_IMPORTANCE_H

#include <stdint.h>

#include "views.h"

/* One plane a context view, each width x height, as the caller lends it for a call. */
typedef struct t3r_importance {
    const uint16_t *const *planes;
    uint32_t stride_bytes; /* from row to row; even, at least 2 x width */
} t3r_importance;

/* The key planes: the more important, the smaller. */
void t3r_importance_keys(const t3r_view *views, uint32_t count, const t3r_importance *importance);

/* Log2 of the share of points retained about a pixel, counted from its mask, Q10, -8579..0. */
int32_t t3r_log_share_q10(const t3r_view *view, size_t pixel);

#endif
