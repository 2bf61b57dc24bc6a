#include "calibrate.h"

#include <math.h>
#include <stdlib.h>

#include "budget/budget.h"
#include "head/head_features.h"
#include "head/head_views.h"
#include "stages.h"
#include "state/state.h"

/* Histograms by magnitude: OCTAVES x STEPS bins from 2^LOWEST on; bin 0 holds all smaller values, the last all larger
 * ones. */
#define LOWEST (-24)
#define OCTAVES 48
#define STEPS 64
#define BINS (OCTAVES * STEPS)

typedef struct channel {
    float most;
    uint64_t count[BINS];
} channel;

struct calibration {
    const float_head *head;
    uint64_t pixels;
    channel *layers[T3R_MAX_LAYERS]; /* [outputs]; NULL for the last layer */
};

calibration *calibration_start(const float_head *head)
{
    calibration *c = calloc(1, sizeof *c);
    if (c == NULL) {
        return NULL;
    }
    c->head = head;
    for (uint32_t i = 0; i + 1 < head->graph.count; i++) {
        c->layers[i] = calloc(head->graph.layers[i].outputs, sizeof *c->layers[i]);
        if (c->layers[i] == NULL) {
            calibration_free(c);
            return NULL;
        }
    }
    return c;
}

void calibration_free(calibration *c)
{
    for (int i = 0; c != NULL && i < T3R_MAX_LAYERS; i++) {
        free(c->layers[i]);
    }
    free(c);
}

uint64_t calibration_pixels(const calibration *c)
{
    return c->pixels;
}

static size_t bin_of(float value)
{
    int exponent;
    float mantissa = frexpf(value, &exponent); /* [1/2, 1) */
    if (!(value > 0) || exponent <= LOWEST) {
        return 0;
    }
    return exponent > LOWEST + OCTAVES
               ? BINS - 1
               : (size_t)(exponent - 1 - LOWEST) * STEPS + (size_t)((mantissa - 0.5f) * 2 * STEPS);
}

static double upper_edge(size_t bin)
{
    return ldexp(1 + (double)(bin % STEPS + 1) / STEPS, (int)(bin / STEPS) + LOWEST);
}

static void add(channel *to, float value)
{
    float amount = fabsf(value);
    to->most = fmaxf(to->most, amount);
    to->count[bin_of(amount)]++;
}

static void add_plane(channel *to, const float_plane *plane, const uint8_t *only)
{
    size_t pixels = (size_t)plane->width * plane->height;
    for (size_t i = 0; i < pixels; i++) {
        for (uint32_t ch = 0; ch < plane->channels && (only == NULL || only[i]); ch++) {
            add(&to[ch], plane->values[i * plane->channels + ch]);
        }
    }
}

int calibration_add(calibration *c, const int8_t *features, const uint8_t *retained, uint32_t width, uint32_t height)
{
    float_planes planes;
    if (float_run(&planes, c->head, features, retained, width, height) != 0) {
        return -1;
    }
    for (uint32_t i = 0; i + 1 < c->head->graph.count; i++) {
        bool point = c->head->graph.layers[i].kind == T3R_LAYER_POINT;
        add_plane(c->layers[i], &planes.planes[i + 1], point ? retained : NULL);
    }
    c->pixels += (uint64_t)width * height;
    float_planes_free(&planes);
    return 0;
}

int calibration_add_views(calibration *c, const t3r_runtime *rt)
{
    if (!rt->has_scene || !rt->analysed || !rt->config.keep_analysis) {
        return -1;
    }
    const uint32_t width = rt->config.width, height = rt->config.height;
    t3r_view views[T3R_MAX_VIEWS];
    t3r_views_of(rt, views);
    const t3r_budget_settings settings = t3r_budget_settings_of(rt, views);
    int8_t *features = malloc((size_t)width * height * T3R_FEATURES);
    uint8_t *retained = malloc((size_t)width * height);
    int status = features == NULL || retained == NULL ? -1 : 0;
    for (uint32_t v = 0; v < rt->views && status == 0; v++) {
        const t3r_head_input input = t3r_head_input_of(rt, views, v, &settings);
        for (uint32_t y = 0; y < height; y++) {
            t3r_head_features(&input, y, features + (size_t)y * width * T3R_FEATURES);
        }
        for (size_t i = 0; i < (size_t)width * height; i++) {
            retained[i] = t3r_retained(&views[v], i);
        }
        status = calibration_add(c, features, retained, width, height);
    }
    free(features);
    free(retained);
    return status;
}

static double range_of(const channel *ch, double percentile)
{
    uint64_t all = 0, below = 0;
    for (size_t b = 0; b < BINS; b++) {
        all += ch->count[b];
    }
    for (size_t b = 0; b < BINS; b++) {
        below += ch->count[b];
        if ((double)below >= percentile / 100 * (double)all) {
            return percentile < 100 && b + 1 < BINS ? fmin(upper_edge(b), ch->most) : ch->most;
        }
    }
    return ch->most;
}

static int finish_layer(const channel *channels, uint32_t outputs, double percentile, double headroom, float **range)
{
    float largest = 0;
    *range = malloc(outputs * sizeof **range);
    if (*range == NULL) {
        return -1;
    }
    for (uint32_t o = 0; o < outputs; o++) {
        (*range)[o] = (float)(range_of(&channels[o], percentile) * headroom);
        largest = fmaxf(largest, (*range)[o]);
    }
    for (uint32_t o = 0; o < outputs; o++) {
        if (!((*range)[o] > 0)) {
            (*range)[o] = largest > 0 ? largest : 1;
        }
    }
    return 0;
}

int calibration_finish(const calibration *c, float_head *head, double percentile, double headroom)
{
    int lacking = 0;
    for (uint32_t i = 0; i + 1 < head->graph.count; i++) {
        if (head->layers[i].range != NULL) {
            continue;
        }
        if (c->pixels == 0 || finish_layer(c->layers[i], head->graph.layers[i].outputs, percentile, headroom,
                                           &head->layers[i].range) != 0) {
            return -1;
        }
        lacking++;
    }
    return lacking;
}
