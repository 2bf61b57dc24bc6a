#include "work_rows.h"

#define MAX(a, b) ((a) > (b) ? (a) : (b))
#define MIN(a, b) ((a) < (b) ? (a) : (b))

/* Rows made so far, of the features and each layer. */
typedef struct stream {
    const head_graph *graph;
    uint32_t height;
    uint32_t made[T3R_MAX_LAYERS + 1];
    uint32_t *held;
} stream;

static uint32_t level_of(const head_graph *graph, uint32_t n)
{
    return n == T3R_SOURCE_FEATURES ? 0 : graph->layers[n - 1].level;
}

static uint32_t rows_of(const stream *s, uint32_t n)
{
    uint32_t level = level_of(s->graph, n);
    return (s->height + (1u << level) - 1) >> level;
}

static bool reads(const head_layer *layer, uint32_t source)
{
    return layer->sources[0] == source || layer->sources[1] == source;
}

/* The source's first and last row behind row `row` of a layer. */
static void span(const stream *s, const head_layer *layer, uint32_t source, uint32_t row, uint32_t *first,
                 uint32_t *last)
{
    uint32_t grid = layer->level + 1 - layer->stride, coarser = level_of(s->graph, source) - grid;
    uint32_t above = (layer->kernel - layer->stride + 1) / 2, from = layer->stride * row;
    *first = (from > above ? from - above : 0) >> coarser;
    *last = MIN((from + layer->kernel - 1 - above) >> coarser, rows_of(s, source) - 1);
}

/* The first row of n that any reader's next row still needs; all rows when there is none. */
static uint32_t oldest_needed(const stream *s, uint32_t n)
{
    uint32_t oldest = rows_of(s, n);
    for (uint32_t m = n + 1; m <= s->graph->count; m++) {
        const head_layer *reader = &s->graph->layers[m - 1];
        if (reads(reader, n) && s->made[m] < rows_of(s, m)) {
            uint32_t first, last;
            span(s, reader, n, s->made[m], &first, &last);
            oldest = MIN(oldest, first);
        }
    }
    return oldest;
}

/* Makes rows of n up to `row`, each as late as it can be. Recursion is as deep as there are layers. */
static void make(stream *s, uint32_t n, uint32_t row)
{
    while (s->made[n] <= row) {
        const head_layer *layer = n == T3R_SOURCE_FEATURES ? NULL : &s->graph->layers[n - 1];
        for (int i = 0; i < 2 && layer != NULL && layer->sources[i] != T3R_SOURCE_NONE; i++) {
            uint32_t first, last;
            span(s, layer, layer->sources[i], s->made[n], &first, &last);
            make(s, layer->sources[i], last);
        }
        s->made[n]++;
        s->held[n] = MAX(s->held[n], s->made[n] - MIN(oldest_needed(s, n), s->made[n] - 1));
    }
}

void head_work_rows(const head_graph *graph, uint32_t height, uint32_t rows[T3R_MAX_LAYERS + 1])
{
    stream s = {.graph = graph, .height = height, .held = rows};
    for (uint32_t n = 0; n <= T3R_MAX_LAYERS; n++) {
        rows[n] = 0;
    }
    for (uint32_t y = 0; y < height; y++) {
        make(&s, graph->count, y);
    }
    for (uint32_t n = 1; n <= graph->count; n++) {
        if (graph->layers[n - 1].kind == T3R_LAYER_POINT) {
            rows[n] = 0;
        }
    }
}

size_t head_work_bytes(const head_graph *graph, uint32_t n, uint32_t rows, uint32_t width, uint32_t activation_bits)
{
    if (n == T3R_SOURCE_FEATURES) {
        return (size_t)rows * width * T3R_FEATURES; /* int8 in any case */
    }
    const head_layer *layer = &graph->layers[n - 1];
    uint32_t bits = n == graph->count ? 16 : activation_bits;
    uint32_t columns = (width + (1u << layer->level) - 1) >> layer->level;
    return (layer->kind == T3R_LAYER_POINT ? 1 : (size_t)rows * columns) * layer->outputs * (bits / 8);
}
