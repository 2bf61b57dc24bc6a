/* SPDX-License-Identifier: Apache-2.0 */
/* Results of the analysis stages: the planes of one context view, and the scene's frame. */
#ifndef T3R_VIEWS_H
#define T3R_VIEWS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "core/fixed.h"
#include "core/scene_frame.h"
#include "trim3r.h"

/* Source of a pixel's depth: the two low bits of the validity plane. */
typedef enum t3r_depth_source {
    T3R_NO_DEPTH,     /* all bits are 0 */
    T3R_FILLED,       /* a small hole, filled from the measured pixels around it (depth.h, surroundings.h) */
    T3R_BRIDGED,      /* a wide hole (bridge.h), bridged again by every analysis */
    T3R_MEASURED = 3, /* by the sensor, or matched by stereo */
    T3R_DEPTH_SOURCE_BITS = 3
} t3r_depth_source;

/* Results of comparing views for a pixel with depth: the bits above. */
enum t3r_mark {
    T3R_MARK_COVERED = 4,  /* another view has the surface about as finely */
    T3R_MARK_DOUBTFUL = 8, /* contradicted: a flying pixel */
    T3R_MARK_WITNESS = 16, /* covers another view's pixel; used only within stage pointmap */
    T3R_MARK_LENT = 32,    /* a bridged pixel whose depth another view measured; used only within stage pointmap */
    T3R_MARKS = 60         /* all of them */
};

/* Above the marks, from stage superclusters on: adds 256 to the label in the label plane. */
#define T3R_LABEL_HIGH 64u
_Static_assert(T3R_MAX_CLUSTERS <= 512, "labels have nine bits");

static inline t3r_depth_source t3r_depth_source_of(uint8_t validity)
{
    return (t3r_depth_source)(validity & T3R_DEPTH_SOURCE_BITS);
}

static inline bool t3r_has_depth(uint8_t validity)
{
    return t3r_depth_source_of(validity) != T3R_NO_DEPTH;
}

static inline bool t3r_is_filled(uint8_t validity)
{
    return t3r_depth_source_of(validity) == T3R_FILLED;
}

static inline bool t3r_is_bridged(uint8_t validity)
{
    return t3r_depth_source_of(validity) == T3R_BRIDGED;
}

/* Whether the depth came from the sensor or from a stereo match, with any marks. */
static inline bool t3r_is_measured(uint8_t validity)
{
    return t3r_depth_source_of(validity) == T3R_MEASURED;
}

static inline bool t3r_is_covered(uint8_t validity)
{
    return (validity & T3R_MARK_COVERED) != 0;
}

static inline bool t3r_is_doubtful(uint8_t validity)
{
    return (validity & T3R_MARK_DOUBTFUL) != 0;
}

static inline bool t3r_is_lent(uint8_t validity)
{
    return (validity & T3R_MARK_LENT) != 0;
}

static inline bool t3r_is_marked(uint8_t validity)
{
    return (validity & T3R_MARKS) != 0;
}

/* Whether the pixel is measured and has no marks. */
static inline bool t3r_is_reliable(uint8_t validity)
{
    return t3r_is_measured(validity) && !t3r_is_marked(validity);
}

/* Whether two depths in one unit, 0..2^32, differ by at most 1 / part of the lesser; part 1..64. */
static inline bool t3r_is_one_surface(int64_t a, int64_t b, int32_t part)
{
    return part * t3r_abs64(a - b) <= T3R_MIN(a, b);
}

/* Whether the pixel is measured or filled and has no marks. */
static inline bool t3r_is_known(uint8_t validity)
{
    return (t3r_is_measured(validity) || t3r_is_filled(validity)) && !t3r_is_marked(validity);
}

static inline uint8_t t3r_marked(uint8_t validity, enum t3r_mark mark)
{
    return (uint8_t)(validity | mark);
}

/* Returns validity without marks and without the label's bit. */
static inline uint8_t t3r_unmarked(uint8_t validity)
{
    return validity & T3R_DEPTH_SOURCE_BITS;
}

/* Returns the confidence for output, with a Gaussian and in the hashes of stages (SPEC.md, "Between views"). Marks
 * used only within stage pointmap don't change it. */
uint8_t t3r_confidence_of(uint8_t validity);

/* The planes of one view, each width x height, rows without gaps. */
typedef struct t3r_view {
    uint32_t width, height;
    uint8_t *colour[3]; /* r, g, b */
    uint16_t *depth;    /* steps of depth_unit; 0 = none */
    union {
        uint8_t *validity;         /* a t3r_depth_source, marks, and a bit of the label */
        uint8_t *match_confidence; /* the same bytes within stage stereo, until t3r_stereo_marks(): T3R_STEREO_... */
    };
    uint16_t *texture; /* energy_q4; blurred from budget on */
    uint16_t *key;     /* budget only: smaller keys are retained first */
    uint8_t *label;    /* lower eight bits of t3r_label_of(); undefined without depth */
    uint32_t *mask;    /* bit i of word i / 32: pixel i is retained */
    int32_t fx_q16, fy_q16, cx_q16, cy_q16;
    uint64_t depth_unit_q40;
    t3r_pose pose;
} t3r_view;

/* Combines the label's parts; `+` takes one instruction less than `|`. */
static inline uint32_t t3r_label(uint8_t low, uint8_t validity)
{
    return low + (validity & T3R_LABEL_HIGH) * (256 / T3R_LABEL_HIGH);
}

/* Returns the SuperCluster of a pixel with depth: a byte, and a bit above the marks for labels of 256 and more. */
static inline uint32_t t3r_label_of(const t3r_view *view, size_t pixel)
{
    return t3r_label(view->label[pixel], view->validity[pixel]);
}

/* Sets a label. Call once per analysis, which clears the bits of earlier labels first. */
static inline void t3r_set_label(const t3r_view *view, size_t pixel, uint32_t label)
{
    view->label[pixel] = (uint8_t)label;
    view->validity[pixel] |= label >= 256 ? T3R_LABEL_HIGH : 0;
}

static inline bool t3r_retained(const t3r_view *view, size_t pixel)
{
    return (view->mask[pixel / 32] >> (pixel % 32) & 1) != 0;
}

/* Whether a pixel of the view is t3r_is_reliable(). */
bool t3r_is_reliable_anywhere(const t3r_view *view);

/* Returns the planes of view `index`, below the configured number. The pose is set only for a view that was added. */
t3r_view t3r_view_of(const t3r_runtime *rt, uint32_t index);

/* Returns the planes of all configured views in the same way. */
void t3r_views_of(const t3r_runtime *rt, t3r_view views[T3R_MAX_VIEWS]);

/* Clears the marks of covered pixels; marks of doubtful pixels and bridged depth stay. */
void t3r_reset_covered(const t3r_view *view);

/* Clears the results of comparing views: all marks, and bridged depth. */
void t3r_reset_comparison(const t3r_view *views, uint32_t count);

#endif
