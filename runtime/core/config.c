/* SPDX-License-Identifier: Apache-2.0 */
/* Settings: their defaults and their ranges. */
#include "config.h"

#include "features.h"
#include "fixed.h"
#include "memory.h"

#define DEFAULT(name, kind, low, high, usual, ...) .name = (usual),

/* Not inlined, as gcc 12 for Cortex-M55 would place a short branch around it that does not reach. */
static __attribute__((noinline)) t3r_config default_config(uint32_t width, uint32_t height, uint32_t views,
                                                           uint32_t gaussians)
{
    return (t3r_config){T3R_SETTINGS(DEFAULT)};
}

t3r_status t3r_default_config_as(uint64_t digest, void *config, size_t config_bytes, uint32_t width, uint32_t height,
                                 uint32_t views, uint32_t gaussians)
{
    if (config == NULL) {
        return T3R_ERR_ARGUMENT;
    }
    if (digest != t3r_header_interface() || config_bytes != sizeof(t3r_config)) {
        memset(config, 0, config_bytes); /* the caller's, of any size */
        return T3R_ERR_INTERFACE;
    }
    *(t3r_config *)config = default_config(width, height, views, gaussians);
    return T3R_OK;
}

#define MANY_CLUSTERS 300u
#define CLUSTERS_A_BATCH 8u
#define MOST_BATCHES 24u

uint32_t t3r_cluster_count(const t3r_config *c)
{
    if (c == NULL) {
        return 0;
    }
    const uint32_t points = c->width * c->height * c->views; /* at most 2^28 */
    if (t3r_is_stream(c)) {
        return 1;
    }
    if (c->clusters != 0) {
        return c->clusters;
    }
    switch (c->allocate) {
    case T3R_ALLOCATE_DENSITY:
        return T3R_CLUSTERS_OF_POINTS(points);
    case T3R_ALLOCATE_PAPER:
    case T3R_ALLOCATE_GIVEN:
        return MANY_CLUSTERS;
    default:
        return 1;
    }
}

uint32_t t3r_cluster_batch_count(const t3r_config *c)
{
    if (c == NULL) {
        return 0;
    }
    const uint32_t batches = t3r_cluster_count(c) / CLUSTERS_A_BATCH;
    return c->cluster_batches != 0 ? c->cluster_batches : batches == 0 ? 1 : T3R_MIN(batches, MOST_BATCHES);
}

/* Pixels of a view for each Gaussian from which a pass compares a part of them. */
#define PIXELS_A_GAUSSIAN 16u

static uint32_t refine_stride(const t3r_config *c)
{
    if (!t3r_is_stream(c)) {
        return 1;
    }
    const bool many = c->width * c->height / PIXELS_A_GAUSSIAN >= c->gaussians;
    return c->refine_stride != 0 ? c->refine_stride : many ? 2 : 1;
}

t3r_config t3r_settled(const t3r_config *config)
{
    t3r_config settled = *config;
    settled.clusters = t3r_cluster_count(config);
    settled.cluster_batches = t3r_cluster_batch_count(config);
    settled.refine_stride = refine_stride(config);
    return settled;
}

/* A setting's range and what it needs of the library. The settings are the words of t3r_config, in this order. */
typedef struct range {
    uint32_t high;
    uint8_t low, feature, from;
} range;

#define RANGE(name, kind, low, high, usual, feature, from, ...) {(high), (low), T3R_HAS_##feature, (from)},
static const range ranges[] = {T3R_SETTINGS(RANGE)};
_Static_assert(sizeof(t3r_config) == sizeof ranges / sizeof ranges[0] * sizeof(uint32_t), "settings are words");

/* X(text, value, low, high), one row for each range that depends on other settings; these are checked before. */
#define RELATIONS(X)                                                                                                   \
    X("gaussians must be 1..max_gaussians", c->gaussians, 1, c->max_gaussians)                                         \
    X("width and height must be 32 and more with depth by stereo", T3R_MIN(c->width, c->height),                       \
      stereo ? T3R_STEREO_LEAST_SIDE : 0, T3R_MAX_SIDE)                                                                \
    X("warm must be 0 with depth by stereo", c->warm, 0, !stereo)                                                      \
    X("stream must be 0 without views or with depth by stereo", c->stream, 0, c->views > 0 && !stereo)

#define BOUNDS(text, value, low, high) {(value), (low), (high)},
#define TEXT(text, value, low, high) text,

#define NUMBER_TEXT(name, low, high) #name " must be " T3R_TEXT_(low) ".." T3R_TEXT_(high)
#define TEXT_number NUMBER_TEXT
#define TEXT_q8 NUMBER_TEXT
#define TEXT_toggle(name, low, high) #name " must be 0 or 1"
#define TEXT_wavelet(name, low, high) #name " is none of t3r_wavelet"
#define TEXT_allocation(name, low, high) #name " is none of t3r_allocation"
#define TEXT_head(name, low, high) #name " is none of t3r_head"
#define TEXT_depth(name, low, high) #name " is none of t3r_depth"
#define RANGE_TEXT(name, kind, low, high, ...) TEXT_##kind(name, low, high),
#define WITHOUT_TEXT(FEATURE, name) "this library was built without " #name,

/* The texts are separate, so that a firmware links them only if it uses them. */
static const char *const texts[] = {"no configuration",
                                    T3R_SETTINGS(RANGE_TEXT)
                                        RELATIONS(TEXT) "the arena would be larger than this machine can address",
                                    T3R_FEATURE_ROWS(WITHOUT_TEXT)};

#define ONE_MORE(...) +1

enum {
    RANGES_COUNT = sizeof ranges / sizeof ranges[0],
    FAULTS = sizeof texts / sizeof texts[0],
    FIRST_FEATURE = FAULTS - (0 T3R_FEATURE_ROWS(ONE_MORE))
};

uint64_t t3r_most_arena_bytes(const t3r_config *c)
{
    const uint64_t pixels = (uint64_t)c->width * c->height, gaussians = c->max_gaussians, workers = c->workers;
    /* each worker's part of the work of wavelet, head, K-means, budget and refinement */
    const uint64_t worker = pixels * 4 + (uint64_t)(c->width + 15) * (c->head_column_bytes + 32) +
                            T3R_HEAD_KERNEL_BYTES + T3R_CLUSTER_SUMS_BYTES(T3R_MAX_CLUSTERS) +
                            (T3R_MAX_CLUSTERS + 1) * T3R_GROUP_COUNT_BYTES + T3R_WANTED_BYTES + gaussians * 27 + 512;
    const uint64_t fixed = T3R_HEADER_BYTES + T3R_CLUSTER_WORK_BYTES(T3R_MAX_CLUSTERS) +
                           2 * (T3R_MAX_CLUSTERS + 1) * T3R_CLUSTER_BYTES + 2 * T3R_SORT_BYTES +
                           3 * T3R_RATIO_BINS * 4 + T3R_BUFFER_COUNT * T3R_ARENA_ALIGN * (uint64_t)4;
    uint64_t bytes = fixed + pixels * (c->views * (uint64_t)26 + 38) +
                     (uint64_t)c->render_width * c->render_height * 8 + gaussians * 332 + workers * worker;
    /* planes a quarter larger on each side, the right one wider; 64 rows of sums and costs, and as many path states */
    const uint64_t wide = (uint64_t)T3R_MAX_(c->width, c->height) * 5 / 4 + 8 + T3R_STEREO_DISPARITIES;
    bytes +=
        c->depth == T3R_DEPTH_STEREO && c->views > 0 ? wide * wide * 16 + wide * (T3R_STEREO_DISPARITIES + 2) * 300 : 0;
    return t3r_is_stream(c) ? bytes + c->remember * (pixels * 2 + T3R_REMEMBERED_HEAD_BYTES + T3R_ARENA_ALIGN) : bytes;
}

static uint32_t value_of(const t3r_config *c, size_t setting)
{
    uint32_t value;
    memcpy(&value, (const uint8_t *)c + setting * sizeof value, sizeof value);
    return value;
}

/* Returns the index of the text of a feature that the settings need and the library lacks, or FAULTS. */
static size_t first_need(const t3r_config *c)
{
    uint32_t lacking = 0;
    for (size_t i = 0; i < RANGES_COUNT && lacking == 0; i++) {
        lacking = value_of(c, i) >= ranges[i].from ? ranges[i].feature & ~T3R_FEATURES_BUILT : 0;
    }
    size_t at = FIRST_FEATURE;
    for (; lacking > 1 && lacking % 2 == 0; lacking /= 2) {
        at++;
    }
    return lacking == 0 ? FAULTS : at;
}

/* Returns the index of the text, or FAULTS if nothing is wrong. */
static size_t first_fault(const t3r_config *c)
{
    if (c == NULL) {
        return 0;
    }
    for (size_t i = 0; i < RANGES_COUNT; i++) {
        const uint32_t value = value_of(c, i);
        if (value < ranges[i].low || value > ranges[i].high) {
            return 1 + i;
        }
    }
    const bool stereo = c->depth == T3R_DEPTH_STEREO && c->views > 0;
    const struct {
        uint32_t value, low, high;
    } relation[] = {RELATIONS(BOUNDS)};
    for (size_t i = 0; i < sizeof relation / sizeof relation[0]; i++) {
        if (relation[i].value < relation[i].low || relation[i].value > relation[i].high) {
            return 1 + RANGES_COUNT + i;
        }
    }
    /* sizes are summed in size_t */
    return t3r_most_arena_bytes(c) > SIZE_MAX / 2 ? FIRST_FEATURE - 1 : first_need(c);
}

static t3r_status status_of(size_t fault)
{
    return fault == FAULTS ? T3R_OK : fault < FIRST_FEATURE ? T3R_ERR_CONFIG : T3R_ERR_UNSUPPORTED;
}

t3r_status t3r_config_check(const t3r_config *config)
{
    return status_of(first_fault(config));
}

/* Whether no field is set: t3r_default_config() refused, or was not called. */
static bool is_blank(const t3r_config *c)
{
    return c != NULL && (c->width | c->height | c->max_gaussians | c->gaussians) == 0;
}

/* Returns the sentence of a fault. */
static const char *text_of(const t3r_config *c, size_t fault)
{
    return is_blank(c)
               ? "all settings are 0: t3r_default_config() was not called, or met another trim3r.h or other features"
               : texts[fault];
}

const char *t3r_config_error(const t3r_config *config)
{
    const size_t fault = first_fault(config);
    return fault == FAULTS ? NULL : text_of(config, fault);
}

#define VALUE(text, value, low, high) (value),

/* Returns the value of a configuration that is out of its range, UINT64_MAX for another fault. */
static uint64_t value_of_fault(const t3r_config *c, size_t fault)
{
    if (is_blank(c)) {
        return UINT64_MAX;
    }
    if (fault <= RANGES_COUNT) {
        return value_of(c, fault - 1);
    }
    const uint32_t related[] = {RELATIONS(VALUE)};
    const size_t at = fault - 1 - RANGES_COUNT;
    return at < sizeof related / sizeof related[0] ? related[at] : UINT64_MAX;
}

t3r_status t3r_config_fault(const t3r_config *config, t3r_fault *fault)
{
    const size_t at = first_fault(config);
    if (at == FAULTS) {
        return T3R_OK;
    }
    const uint64_t value = value_of_fault(config, at);
    t3r_note(fault, text_of(config, at), (int64_t)value, 0, 0, 0);
    fault->after = value != UINT64_MAX ? " (it is #)" : NULL;
    return status_of(at);
}
