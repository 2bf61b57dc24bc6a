#include "network.h"

#include "kernels/depthwise.h"
#include "kernels/requantize.h"

#define ROW_ALIGN 16u
#define PERIOD (1 << T3R_MAX_LEVEL) /* image rows after which every layer's progress repeats */
#define NOT_READ INT32_MIN

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
    net->column_pitch = (column + 15) / 16 * 16;
    net->columns = (int16_t *)(void *)work;
    uint64_t at = (uint64_t)net->column_pitch * T3R_DOT_PIXELS * sizeof *net->columns;
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

void t3r_network_begin(t3r_network *net, const void *weights, uint32_t width, uint32_t height, uint32_t begin,
                       void *work)
{
    (void)lay_out(net, weights, width, height, work);
    net->begin = begin;
    skip_rows(net);
}

/* --- activations in and out --------------------------------------------------------------------------------------- */

static uint8_t *row_of(const t3r_node *node, uint32_t y)
{
    return node->rows + (size_t)(y % node->ring) * node->pitch;
}

/* `count` activations from place `first` of a row, to 16 bits. */
static void widen(const t3r_node *node, const uint8_t *row, size_t first, uint32_t count, int16_t *to)
{
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

static void narrow(const t3r_node *node, uint8_t *row, size_t first, uint32_t count, const int16_t *from)
{
    if (node->bytes == 1) {
        int8_t *to = (int8_t *)row + first;
        for (uint32_t i = 0; i < count; i++) {
            to[i] = (int8_t)from[i]; /* held to 8 bits already */
        }
    } else {
        int16_t *to = (int16_t *)(void *)row + first;
        for (uint32_t i = 0; i < count; i++) {
            to[i] = from[i];
        }
    }
}

static void fill(int16_t *to, uint32_t count, int16_t value)
{
    for (uint32_t i = 0; i < count; i++) {
        to[i] = value;
    }
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

/* One source's channels under kernel column kx of kernel row ky. */
static void gather_tap(const window *w, uint32_t source, int64_t x, int32_t ky, int16_t *to)
{
    const t3r_node *node = w->source[source].node;
    const uint8_t *row = w->source[source].row[ky];
    if (row == NULL || x < 0 || x >= w->grid_width) {
        fill(to, node->channels, node->zero);
    } else {
        widen(node, row, (size_t)(x >> w->source[source].coarser) * node->channels, node->channels, to);
    }
}

/* The activations under the kernel of output column x: [kernel][kernel][inputs]. */
static void gather(const window *w, uint32_t x, int16_t *column)
{
    const t3r_layer *layer = w->layer;
    const uint32_t inputs = layer->inputs, run = layer->kernel * inputs;
    const int64_t left = (int64_t)layer->stride * x - padding(layer);
    const bool inside = left >= 0 && left + layer->kernel <= w->grid_width;
    const bool plain = sources_of(layer) == 1 && w->source[0].coarser == 0;
    for (int32_t ky = 0; ky < layer->kernel; ky++, column += run) {
        if (plain && inside && w->source[0].row[ky] != NULL) {
            widen(w->source[0].node, w->source[0].row[ky], (size_t)left * inputs, run, column);
            continue;
        }
        uint32_t channel = 0;
        for (uint32_t i = 0; i < sources_of(layer); i++) {
            for (int32_t kx = 0; kx < layer->kernel; kx++) {
                gather_tap(w, i, left + kx, ky, column + (uint32_t)kx * inputs + channel);
            }
            channel += w->source[i].node->channels;
        }
    }
}

static t3r_requantization requantization_of(const t3r_network *net, const t3r_layer *layer, uint32_t output)
{
    bool narrow_output = net->header.activation_bits == 8 && layer != &net->layers[net->header.layers - 1];
    return (t3r_requantization){
        .multiplier = t3r_le_i32(net->file + layer->multiplier + (size_t)output * 4),
        .shift = (int8_t)net->file[layer->shift + output],
        .zero = layer->zero,
        .low = narrow_output ? INT8_MIN : INT16_MIN,
        .high = narrow_output ? INT8_MAX : INT16_MAX,
    };
}

/* Sums without the bias of one row of weights, that begins at weight `first`, over four columns. Columns go on with
 * zeros up to a multiple of 16, so the loop may as well, as long as there are bytes to read: what they hold does not
 * matter. */
static void dot(const t3r_network *net, const t3r_layer *layer, uint32_t first, int64_t sum[T3R_DOT_PIXELS])
{
    const uint32_t taps = t3r_layer_taps(layer), whole = (taps + 15) / 16 * 16;
    const uint32_t bytes = net->header.weight_bits / 8, at = layer->weights + first * bytes;
    const uint32_t count = net->header.bytes - at >= whole * bytes ? whole : taps;
    const int8_t *w8 = (const int8_t *)net->file + at;
    const t3r_le16 *w16 = (const t3r_le16 *)(const void *)(net->file + at);
    if (net->header.activation_bits == 16) {
        if (bytes == 1) {
            t3r_dot_w8_wide(net->columns, net->column_pitch, w8, count, sum);
        } else {
            t3r_dot_w16_wide(net->columns, net->column_pitch, w16, count, sum);
        }
        return;
    }
    int32_t narrow_sum[T3R_DOT_PIXELS];
    if (bytes == 1) {
        t3r_dot_w8(net->columns, net->column_pitch, w8, count, narrow_sum);
    } else {
        t3r_dot_w16(net->columns, net->column_pitch, w16, count, narrow_sum);
    }
    for (int i = 0; i < T3R_DOT_PIXELS; i++) {
        sum[i] = narrow_sum[i];
    }
}

typedef int16_t pixel_block[T3R_DOT_PIXELS][T3R_MAX_CHANNELS];

static int16_t finish(const t3r_network *net, const t3r_layer *layer, uint32_t bias_row, int64_t sum,
                      const t3r_requantization *r)
{
    if (net->header.activation_bits == 16) {
        return t3r_requantize_wide(t3r_le_i64(net->file + layer->bias + (size_t)bias_row * 8) + sum, r);
    }
    return t3r_requantize((int32_t)(t3r_le_i32(net->file + layer->bias + (size_t)bias_row * 4) + sum), r);
}

/* All outputs of a convolution or point layer for the pixels whose columns were gathered. */
static void multiply(const t3r_network *net, const t3r_layer *layer, uint32_t phase, pixel_block out)
{
    for (uint32_t o = 0; o < layer->outputs; o++) {
        uint32_t row = phase * layer->outputs + o;
        int64_t sum[T3R_DOT_PIXELS];
        dot(net, layer, row * t3r_layer_taps(layer), sum);
        t3r_requantization r = requantization_of(net, layer, o);
        for (int i = 0; i < T3R_DOT_PIXELS; i++) {
            out[i][o] = finish(net, layer, row, sum[i], &r);
        }
    }
}

/* All channels of a depthwise layer for the pixel in `column`. */
static void multiply_depthwise(const t3r_network *net, const t3r_layer *layer, const int16_t *column, int16_t *out)
{
    const uint32_t channels = layer->outputs, taps = t3r_layer_taps(layer);
    const int8_t *w8 = (const int8_t *)net->file + layer->weights;
    const t3r_le16 *w16 = (const t3r_le16 *)(const void *)(net->file + layer->weights);
    int32_t sum[T3R_MAX_CHANNELS];
    int64_t wide[T3R_MAX_CHANNELS];
    bool is_wide = net->header.activation_bits == 16 && net->header.weight_bits == 16;
    if (is_wide) {
        t3r_depthwise_w16_wide(column, w16, taps, channels, wide);
    } else if (net->header.weight_bits == 16) {
        t3r_depthwise_w16(column, w16, taps, channels, sum);
    } else {
        t3r_depthwise_w8(column, w8, taps, channels, sum);
    }
    for (uint32_t c = 0; c < channels; c++) {
        t3r_requantization r = requantization_of(net, layer, c);
        out[c] = finish(net, layer, c, is_wide ? wide[c] : sum[c], &r);
    }
}

/* The next row of plane layer n, counted from 1. */
static void make_row(t3r_network *net, uint32_t n)
{
    const t3r_layer *layer = &net->layers[n - 1];
    t3r_node *node = &net->nodes[n];
    const uint32_t size = (uint32_t)layer->kernel * layer->kernel * layer->inputs, whole = (size + 15) / 16 * 16;
    window w = window_at(net, layer, node->made);
    uint8_t *row = row_of(node, node->made);
    pixel_block out;
    for (uint32_t x = 0; x < node->width; x += T3R_DOT_PIXELS) {
        uint32_t count = T3R_MIN(node->width - x, (uint32_t)T3R_DOT_PIXELS);
        for (uint32_t i = 0; i < T3R_DOT_PIXELS; i++) { /* behind the last pixel, the last again */
            int16_t *column = net->columns + (size_t)i * net->column_pitch;
            gather(&w, x + T3R_MIN(i, count - 1), column);
            fill(column + size, whole - size, 0);
        }
        if (layer->kind == T3R_LAYER_CONV) {
            multiply(net, layer, 0, out);
        }
        for (uint32_t i = 0; i < count; i++) {
            if (layer->kind == T3R_LAYER_DEPTHWISE) {
                multiply_depthwise(net, layer, net->columns + (size_t)i * net->column_pitch, out[i]);
            }
            narrow(node, row, (size_t)(x + i) * node->channels, node->channels, out[i]);
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

/* The inputs of a point layer at one pixel; `before` is what the point layer in front of it gave. */
static void gather_point(const t3r_network *net, uint32_t n, uint32_t x, uint32_t y, const int8_t *features,
                         const int16_t *before, int16_t *column)
{
    const t3r_layer *layer = &net->layers[n];
    for (uint32_t i = 0; i < sources_of(layer); i++) {
        uint32_t source = layer->source[i], channels = T3R_FEATURES;
        if (source == T3R_SOURCE_FEATURES) {
            for (uint32_t c = 0; c < T3R_FEATURES; c++) {
                column[c] = (int16_t)(features[c] * net->nodes[0].factor);
            }
        } else if (source <= net->planes) {
            const t3r_node *node = &net->nodes[source];
            channels = node->channels;
            widen(node, row_of(node, y >> node->level), (size_t)(x >> node->level) * channels, channels, column);
        } else {
            channels = net->layers[source - 1].outputs;
            for (uint32_t c = 0; c < channels; c++) {
                column[c] = before[c];
            }
        }
        column += channels;
    }
    fill(column, (layer->inputs + 15u) / 16 * 16 - layer->inputs, 0);
}

void t3r_network_points(const t3r_network *net, uint32_t y, uint32_t count, const uint32_t *x,
                        const int8_t (*features)[T3R_FEATURES], int16_t (*out)[T3R_HEAD_OUTPUTS])
{
    pixel_block made;
    for (uint32_t n = net->planes; n < net->header.layers; n++) {
        const t3r_layer *layer = &net->layers[n];
        for (uint32_t i = 0; i < T3R_DOT_PIXELS; i++) { /* behind the last point, the last again */
            uint32_t k = T3R_MIN(i, count - 1);
            gather_point(net, n, x[k], y, features[k], made[k], net->columns + (size_t)i * net->column_pitch);
        }
        multiply(net, layer, layer->phases == 1 ? 0 : 2 * (y & 1) + (x[0] & 1), made);
    }
    for (uint32_t i = 0; i < count; i++) {
        for (int o = 0; o < T3R_HEAD_OUTPUTS; o++) {
            out[i][o] = made[i][o];
        }
    }
}
