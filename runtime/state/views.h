/* What the analysis stages hand on: the planes of one context view, and where the scene's frame stands. */
#ifndef T3R_VIEWS_H
#define T3R_VIEWS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "core/fixed.h"
#include "core/scene_frame.h"
#include "trim3r.h"

/* Where a pixel's depth comes from: the two low bits of the validity plane. */
typedef enum t3r_depth_source {
    T3R_NO_DEPTH,     /* all bits are 0 */
    T3R_FILLED,       /* a small hole's, from the measured pixels around it (depth.h, stereo_fill.h) */
    T3R_BRIDGED,      /* a wide hole's (bridge.h): made anew by every analysis */
    T3R_MEASURED = 3, /* the sensor's, or matched by stereo */
    T3R_DEPTH_SOURCE_BITS = 3
} t3r_depth_source;

/* What the comparison of views found out about a pixel with depth: the bits above. */
enum t3r_mark {
    T3R_MARK_COVERED = 4,  /* another view has the surface about as finely */
    T3R_MARK_DOUBTFUL = 8, /* contradicted: a flying pixel */
    T3R_MARK_WITNESS = 16, /* covers another view's pixel; only within stage pointmap */
    T3R_MARK_LENT = 32,    /* a bridged pixel whose depth another view measured; only within stage pointmap */
    T3R_MARKS = 60         /* all of them */
};

/* Above the marks: the label is 256 more than its plane says. From stage superclusters on. */
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

/* Whether the sensor gave the depth, or stereo matched it, whatever the comparison of views found since. */
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

/* Measured, and nothing speaks against it. */
static inline bool t3r_is_reliable(uint8_t validity)
{
    return t3r_is_measured(validity) && !t3r_is_marked(validity);
}

/* Whether two depths in one unit, 0..2^32, differ by at most 1 / part of the lesser; part 1..64. */
static inline bool t3r_is_one_surface(int64_t a, int64_t b, int32_t part)
{
    return part * t3r_abs64(a - b) <= T3R_MIN(a, b);
}

/* Measured or filled, and nothing speaks against it. */
static inline bool t3r_is_known(uint8_t validity)
{
    return (t3r_is_measured(validity) || t3r_is_filled(validity)) && !t3r_is_marked(validity);
}

static inline uint8_t t3r_marked(uint8_t validity, enum t3r_mark mark)
{
    return (uint8_t)(validity | mark);
}

/* Without marks, and without the label's bit. */
static inline uint8_t t3r_unmarked(uint8_t validity)
{
    return validity & T3R_DEPTH_SOURCE_BITS;
}

/* The number that leaves the runtime for it: a Gaussian's confidence, and the hashes of stages (SPEC.md,
 * "Between views"). Marks that only stage pointmap knows do not count. */
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
    uint16_t *key;     /* budget only: the smaller, the earlier retained */
    uint8_t *label;    /* the lower eight bits of t3r_label_of(); anything where there is no depth */
    uint32_t *mask;    /* bit i of word i / 32: the pixel is retained */
    int32_t fx_q16, fy_q16, cx_q16, cy_q16;
    uint64_t depth_unit_q40;
    t3r_pose pose;
} t3r_view;

/* A sum is an instruction less than bits put together. */
static inline uint32_t t3r_label(uint8_t low, uint8_t validity)
{
    return low + (validity & T3R_LABEL_HIGH) * (256 / T3R_LABEL_HIGH);
}

/* The SuperCluster of a pixel with depth: a byte, and a bit beside the marks where there are more than 256. */
static inline uint32_t t3r_label_of(const t3r_view *view, size_t pixel)
{
    return t3r_label(view->label[pixel], view->validity[pixel]);
}

/* Once in an analysis, which takes back what the one before set. */
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

/* The planes of one of the views there is room for, as the stages take them; its pose only when it was added. */
t3r_view t3r_view_of(const t3r_runtime *rt, uint32_t index);

/* The planes of every view there is room for, likewise. */
void t3r_views_of(const t3r_runtime *rt, t3r_view views[T3R_MAX_VIEWS]);

/* Takes back that other views cover pixels; doubtful ones and the depth in wide holes stay. */
void t3r_reset_covered(const t3r_view *view);

/* Takes back what the comparison of views made: all marks, and the depth in wide holes. */
void t3r_reset_comparison(const t3r_view *views, uint32_t count);

#endif
