/* What the analysis stages hand on: the planes of one context view, and where the scene's frame stands. */
#ifndef T3R_VIEWS_H
#define T3R_VIEWS_H

#include <stdbool.h>
#include <stdint.h>

#include "trim3r.h"

#define T3R_CONFIDENCE_MEASURED 255u
#define T3R_CONFIDENCE_WITNESS 254u /* measured, and covers another view's pixel; only within stage pointmap */
#define T3R_CONFIDENCE_COVERED 192u /* measured, but another view has the surface as finely */
#define T3R_CONFIDENCE_FILLED 128u
#define T3R_CONFIDENCE_FILLED_COVERED 96u
#define T3R_CONFIDENCE_DOUBTFUL 64u /* measured, but contradicted: a flying pixel */
#define T3R_CONFIDENCE_FILLED_DOUBTFUL 32u
#define T3R_CONFIDENCE_BRIDGED 24u /* of a wide hole (bridge.h): no view measured it */
#define T3R_CONFIDENCE_BRIDGED_COVERED 16u
#define T3R_CONFIDENCE_LENT 8u /* measured by another view; only within stage pointmap */
#define T3R_CONFIDENCE_NONE 0u

static inline bool t3r_is_covered(uint8_t confidence)
{
    return confidence == T3R_CONFIDENCE_COVERED || confidence == T3R_CONFIDENCE_FILLED_COVERED ||
           confidence == T3R_CONFIDENCE_BRIDGED_COVERED;
}

static inline bool t3r_is_doubtful(uint8_t confidence)
{
    return confidence == T3R_CONFIDENCE_DOUBTFUL || confidence == T3R_CONFIDENCE_FILLED_DOUBTFUL;
}

/* Whether it is a wide hole's, so that its depth is made anew by every analysis. */
static inline bool t3r_is_bridged(uint8_t confidence)
{
    return confidence != T3R_CONFIDENCE_NONE && confidence <= T3R_CONFIDENCE_BRIDGED;
}

/* Whether the sensor gave the depth, whatever was thought of it since. */
static inline bool t3r_is_measured(uint8_t confidence)
{
    return confidence >= T3R_CONFIDENCE_COVERED || confidence == T3R_CONFIDENCE_DOUBTFUL;
}

/* A rigid pose in fixed point, expanded once from t3r_camera. */
typedef struct t3r_pose {
    int32_t rotation_q30[9]; /* row-major, camera to scene */
    int32_t position_q20[3]; /* scene units */
} t3r_pose;

/* The planes of one view, each width x height, rows without gaps. */
typedef struct t3r_view {
    uint32_t width, height;
    uint8_t *colour[3];  /* r, g, b */
    uint16_t *depth;     /* steps of depth_unit; 0 = none */
    uint8_t *confidence; /* T3R_CONFIDENCE_...: the validity plane */
    uint16_t *texture;   /* energy_q4; blurred from budget on */
    uint16_t *key;       /* budget only: the smaller, the earlier retained */
    uint16_t *label;     /* SuperCluster, or T3R_NO_LABEL where there is no depth */
    uint32_t *mask;      /* bit i of word i / 32: the pixel is retained */
    int32_t fx_q16, fy_q16, cx_q16, cy_q16;
    uint64_t depth_unit_q40;
    t3r_pose pose;
} t3r_view;

#define T3R_NO_LABEL UINT16_MAX

/* The planes of every view there is room for, as the stages take them; poses only of those added. */
void t3r_views_of(const t3r_runtime *rt, t3r_view views[T3R_MAX_VIEWS]);

/* Confidences as they were before views were compared, measured, filled or none, and no depth in wide holes. */
void t3r_forget_marks(const t3r_view *views, uint32_t count);

#endif
