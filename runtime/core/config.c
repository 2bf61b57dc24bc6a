/* Settings: their defaults and their ranges. */
#include "config.h"

#include "features.h"
#include "fixed.h"
#include "memory.h"

t3r_status t3r_default_config_as(uint64_t digest, void *config, size_t config_bytes, uint32_t width, uint32_t height,
                                 uint32_t views, uint32_t gaussians)
{
    if (config == NULL) {
        return T3R_ERR_ARGUMENT;
    }
    if (digest != t3r_header_interface() || config_bytes != sizeof(t3r_config)) {
        memset(config, 0, config_bytes); /* the caller's, of whatever size */
        return T3R_ERR_INTERFACE;
    }
    *(t3r_config *)config = (t3r_config){
        .width = width,
        .height = height,
        .views = views,
        .max_gaussians = gaussians,
        .gaussians = gaussians,
        .render_width = width,
        .render_height = height,
        .wavelet = T3R_WAVELET_DB2,
        .wavelet_levels = 2,
        .clusters = 0,
        .cluster_batches = 0,
        .colour_weight_q8 = 256,
        .allocation = T3R_ALLOCATE_DENSITY,
        .keep_percent = 10,
        .gamma_q8 = 179, /* 0.7 */
        .head = T3R_HEAD_ANALYTIC,
        .head_column_bytes = T3R_HEAD_COLUMN_BYTES,
        .refinements = T3R_DEFAULT_REFINEMENTS,
        .fit_passes = T3R_FEATURE_LOSS,
        .fit_widths = T3R_FEATURE_COMPARISON,
        .depth = T3R_DEPTH_SENSOR,
        .fill_radius = 4,
        .bridge_radius = 64,
        .flying = 1,
        .redundancy = 1,
        .align = T3R_FEATURE_ALIGN,
        .exposure = 1,
        .keep_analysis = 0,
        .warm = 0,
        .stream = 0,
        .half_life = 32,
        .remember = 0,
        .tile_splats = 0,
        .workers = 1,
        .seed = 1,
    };
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
    switch (c->allocation) {
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

t3r_config t3r_settled(const t3r_config *config)
{
    t3r_config settled = *config;
    settled.clusters = t3r_cluster_count(config);
    settled.cluster_batches = t3r_cluster_batch_count(config);
    return settled;
}

/* X(text, field, low, high), a row a setting. */
#define RANGES(X)                                                                                                      \
    X("width must be 8..4096", width, T3R_MIN_SIDE, T3R_MAX_SIDE)                                                      \
    X("height must be 8..4096", height, T3R_MIN_SIDE, T3R_MAX_SIDE)                                                    \
    X("views must be 0..16", views, 0, T3R_MAX_VIEWS)                                                                  \
    X("max_gaussians must be 1..2^24", max_gaussians, 1, T3R_MAX_GAUSSIANS)                                            \
    X("render_width must be 1..4096", render_width, 1, T3R_MAX_SIDE)                                                   \
    X("render_height must be 1..4096", render_height, 1, T3R_MAX_SIDE)                                                 \
    X("wavelet is none of t3r_wavelet", wavelet, 0, T3R_WAVELET_COUNT - 1)                                             \
    X("wavelet_levels must be 1..5", wavelet_levels, 1, T3R_MAX_LEVELS)                                                \
    X("clusters must be 0..512", clusters, 0, T3R_MAX_CLUSTERS)                                                        \
    X("cluster_batches must be 0..1024", cluster_batches, 0, 1024)                                                     \
    X("colour_weight_q8 must be 0..1024", colour_weight_q8, 0, 1024)                                                   \
    X("allocation is none of t3r_allocation", allocation, T3R_ALLOCATE_CONFIGURED + 1, T3R_ALLOCATE_COUNT - 1)         \
    X("keep_percent must be 0..100", keep_percent, 0, 100)                                                             \
    X("gamma_q8 must be 0..512", gamma_q8, 0, 512)                                                                     \
    X("head is none of t3r_head", head, T3R_HEAD_CONFIGURED + 1, T3R_HEAD_COUNT - 1)                                   \
    X("head_column_bytes must be 0..65536", head_column_bytes, 0, T3R_MAX_HEAD_COLUMN_BYTES)                           \
    X("refinements must be 0..32", refinements, 0, T3R_MAX_REFINEMENTS)                                                \
    X("fit_passes must be 0 or 1", fit_passes, 0, 1)                                                                   \
    X("fit_widths must be 0 or 1", fit_widths, 0, 1)                                                                   \
    X("structural must be 0 or 1", structural, 0, 1)                                                                   \
    X("depth is none of t3r_depth", depth, 0, T3R_DEPTH_COUNT - 1)                                                     \
    X("planes must be 0 or 1", planes, 0, 1)                                                                           \
    X("fill_radius must be 0..8", fill_radius, 0, 8)                                                                   \
    X("bridge_radius must be 0..255", bridge_radius, 0, 255)                                                           \
    X("flying must be 0 or 1", flying, 0, 1)                                                                           \
    X("redundancy must be 0 or 1", redundancy, 0, 1)                                                                   \
    X("align must be 0 or 1", align, 0, 1)                                                                             \
    X("exposure must be 0 or 1", exposure, 0, 1)                                                                       \
    X("keep_analysis must be 0 or 1", keep_analysis, 0, 1)                                                             \
    X("half_life must be 0..1024", half_life, 0, 1024)                                                                 \
    X("remember must be 0..16", remember, 0, T3R_MAX_REMEMBERED)                                                       \
    X("tile_splats must be 0..2^24", tile_splats, 0, T3R_MAX_GAUSSIANS)                                                \
    X("workers must be 1..16", workers, 1, T3R_MAX_WORKERS)

/* X(text, value, low, high), a row a range that depends on other settings, all of which are in theirs. */
#define RELATIONS(X)                                                                                                   \
    X("gaussians must be 1..max_gaussians", c->gaussians, 1, c->max_gaussians)                                         \
    X("width and height must be 32 and more with depth by stereo", T3R_MIN(c->width, c->height),                       \
      stereo ? T3R_STEREO_LEAST_SIDE : 0, T3R_MAX_SIDE)                                                                \
    X("warm must be 0 or 1, and 0 with depth by stereo", c->warm, 0, !stereo)                                          \
    X("stream must be 0 or 1, and 0 without views or with depth by stereo", c->stream, 0, c->views > 0 && !stereo)

/* X(text, features), what a setting needs of the library. */
#define NEEDS(X)                                                                                                       \
    X("this library was built without planes", c->planes ? T3R_HAS_PLANES : 0u)                                        \
    X("this library was built without stereo", c->depth == T3R_DEPTH_STEREO ? T3R_HAS_STEREO : 0u)                     \
    X("this library was built without streams", c->stream ? T3R_HAS_STREAMS : 0u)                                      \
    X("this library was built without this head", t3r_feature_of_head(c->head))                                        \
    X("this library was built without refinement", c->refinements > 0 ? T3R_HAS_REFINEMENT : 0u)                       \
    X("this library was built without fitted passes", c->fit_passes ? T3R_HAS_LOSS : 0u)                               \
    X("this library was built without the structural loss", c->structural ? T3R_HAS_LOSS : 0u)                         \
    X("this library was built without alignment", c->align ? T3R_HAS_ALIGN : 0u)                                       \
    X("this library was built without comparison of views",                                                            \
      c->views > 1 || c->stream || c->fit_widths ? T3R_HAS_COMPARISON : 0u)                                            \
    X("this library was built without this allocation", t3r_feature_of_allocation(c->allocation))                      \
    X("this library was built without this wavelet", t3r_feature_of_wavelet(c->wavelet))                               \
    X("this library was built without several workers", c->workers > 1 ? T3R_HAS_WORKERS : 0u)                         \
    X("this library was built without builds that follow one another", c->warm ? T3R_HAS_WARM : 0u)

/* A field of t3r_config, all of which have 32 bits, and its range. */
typedef struct range {
    uint16_t field;
    uint8_t low;
    uint32_t high;
} range;

#define FIELD_RANGE(text, field, low, high) {offsetof(t3r_config, field), (low), (high)},
static const range ranges[] = {RANGES(FIELD_RANGE)};

#define BOUNDS(text, value, low, high) {(value), (low), (high)},
#define TEXT(text, value, low, high) text,
#define NEED(text, features) (features),
#define NEED_TEXT(text, features) text,
#define ONE_MORE(text, features) +1

/* The texts lie apart, so that a firmware links them only when it asks for them. */
static const char *const texts[] = {
    "no configuration", RANGES(TEXT) RELATIONS(TEXT) "the arena would be larger than this machine can address",
    NEEDS(NEED_TEXT)};

enum {
    RANGES_COUNT = sizeof ranges / sizeof ranges[0],
    NEEDS_COUNT = 0 NEEDS(ONE_MORE),
    FAULTS = sizeof texts / sizeof texts[0],
    FIRST_NEED = FAULTS - NEEDS_COUNT
};

uint64_t t3r_most_arena_bytes(const t3r_config *c)
{
    const uint64_t pixels = (uint64_t)c->width * c->height, gaussians = c->max_gaussians, workers = c->workers;
    /* a worker's part of the wavelet's, the head's, K-means', the budget's and refinement's work */
    const uint64_t worker = pixels * 4 + (uint64_t)(c->width + 15) * (c->head_column_bytes + 32) +
                            T3R_HEAD_KERNEL_BYTES + T3R_CLUSTER_SUMS_BYTES(T3R_MAX_CLUSTERS) +
                            (T3R_MAX_CLUSTERS + 1) * T3R_GROUP_COUNT_BYTES + T3R_WANTED_BYTES + gaussians * 27 + 512;
    const uint64_t fixed = T3R_HEADER_BYTES + T3R_CLUSTER_WORK_BYTES(T3R_MAX_CLUSTERS) +
                           2 * (T3R_MAX_CLUSTERS + 1) * T3R_CLUSTER_BYTES + 2 * T3R_SORT_BYTES +
                           3 * T3R_RATIO_BINS * 4 + T3R_BUFFER_COUNT * T3R_ARENA_ALIGN * (uint64_t)4;
    uint64_t bytes = fixed + pixels * (c->views * (uint64_t)26 + 38) +
                     (uint64_t)c->render_width * c->render_height * 8 + gaussians * 332 + workers * worker;
    /* planes of a quarter more on a side, the right one wider; 64 rows of sums and costs, and as many path states */
    const uint64_t wide = (uint64_t)T3R_MAX_(c->width, c->height) * 5 / 4 + 8 + T3R_STEREO_DISPARITIES;
    bytes +=
        c->depth == T3R_DEPTH_STEREO && c->views > 0 ? wide * wide * 16 + wide * (T3R_STEREO_DISPARITIES + 2) * 300 : 0;
    return t3r_is_stream(c) ? bytes + c->remember * (pixels * 2 + T3R_REMEMBERED_HEAD_BYTES + T3R_ARENA_ALIGN) : bytes;
}

/* The need's text's place, FAULTS when the library has all that the settings ask for. */
static size_t first_need(const t3r_config *c)
{
    const uint32_t needs[] = {NEEDS(NEED)};
    _Static_assert(sizeof needs / sizeof needs[0] == NEEDS_COUNT, "as many texts as needs");
    for (size_t i = 0; i < NEEDS_COUNT; i++) {
        if (!t3r_has(needs[i])) {
            return FIRST_NEED + i;
        }
    }
    return FAULTS;
}

/* The text's place, FAULTS when nothing is wrong. */
static size_t first_fault(const t3r_config *c)
{
    if (c == NULL) {
        return 0;
    }
    for (size_t i = 0; i < RANGES_COUNT; i++) {
        uint32_t value;
        memcpy(&value, (const uint8_t *)c + ranges[i].field, sizeof value);
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
    return t3r_most_arena_bytes(c) > SIZE_MAX / 2 ? FIRST_NEED - 1 : first_need(c);
}

t3r_status t3r_config_check(const t3r_config *config)
{
    const size_t fault = first_fault(config);
    return fault == FAULTS ? T3R_OK : fault < FIRST_NEED ? T3R_ERR_CONFIG : T3R_ERR_UNSUPPORTED;
}

const char *t3r_config_error(const t3r_config *config)
{
    const size_t fault = first_fault(config);
    return fault == FAULTS ? NULL : texts[fault];
}
