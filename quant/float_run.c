#include "float_run.h"

#include <stdlib.h>
#include <string.h>

/* The layer being run: its weights as [taps][inputs][outputs], so that the innermost loop is contiguous. */
typedef struct run {
    const head_layer *layer;
    const float *bias;
    float *weight;
    const float_plane *from[2];
    uint32_t from_level[2]; /* the sources' levels minus the level of the grid that the kernel walks: >= 0 */
    float_plane *to;
} run;

static float *pack(const head_layer *layer, const float *weight)
{
    const uint32_t fan_in = head_fan_in(layer), taps = head_taps(layer);
    float *packed = malloc(head_weight_count(layer) * sizeof *packed);
    for (uint32_t t = 0; packed != NULL && t < taps; t++) {
        for (uint32_t i = 0; i < fan_in; i++) {
            for (uint32_t o = 0; o < layer->outputs; o++) {
                packed[((size_t)t * fan_in + i) * layer->outputs + o] = weight[head_weight_index(layer, o, i, t)];
            }
        }
    }
    return packed;
}

static const float *pixel(const float_plane *plane, uint32_t x, uint32_t y)
{
    return plane->values + ((size_t)y * plane->width + x) * plane->channels;
}

/* Adds the contributions of the sources at grid position (x, y) through tap t. */
static void add_dense(const run *r, float *out, uint32_t x, uint32_t y, uint32_t t)
{
    const uint32_t outputs = r->layer->outputs;
    const float *weight = r->weight + (size_t)t * r->layer->inputs * outputs;
    for (int s = 0; s < 2 && r->from[s] != NULL; s++) {
        const float *in = pixel(r->from[s], x >> r->from_level[s], y >> r->from_level[s]);
        for (uint32_t i = 0; i < r->from[s]->channels; i++, weight += outputs) {
            for (uint32_t o = 0; o < outputs; o++) {
                out[o] += in[i] * weight[o];
            }
        }
    }
}

static void add_own(const run *r, float *out, uint32_t x, uint32_t y, uint32_t t)
{
    const float *in = pixel(r->from[0], x >> r->from_level[0], y >> r->from_level[0]);
    const float *weight = r->weight + (size_t)t * r->layer->outputs;
    for (uint32_t o = 0; o < r->layer->outputs; o++) {
        out[o] += in[o] * weight[o];
    }
}

static void rectify(const run *r, float *out)
{
    for (uint32_t o = 0; r->layer->relu && o < r->layer->outputs; o++) {
        out[o] = out[o] > 0 ? out[o] : 0;
    }
}

/* Runs a layer's kernel over grid_width x grid_height; outside the grid all is 0. */
static void run_kernel(const run *r, uint32_t grid_width, uint32_t grid_height)
{
    const uint32_t k = r->layer->kernel, s = r->layer->stride, p = (k - s + 1) / 2;
    for (uint32_t y = 0; y < r->to->height; y++) {
        for (uint32_t x = 0; x < r->to->width; x++) {
            float *out = r->to->values + ((size_t)y * r->to->width + x) * r->to->channels;
            memcpy(out, r->bias, r->layer->outputs * sizeof *out);
            for (uint32_t t = 0; t < k * k; t++) {
                uint32_t gx = s * x + t % k - p,
                         gy = s * y + t / k - p; /* before the grid: wraps to a position beyond it */
                if (gx >= grid_width || gy >= grid_height) {
                    continue;
                }
                if (r->layer->kind == T3R_LAYER_DEPTHWISE) {
                    add_own(r, out, gx, gy, t);
                } else {
                    add_dense(r, out, gx, gy, t);
                }
            }
            rectify(r, out);
        }
    }
}

static void run_point(const run *r, const uint8_t *retained)
{
    for (uint32_t y = 0; y < r->to->height; y++) {
        for (uint32_t x = 0; x < r->to->width; x++) {
            if (!retained[(size_t)y * r->to->width + x]) {
                continue;
            }
            uint32_t phase = r->layer->phases == 1 ? 0 : 2 * (y & 1) + (x & 1);
            float *out = r->to->values + ((size_t)y * r->to->width + x) * r->to->channels;
            memcpy(out, r->bias + (size_t)phase * r->layer->outputs, r->layer->outputs * sizeof *out);
            add_dense(r, out, x, y, phase);
            rectify(r, out);
        }
    }
}

static uint32_t level_side(uint32_t side, uint32_t level)
{
    return (side + (1u << level) - 1) >> level;
}

static int run_layer(float_planes *out, const float_head *head, uint32_t n, const uint8_t *retained, uint32_t width,
                     uint32_t height)
{
    const head_layer *layer = &head->graph.layers[n - 1];
    uint32_t grid_level = layer->level + 1 - layer->stride;
    run r = {.layer = layer, .bias = head->layers[n - 1].bias, .to = &out->planes[n]};
    for (int s = 0; s < 2 && layer->sources[s] != T3R_SOURCE_NONE; s++) {
        uint32_t source = layer->sources[s];
        r.from[s] = &out->planes[source];
        r.from_level[s] = (source == 0 ? 0 : head->graph.layers[source - 1].level) - grid_level;
    }
    *r.to = (float_plane){
        .width = level_side(width, layer->level),
        .height = level_side(height, layer->level),
        .channels = layer->outputs,
    };
    r.to->values = calloc((size_t)r.to->width * r.to->height * r.to->channels, sizeof *r.to->values);
    r.weight = pack(layer, head->layers[n - 1].weight);
    if (r.to->values == NULL || r.weight == NULL) {
        free(r.weight);
        return -1;
    }
    if (layer->kind == T3R_LAYER_POINT) {
        run_point(&r, retained);
    } else {
        run_kernel(&r, level_side(width, grid_level), level_side(height, grid_level));
    }
    free(r.weight);
    return 0;
}

int float_run(float_planes *out, const float_head *head, const int8_t *features, const uint8_t *retained,
              uint32_t width, uint32_t height)
{
    size_t count = (size_t)width * height * T3R_FEATURES;
    *out = (float_planes){0};
    float *values = malloc(count * sizeof *values);
    out->planes[0] = (float_plane){.width = width, .height = height, .channels = T3R_FEATURES, .values = values};
    for (size_t i = 0; values != NULL && i < count; i++) {
        values[i] = (float)(features[i] * FLOAT_FEATURE_SCALE);
    }
    int status = values == NULL ? -1 : 0;
    for (uint32_t n = 1; n <= head->graph.count && status == 0; n++) {
        status = run_layer(out, head, n, retained, width, height);
    }
    if (status != 0) {
        float_planes_free(out);
    }
    return status;
}

void float_planes_free(float_planes *planes)
{
    for (int i = 0; i <= T3R_MAX_LAYERS; i++) {
        free(planes->planes[i].values);
    }
    *planes = (float_planes){0};
}
