/* Separable filters on planes of doubles, only for the measures. */
#ifndef TRIM3R_TOOLS_METRICS_FILTER_H
#define TRIM3R_TOOLS_METRICS_FILTER_H

#include <stdint.h>

typedef enum metrics_border {
    METRICS_BORDER_REFLECT,  /* c b a | a b c: the edge sample is repeated (OpenCV's BORDER_REFLECT) */
    METRICS_BORDER_REPLICATE /* a a a | a b c */
} metrics_border;

/* Correlates rows with across[0..2 radius] and columns with down[0..2 radius]. `work` is another plane; `out` may be
 * `in`. Needs no heap. */
void metrics_filter(const double *in, double *out, double *work, uint32_t width, uint32_t height, const double *across,
                    const double *down, uint32_t radius, metrics_border border);

#endif
