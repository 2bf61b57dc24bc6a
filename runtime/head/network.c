#include "network.h"

#include "core/fixed.h"
#include "core/little_endian.h"
#include "kernels/variants.h"

#define ROW_ALIGN 16u
#define PERIOD (1 << T3R_MAX_LEVEL) /* image rows after which every layer's progress repeats */
#define NOT_READ INT32_MIN

_Static_assert(T3R_MAX_CHANNELS == T3R_LAYER_OUTPUTS, "the kernels hold a layer's outputs");

/* --- geometry ----------------------------------------------------------------------------------------------------- */

static uint32_t level_size(uint32_t size, uint32_t level)
{
    return (size + (1u << level) - 1) >> level;
}

/* The level of the grid that a layer slides over. */
static uint32_t grid_level(const t3r_layer *layer)
{
    return layer->level - (layer->stride - 1u);
}

/* Columns (rows) before its own position at which a kernel begins. */
static int32_t padding(const t3r_layer *layer)
{
    return (layer->kernel - layer->stride + 1) / 2;
}

static uint32_t sources_of(const t3r_layer *layer)
{
    return layer->source[1] == T3R_SOURCE_NONE ? 1 : 2;
}

/* How many rows of each node must have been made when the points of image row y are evaluated, as if the image had no
 * top and no bottom; y may be negative. Held to the image's rows it is what the layers' progress is, so a ring that is
 * high enough without borders is high enough with them. */
static void rows_needed(const t3r_network *net, int32_t y, int32_t need[T3R_MAX_LAYERS + 1])
{
    for (uint32_t n = 0; n <= net->planes; n++) {
        need[n] = NOT_READ;
    }
    for (uint32_t n = net->planes; n < net->header.layers; n++) {
        for (uint32_t i = 0; i < sources_of(&net->layers[n]); i++) {
            uint32_t source = net->layers[n].source[i];
            if (source != T3R_SOURCE_FEATURES && source <= net->planes) {
                need[source] = T3R_MAX(need[source], (y >> net->nodes[source].level) + 1);
            }
        }
    }
    for (uint32_t n = net->planes; n > 0; n--) { /* every plane layer has readers, all of them behind it */
        const t3r_layer *layer = &net->layers[n - 1];
        int32_t bottom = layer->stride * (need[n] - 1) - padding(layer) + layer->kernel - 1;
        for (uint32_t i = 0; i < sources_of(layer); i++) {
            uint32_t source = layer->source[i];
            uint32_t coarser = net->nodes[source].level - grid_level(layer);
            need[source] = T3R_MAX(need[source], (bottom >> coarser) + 1);
        }
    }
}

/* The same, held to the rows that there are. */
static uint32_t rows_due(const t3r_node *node, int32_t need)
{
    return need <= 0 ? 0 : T3R_MIN((uint32_t)need, node->height);
}

/* The rows a ring must keep: in each step, from the first row that a reader's next row reads to the last that is made.
 * All nodes move by 16 >> level rows in 16 image rows, so one period shows every case. */
static void choose_rings(t3r_network *net)
{
    int32_t before[T3R_MAX_LAYERS + 1], now[T3R_MAX_LAYERS + 1];
    rows_needed(net, -1, before);
    for (int32_t y = 0; y < PERIOD; y++) {
        rows_needed(net, y, now);
        for (uint32_t n = 0; n < net->header.layers; n++) {
            const t3r_layer *layer = &net->layers[n];
            bool point = n >= net->planes;
            for (uint32_t i = 0; i < sources_of(layer); i++) {
                uint32_t source = layer->source[i];
                if (point && (source == T3R_SOURCE_FEATURES || source > net->planes)) {
                    continue; /* points bring their features; a point layer has no plane */
                }
                t3r_node *node = &net->nodes[source];
                int32_t first =
                    point ? y >> node->level
                          : (layer->stride * before[n + 1] - padding(layer)) >> (node->level - grid_level(layer));
                int32_t rows = T3R_MAX(now[source] - first, 1);
                node->ring = T3R_MAX(node->ring, (uint32_t)rows);
            }
        }
        for (uint32_t n = 0; n <= net->planes; n++) {
            before[n] = now[n];
        }
    }
}

/* Shape, rings and places of everything, one function for sizing and for running. Returns the bytes. 64 bits suffice:
 * 25 nodes of 2^12 x 2^8 bytes a row and, as a layer looks at most 6 x 16 rows ahead, below 2^12 rows. */
static uint64_t lay_out(t3r_network *net, const void *weights, uint32_t width, uint32_t height, uint8_t *work)
{
    net->file = weights;
    net->header = t3r_weights_header_of(weights);
    net->width = width;
    net->height = height;
    net->planes = 0;
    net->nodes[0] = (t3r_node){.channels = T3R_FEATURES,
                               .bytes = 1,
                               .factor = net->header.activation_bits == 16 ? 256 : 1,
                               .width = width,
                               .height = height};
    uint32_t column = 0;
    for (uint32_t n = 0; n < net->header.layers; n++) {
        t3r_layer *layer = &net->layers[n];
        *layer = t3r_weights_layer(weights, n);
        column = T3R_MAX(column, (uint32_t)layer->kernel * layer->kernel * layer->inputs);
        if (layer->kind != T3R_LAYER_POINT) {
            net->planes = n + 1;
            net->nodes[n + 1] = (t3r_node){
                .level = layer->level,
                .channels = layer->outputs,
                .bytes = net->header.activation_bits / 8,
                .factor = 1,
                .zero = layer->zero,
                .width = level_size(width, layer->level),
                .height = level_size(height, layer->level),
            };
        }
    }
    choose_rings(net);
    net->column_pitch = (column + T3R_COLUMN_TAPS - 1) / T3R_COLUMN_TAPS * T3R_COLUMN_TAPS;
    net->columns = work;
    uint64_t at = (uint64_t)net->column_pitch * T3R_BLOCK_PIXELS * sizeof(int16_t);
    for (uint32_t n = 0; n <= net->planes; n++) {
        t3r_node *node = &net->nodes[n];
        node->pitch = ((size_t)node->width * node->channels * node->bytes + ROW_ALIGN - 1) / ROW_ALIGN * ROW_ALIGN;
        node->rows = work == NULL ? NULL : work + at;
        at += (uint64_t)node->pitch * node->ring;
    }
    return at;
}

size_t t3r_network_work_bytes(const void *weights, uint32_t width)
{
    t3r_network net;
    uint64_t bytes = lay_out(&net, weights, width, 1, NULL);
    return bytes > SIZE_MAX ? SIZE_MAX : (size_t)bytes;
}

/* Each node starts at the first row that the band's points read, by way of all layers between, or a row above it. No
 * row of the band reads what lies further up. */
static void skip_rows(t3r_network *net)
{
    for (uint32_t n = 0; n <= net->planes; n++) {
        net->nodes[n].made = net->begin >> net->nodes[n].level;
    }
    for (uint32_t n = net->planes; n > 0; n--) { /* every plane layer's readers are behind it */
        const t3r_layer *layer = &net->layers[n - 1];
        int32_t top = T3R_MAX((int32_t)(layer->stride * net->nodes[n].made) - padding(layer), 0);
        for (uint32_t i = 0; i < sources_of(layer); i++) {
            t3r_node *source = &net->nodes[layer->source[i]];
            source->made = T3R_MIN(source->made, (uint32_t)top >> (source->level - grid_level(layer)));
        }
    }
}

void t3r_network_begin(t3r_network *net, const t3r_kernels *kernels, const void *weights, uint32_t width,
                       uint32_t height, uint32_t begin, void *work)
{
    (void)lay_out(net, weights, width, height, work);
    net->kernels = kernels;
    net->column_bytes = net->header.activation_bits == 8 ? kernels->column_bytes : 2;
    net->block = T3R_BLOCK_PIXELS * 2 / net->column_bytes;
    net->begin = begin;
    skip_rows(net);
}

/* --- activations in and out --------------------------------------------------------------------------------------- */

static uint8_t *row_of(const t3r_node *node, uint32_t y)
{
    return node->rows + (size_t)(y % node->ring) * node->pitch;
}

/* Whether the kernels take the activations as they lie in rows of 8 bits: no plain C does. */
static bool has_narrow_columns(const t3r_network *net)
{
    return T3R_VARIANTS_COUNT > 0 && net->column_bytes == 1;
}

/* The column of the block's pixel i. */
static uint8_t *column_of(const t3r_network *net, uint32_t i)
{
    return net->columns + (size_t)i * net->column_pitch * net->column_bytes;
}

/* `count` activations from place `first` of a row, to a column from place `at` on. */
static void load(const t3r_network *net, const t3r_node *node, const uint8_t *row, size_t first, uint32_t count,
                 uint8_t *column, uint32_t at)
{
    if (has_narrow_columns(net)) {
        for (uint32_t i = 0; i < count; i++) {
            column[at + i] = row[first + i];
        }
        return;
    }
    int16_t *to = (int16_t *)(void *)column + at;
    if (node->bytes == 1) {
        const int8_t *from = (const int8_t *)row + first;
        for (uint32_t i = 0; i < count; i++) {
            to[i] = (int16_t)(from[i] * node->factor);
        }
    } else {
        const int16_t *from = (const int16_t *)(const void *)row + first;
        for (uint32_t i = 0; i < count; i++) {
            to[i] = from[i];
        }
    }
}

static void fill(const t3r_network *net, uint8_t *column, uint32_t at, uint32_t count, int16_t value)
{
    for (uint32_t i = at; i < at + count; i++) {
        if (has_narrow_columns(net)) {
            ((int8_t *)column)[i] = (int8_t)value;
        } else {
            ((int16_t *)(void *)column)[i] = value;
        }
    }
}

/* Zeros from place `count` on, up to a multiple of T3R_COLUMN_TAPS. */
static void pad(const t3r_network *net, uint8_t *column, uint32_t count)
{
    fill(net, column, count, (T3R_COLUMN_TAPS - count % T3R_COLUMN_TAPS) % T3R_COLUMN_TAPS, 0);
}

/* --- layers ------------------------------------------------------------------------------------------------------- */

/* The rows under a layer's kernel at one of its own rows. */
typedef struct window {
    const t3r_layer *layer;
    uint32_t grid_width;
    struct {
        const t3r_node *node;
        uint32_t coarser;                   /* the source's level above the grid's */
        const uint8_t *row[T3R_MAX_KERNEL]; /* NULL = beyond the grid */
    } source[2];
} window;

static window window_at(const t3r_network *net, const t3r_layer *layer, uint32_t y)
{
    window w = {.layer = layer, .grid_width = level_size(net->width, grid_level(layer))};
    int64_t height = level_size(net->height, grid_level(layer));
    int64_t top = (int64_t)layer->stride * y - padding(layer);
    for (uint32_t i = 0; i < sources_of(layer); i++) {
        const t3r_node *node = &net->nodes[layer->source[i]];
        w.source[i].node = node;
        w.source[i].coarser = node->level - grid_level(layer);
        for (int32_t ky = 0; ky < layer->kernel; ky++) {
            bool inside = top + ky >= 0 && top + ky < height;
            w.source[i].row[ky] = inside ? row_of(node, (uint32_t)(top + ky) >> w.source[i].coarser) : NULL;
        }
    }
    return w;
}

/* One source's channels under kernel column x of kernel row ky, to the column from place `at` on. */
static void gather_tap(const t3r_network *net, const window *w, uint32_t source, int64_t x, int32_t ky, uint8_t *column,
                       uint32_t at)
{
    const t3r_node *node = w->source[source].node;
    const uint8_t *row = w->source[source].row[ky];
    if (row == NULL || x < 0 || x >= w->grid_width) {
        fill(net, column, at, node->channels, node->zero);
    } else {
        size_t first = (size_t)(x >> w->source[source].coarser) * node->channels;
        load(net, node, row, first, node->channels, column, at);
    }
}

/* Whether output column x reads nothing beyond the ends of its rows. */
static bool is_inside(const window *w, uint32_t x)
{
    const int64_t left = (int64_t)w->layer->stride * x - padding(w->layer);
    return left >= 0 && left + w->layer->kernel <= w->grid_width;
}

/* Whether the activations under a row of the kernel lie one behind the other. */
static bool is_plain(const window *w)
{
    return sources_of(w->layer) == 1 && w->source[0].coarser == 0;
}

/* The activations under the kernel of output column x: [kernel][kernel][inputs]. */
static void gather(const t3r_network *net, const window *w, uint32_t x, uint8_t *column)
{
    const t3r_layer *layer = w->layer;
    const uint32_t inputs = layer->inputs, run = layer->kernel * inputs;
    const int64_t left = (int64_t)layer->stride * x - padding(layer);
    const bool whole = is_plain(w) && is_inside(w, x);
    uint32_t at = 0;
    for (int32_t ky = 0; ky < layer->kernel; ky++, at += run) {
        if (whole && w->source[0].row[ky] != NULL) {
            load(net, w->source[0].node, w->source[0].row[ky], (size_t)left * inputs, run, column, at);
            continue;
        }
        uint32_t channel = at;
        for (uint32_t i = 0; i < sources_of(layer); i++) {
            for (int32_t kx = 0; kx < layer->kernel; kx++) {
                gather_tap(net, w, i, left + kx, ky, column, channel + (uint32_t)kx * inputs);
            }
            channel += w->source[i].node->channels;
        }
    }
    pad(net, column, at);
}

/* --- blocks ------------------------------------------------------------------------------------------------------- */

/* `count` columns of so many taps. */
static t3r_block columns_of(const t3r_network *net, uint32_t taps, uint32_t count)
{
    return (t3r_block){.row = (const uint8_t *const *)&net->columns,
                       .rows = 1,
                       .run = taps,
                       .step = net->column_pitch,
                       .pixels = T3R_MIN(count, net->block)};
}

/* Whether the kernels can read a layer's rows where they lie. */
static bool can_read_rows(const t3r_network *net, const window *w)
{
    const uint32_t run = (uint32_t)w->layer->kernel * w->layer->inputs;
    if (!has_narrow_columns(net) || !is_plain(w) || run < T3R_COLUMN_TAPS) {
        return false;
    }
    bool inside = true;
    for (int32_t ky = 0; ky < w->layer->kernel; ky++) {
        inside = inside && w->source[0].row[ky] != NULL;
    }
    return inside;
}

/* Output columns x.. that read nothing beyond the ends of their rows, from those rows. */
static t3r_block rows_of(const window *w, uint32_t x, uint32_t width)
{
    const t3r_layer *layer = w->layer;
    const uint32_t left = layer->stride * x - (uint32_t)padding(layer);
    return (t3r_block){.row = w->source[0].row,
                       .first = left * layer->inputs,
                       .rows = layer->kernel,
                       .run = layer->kernel * layer->inputs,
                       .step = layer->stride * layer->inputs,
                       .pixels = T3R_MIN((w->grid_width - layer->kernel - left) / layer->stride + 1u, width - x)};
}

/* The output columns from x on that are made together. At the ends of a row whose middle is read in place, those that
 * read beyond it come alone. */
static t3r_block next_block(const t3r_network *net, const window *w, uint32_t x, uint32_t width, bool in_place)
{
    if (in_place && is_inside(w, x)) {
        return rows_of(w, x, width);
    }
    t3r_block block = columns_of(net, (uint32_t)w->layer->kernel * w->layer->kernel * w->layer->inputs, 0);
    do {
        gather(net, w, x + block.pixels, column_of(net, block.pixels));
        block.pixels++;
    } while (block.pixels < net->block && x + block.pixels < width && !(in_place && is_inside(w, x + block.pixels)));
    return block;
}

/* The layer for its kernel; phase: of a point layer with four. */
static t3r_convolution convolution_of(const t3r_network *net, const t3r_layer *layer, uint32_t phase)
{
    const bool is_last = layer == &net->layers[net->header.layers - 1];
    const uint32_t taps = t3r_layer_taps(layer), first = phase * layer->outputs;
    const uint32_t weights = layer->weights + first * taps * (net->header.weight_bits / 8);
    return (t3r_convolution){
        .weights = net->file + weights,
        .readable = net->header.bytes - weights,
        .bias = net->file + layer->bias + (size_t)first * (net->header.activation_bits == 16 ? 8 : 4),
        .multiplier = net->file + layer->multiplier,
        .shift = net->file + layer->shift,
        .taps = taps,
        .outputs = layer->outputs,
        .zero = layer->zero,
        .weight_bits = (uint8_t)net->header.weight_bits,
        .activation_bits = (uint8_t)net->header.activation_bits,
        .output_bits = (uint8_t)(is_last ? 16 : net->header.activation_bits),
    };
}

/* The next row of plane layer n, counted from 1. */
static void make_row(t3r_network *net, uint32_t n)
{
    const t3r_layer *layer = &net->layers[n - 1];
    t3r_node *node = &net->nodes[n];
    const t3r_convolution kernel = convolution_of(net, layer, 0);
    window w = window_at(net, layer, node->made);
    uint8_t *row = row_of(node, node->made);
    const bool in_place = can_read_rows(net, &w);
    t3r_block block;
    for (uint32_t x = 0; x < node->width; x += block.pixels) {
        block = next_block(net, &w, x, node->width, in_place);
        void *out = row + (size_t)x * node->channels * node->bytes;
        if (layer->kind == T3R_LAYER_CONV) {
            net->kernels->convolve(&kernel, &block, out, node->channels);
        } else {
            net->kernels->depthwise(&kernel, &block, out, node->channels);
        }
    }
    node->made++;
}

/* --- steps -------------------------------------------------------------------------------------------------------- */

int32_t t3r_network_first(const t3r_network *net)
{
    int32_t need[T3R_MAX_LAYERS + 1];
    int32_t first = (int32_t)(net->begin / PERIOD * PERIOD);
    bool ahead = true;
    while (ahead) { /* each layer looks at most 6 x 16 rows ahead of its reader and behind: at most 24 x 12 turns */
        rows_needed(net, first - 1, need);
        ahead = false;
        for (uint32_t n = 0; n <= net->planes; n++) {
            ahead = ahead || need[n] > (int32_t)net->nodes[n].made;
        }
        first -= ahead ? PERIOD : 0;
    }
    return first;
}

bool t3r_network_wants_features(const t3r_network *net, int32_t y)
{
    int32_t need[T3R_MAX_LAYERS + 1];
    rows_needed(net, y, need);
    return net->nodes[0].made < rows_due(&net->nodes[0], need[0]);
}

int8_t *t3r_network_feature_row(t3r_network *net, uint32_t *y)
{
    *y = net->nodes[0].made++;
    return (int8_t *)row_of(&net->nodes[0], *y);
}

void t3r_network_step(t3r_network *net, int32_t y)
{
    int32_t need[T3R_MAX_LAYERS + 1];
    rows_needed(net, y, need);
    for (uint32_t n = 1; n <= net->planes; n++) {
        uint32_t due = rows_due(&net->nodes[n], need[n]);
        while (net->nodes[n].made < due) {
            make_row(net, n);
        }
    }
}

/* The outputs of a point layer at the pixels of a block. */
typedef union point_outputs {
    int8_t narrow[2 * T3R_BLOCK_PIXELS * T3R_MAX_CHANNELS];
    int16_t wide[T3R_BLOCK_PIXELS * T3R_MAX_CHANNELS];
} point_outputs;

/* The inputs of a point layer at one pixel; `before`: the outputs of the point layer in front of it, a node's row. */
static void gather_point(const t3r_network *net, uint32_t n, uint32_t x, uint32_t y, const int8_t *features,
                         const uint8_t *before, uint8_t *column)
{
    const t3r_layer *layer = &net->layers[n];
    uint32_t at = 0;
    for (uint32_t i = 0; i < sources_of(layer); i++) {
        uint32_t source = layer->source[i], channels = T3R_FEATURES;
        if (source == T3R_SOURCE_FEATURES) {
            load(net, &net->nodes[0], (const uint8_t *)features, 0, T3R_FEATURES, column, at);
        } else if (source <= net->planes) {
            const t3r_node *node = &net->nodes[source];
            channels = node->channels;
            load(net, node, row_of(node, y >> node->level), (size_t)(x >> node->level) * channels, channels, column,
                 at);
        } else {
            const t3r_node made = {.bytes = net->header.activation_bits / 8, .factor = 1};
            channels = net->layers[source - 1].outputs;
            load(net, &made, before, 0, channels, column, at);
        }
        at += channels;
    }
    pad(net, column, at);
}

/* At most a block of pixels; the first of them is `x`, `features`, `out`. */
static uint32_t run_points(const t3r_network *net, uint32_t y, uint32_t count, const uint32_t *x,
                           const int8_t (*features)[T3R_FEATURES], int16_t (*out)[T3R_HEAD_OUTPUTS])
{
    point_outputs made; /* a layer's inputs are gathered before its outputs are written */
    const size_t made_bytes = (size_t)T3R_MAX_CHANNELS * (net->header.activation_bits / 8);
    uint32_t pixels = 0;
    for (uint32_t n = net->planes; n < net->header.layers; n++) {
        const t3r_layer *layer = &net->layers[n];
        const t3r_convolution kernel = convolution_of(net, layer, layer->phases == 1 ? 0 : 2 * (y & 1) + (x[0] & 1));
        const t3r_block block = columns_of(net, kernel.taps, count);
        pixels = block.pixels;
        for (uint32_t i = 0; i < pixels; i++) {
            gather_point(net, n, x[i], y, features[i], (const uint8_t *)made.narrow + i * made_bytes,
                         column_of(net, i));
        }
        if (n + 1 == net->header.layers) {
            net->kernels->convolve(&kernel, &block, out[0], T3R_HEAD_OUTPUTS);
        } else {
            net->kernels->convolve(&kernel, &block, made.narrow, T3R_MAX_CHANNELS);
        }
    }
    return pixels;
}

void t3r_network_points(const t3r_network *net, uint32_t y, uint32_t count, const uint32_t *x,
                        const int8_t (*features)[T3R_FEATURES], int16_t (*out)[T3R_HEAD_OUTPUTS])
{
    for (uint32_t i = 0; i < count;) {
        i += run_points(net, y, count - i, x + i, features + i, out + i);
    }
}
