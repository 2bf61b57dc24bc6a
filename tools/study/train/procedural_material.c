/* SPDX-License-Identifier: Apache-2.0 */
#include "procedural.h"

#include <stdlib.h>
#include <string.h>

/* ---- tiles ------------------------------------------------------------------------------------------------------ */

static int level_offset(int level)
{
    int offset = 0;
    for (int i = 0; i < level; i++) {
        offset += 1 << (2 * (TILE_SIDE_LOG2 - i));
    }
    return offset;
}

/* Adds octaves of smooth noise on a torus, each `keep` times as strong as the next coarser one: amplitude 1/f^(1 -
 * log2 keep) */
static bool add_octaves(float *plane, generator *g, float keep)
{
    static const int coarsest = 2;
    float strength = 1.0f;
    for (int level = coarsest; level <= TILE_SIDE_LOG2; level++) {
        int side = 1 << level, shift = TILE_SIDE_LOG2 - level;
        float *knots = malloc((size_t)side * side * sizeof *knots);
        if (!knots) {
            return false;
        }
        for (int i = 0; i < side * side; i++) {
            knots[i] = draw_normal(g);
        }
        for (int y = 0; y < TILE_SIDE; y++) {
            int y0 = y >> shift, y1 = (y0 + 1) & (side - 1);
            float t = (float)(y - (y0 << shift)) / (float)(1 << shift);
            t = t * t * (3.0f - 2.0f * t);
            for (int x = 0; x < TILE_SIDE; x++) {
                int x0 = x >> shift, x1 = (x0 + 1) & (side - 1);
                float s = (float)(x - (x0 << shift)) / (float)(1 << shift);
                s = s * s * (3.0f - 2.0f * s);
                float top = knots[y0 * side + x0] + s * (knots[y0 * side + x1] - knots[y0 * side + x0]);
                float low = knots[y1 * side + x0] + s * (knots[y1 * side + x1] - knots[y1 * side + x0]);
                plane[y * TILE_SIDE + x] += strength * (top + t * (low - top));
            }
        }
        free(knots);
        strength *= keep;
    }
    return true;
}

/* Draws grey discs, ellipses and lenses on a torus, later ones over earlier ones */
static void fill_leaves(float *plane, generator *g, float low, float high)
{
    enum { EMPTY = 1000 };
    for (int i = 0; i < TILE_SIDE * TILE_SIDE; i++) {
        plane[i] = EMPTY;
    }
    for (int left = TILE_SIDE * TILE_SIDE, n = 0; left > TILE_SIDE && n < 60000; n++) {
        float r = draw_radius(g, low, high), x0 = draw(g) * TILE_SIDE, y0 = draw(g) * TILE_SIDE;
        float angle = draw_in(g, 0.0f, 3.1415927f), ca = cosf(angle), sa = sinf(angle);
        float flat = draw_in(g, 0.3f, 1.0f), grey = draw_normal(g);
        float slope_x = 0.35f * draw_normal(g) / r, slope_y = 0.35f * draw_normal(g) / r;
        bool lens = draw_chance(g, 0.5f);
        for (int y = (int)(y0 - r); y <= (int)(y0 + r) + 1; y++) {
            for (int x = (int)(x0 - r); x <= (int)(x0 + r) + 1; x++) {
                float dx = (float)x - x0, dy = (float)y - y0;
                float u = (ca * dx + sa * dy) / r, v = (ca * dy - sa * dx) / (r * flat);
                bool inside = lens ? fabsf(v) < 1.0f - u * u : u * u + v * v < 1.0f;
                float *at = &plane[(y & (TILE_SIDE - 1)) * TILE_SIDE + (x & (TILE_SIDE - 1))];
                if (inside && *at == EMPTY) {
                    *at = grey + slope_x * dx + slope_y * dy;
                    left--;
                }
            }
        }
    }
    for (int i = 0; i < TILE_SIDE * TILE_SIDE; i++) {
        plane[i] = plane[i] == EMPTY ? -1.0f : plane[i];
    }
}

/* Normalises to mean 0 and variance 1, then makes every coarser level */
static void store_tile(int16_t *tile, float *plane)
{
    double sum = 0.0, squares = 0.0;
    int count = TILE_SIDE * TILE_SIDE;
    for (int i = 0; i < count; i++) {
        sum += plane[i];
        squares += (double)plane[i] * plane[i];
    }
    double mean = sum / count;
    float scale = (float)(1.0 / sqrt(squares / count - mean * mean));
    for (int i = 0; i < count; i++) {
        plane[i] = clampf((plane[i] - (float)mean) * scale, -7.9f, 7.9f);
    }
    for (int level = 0; level <= TILE_SIDE_LOG2; level++) {
        int side = TILE_SIDE >> level;
        int16_t *out = tile + level_offset(level);
        for (int i = 0; i < side * side; i++) {
            out[i] = (int16_t)floori(plane[i] * 4096.0f + 0.5f);
        }
        for (int y = 0; y < side / 2; y++) { /* in place: writes stay behind the reads */
            for (int x = 0; x < side / 2; x++) {
                const float *from = plane + 2 * y * side + 2 * x;
                plane[y * (side / 2) + x] = 0.25f * (from[0] + from[1] + from[side] + from[side + 1]);
            }
        }
    }
}

float tile_at(const atlas *shared, tile_kind tile, float u, float v, float footprint)
{
    float texels = footprint * TILE_SIDE;
    int level = 0;
    while (texels > 1.5f && level < TILE_SIDE_LOG2) {
        texels *= 0.5f;
        level++;
    }
    int side = TILE_SIDE >> level, mask = side - 1;
    const int16_t *plane = shared->tiles[tile] + level_offset(level);
    float x = u * (float)side, y = v * (float)side;
    int32_t x0 = floori(x), y0 = floori(y);
    float s = x - (float)x0, t = y - (float)y0;
    const int16_t *top = plane + (y0 & mask) * side, *low = plane + ((y0 + 1) & mask) * side;
    x0 &= mask;
    int32_t x1 = (x0 + 1) & mask;
    float a = (float)top[x0] + s * (float)(top[x1] - top[x0]);
    float b = (float)low[x0] + s * (float)(low[x1] - low[x0]);
    return (a + t * (b - a)) * (1.0f / 4096.0f);
}

/* ---- glyphs ----------------------------------------------------------------------------------------------------- */

/* Draws two to five strokes between the knots of a 3 x 4 lattice, with the density and joints of letters but of no
 * script */
static void fill_glyph(int8_t *glyph, generator *g)
{
    float x[6], y[6];
    int strokes = 2 + draw_index(g, 4);
    for (int i = 0; i <= strokes; i++) {
        x[i] = 0.25f + 0.2f * (float)draw_index(g, 3);
        y[i] = 0.15f + 0.23f * (float)draw_index(g, 4);
        if (i && draw_chance(g, 0.7f)) { /* mostly upright or level strokes */
            *(draw_chance(g, 0.5f) ? &x[i] : &y[i]) = draw_chance(g, 0.5f) ? x[i - 1] : y[i - 1];
        }
    }
    for (int py = 0; py < GLYPH_SIDE; py++) {
        for (int px = 0; px < GLYPH_SIDE; px++) {
            float best = 1.0f;
            for (int i = 0; i < strokes; i++) {
                float qx = ((float)px + 0.5f) / GLYPH_SIDE - x[i], qy = ((float)py + 0.5f) / GLYPH_SIDE - y[i];
                float ex = x[i + 1] - x[i], ey = y[i + 1] - y[i], length = ex * ex + ey * ey;
                float along = length > 0.0f ? clampf((qx * ex + qy * ey) / length, 0.0f, 1.0f) : 0.0f;
                qx -= along * ex;
                qy -= along * ey;
                best = minf(best, sqrtf(qx * qx + qy * qy));
            }
            glyph[py * GLYPH_SIDE + px] = (int8_t)floori(clampf((0.07f - best) * 256.0f, -127.0f, 127.0f));
        }
    }
}

float glyph_at(const atlas *shared, uint32_t glyph, float x, float y)
{
    const int8_t *d = shared->glyphs[glyph % GLYPH_COUNT];
    float px = clampf(x * GLYPH_SIDE - 0.5f, 0.0f, GLYPH_SIDE - 1.001f);
    float py = clampf(y * GLYPH_SIDE - 0.5f, 0.0f, GLYPH_SIDE - 1.001f);
    int x0 = (int)px, y0 = (int)py;
    float s = px - (float)x0, t = py - (float)y0;
    d += y0 * GLYPH_SIDE + x0;
    float a = (float)d[0] + s * (float)(d[1] - d[0]);
    float b = (float)d[GLYPH_SIDE] + s * (float)(d[GLYPH_SIDE + 1] - d[GLYPH_SIDE]);
    return (a + t * (b - a)) * (1.0f / 256.0f);
}

bool atlas_fill(atlas *shared, uint64_t seed)
{
    generator g = {seed};
    float *plane = malloc((size_t)TILE_SIDE * TILE_SIDE * sizeof *plane);
    memset(shared, 0, sizeof *shared);
    bool good = plane != NULL;
    for (int tile = 0; good && tile < TILE_COUNT; tile++) {
        memset(plane, 0, (size_t)TILE_SIDE * TILE_SIDE * sizeof *plane);
        switch (tile) {
        case TILE_ROUGH:
            good = add_octaves(plane, &g, 1.0f);
            break;
        case TILE_NATURAL:
            good = add_octaves(plane, &g, 0.8f);
            break;
        case TILE_SMOOTH:
            good = add_octaves(plane, &g, 0.55f);
            break;
        case TILE_RIDGED:
            good = add_octaves(plane, &g, 0.65f);
            for (int i = 0; i < TILE_SIDE * TILE_SIDE; i++) {
                plane[i] = -sqrtf(fabsf(plane[i]));
            }
            break;
        case TILE_LEAVES:
            fill_leaves(plane, &g, 1.5f, 90.0f);
            break;
        default:
            fill_leaves(plane, &g, 4.0f, 24.0f);
            break;
        }
        store_tile(shared->tiles[tile], plane);
    }
    free(plane);
    for (int i = 0; i < GLYPH_COUNT; i++) {
        fill_glyph(shared->glyphs[i], &g);
    }
    return good;
}

/* ---- colours ---------------------------------------------------------------------------------------------------- */

typedef struct {
    float hue[2], saturation[2], value[2]; /* hue in turns, all of the sRGB colour */
    float indoor, outdoor;                 /* frequency */
} family;

static const family FAMILIES[] = {
    {{0.06f, 0.14f}, {0.02f, 0.18f}, {0.70f, 0.96f}, 10, 3},   /* walls, paper */
    {{0.00f, 1.00f}, {0.00f, 0.06f}, {0.30f, 0.85f}, 7, 6},    /* greys */
    {{0.05f, 0.12f}, {0.10f, 0.35f}, {0.40f, 0.75f}, 8, 6},    /* beige, stone, skin */
    {{0.04f, 0.11f}, {0.35f, 0.75f}, {0.22f, 0.70f}, 9, 5},    /* wood, leather, earth */
    {{0.00f, 1.00f}, {0.00f, 0.30f}, {0.04f, 0.22f}, 8, 5},    /* black things, shade */
    {{0.55f, 0.64f}, {0.10f, 0.55f}, {0.25f, 0.80f}, 4, 5},    /* blues, sky */
    {{0.18f, 0.36f}, {0.25f, 0.70f}, {0.12f, 0.60f}, 2, 12},   /* foliage */
    {{0.97f, 1.04f}, {0.50f, 0.90f}, {0.30f, 0.80f}, 2, 1},    /* reds, brick */
    {{0.10f, 0.17f}, {0.50f, 0.90f}, {0.55f, 0.95f}, 1.5f, 1}, /* yellow */
    {{0.00f, 1.00f}, {0.35f, 0.95f}, {0.30f, 0.95f}, 2, 0.5f}, /* anything dyed */
};
enum { FAMILY_COUNT = sizeof FAMILIES / sizeof *FAMILIES };

void palette_draw(palette *made, generator *g)
{
    float outdoor = draw_chance(g, 0.65f) ? draw_in(g, 0.0f, 0.3f) : draw_in(g, 0.3f, 1.0f);
    for (int i = 0; i < FAMILY_COUNT; i++) {
        float mean = FAMILIES[i].indoor + outdoor * (FAMILIES[i].outdoor - FAMILIES[i].indoor);
        float u = draw(g);
        made->weight[i] = mean * (0.05f + 3.0f * u * u); /* a place has few of the families */
    }
    float warm = 0.12f * draw_normal(g);
    made->light[0] = 1.0f + warm;
    made->light[1] = 1.0f + 0.02f * draw_normal(g);
    made->light[2] = 1.0f - warm;
}

static float linear_of(float x)
{
    return x * (x * (x * 0.305306011f + 0.682171111f) + 0.012522878f); /* sRGB's curve within 0.3 % of full scale */
}

void palette_colour(const palette *from, generator *g, float rgb[3])
{
    float total = 0.0f;
    for (int i = 0; i < FAMILY_COUNT; i++) {
        total += from->weight[i];
    }
    float pick = draw(g) * total;
    int chosen = 0;
    while (chosen < FAMILY_COUNT - 1 && pick >= from->weight[chosen]) {
        pick -= from->weight[chosen++];
    }
    const family *f = &FAMILIES[chosen];
    float hue = 6.0f * draw_in(g, f->hue[0], f->hue[1]), saturation = draw_in(g, f->saturation[0], f->saturation[1]);
    float value = draw_in(g, f->value[0], f->value[1]);
    for (int i = 0; i < 3; i++) {
        float k = hue + (float)(5 - 2 * i); /* the usual closed form of HSV */
        k -= 6.0f * (float)floori(k / 6.0f);
        float x = value * (1.0f - saturation * clampf(minf(k, 4.0f - k), 0.0f, 1.0f));
        rgb[i] = maxf(linear_of(x) * from->light[i], 0.004f);
    }
}

/* ---- materials -------------------------------------------------------------------------------------------------- */

void material_draw(material *made, const palette *from, generator *g, float size, float texture)
{
    static const float patterned[PATTERN_COUNT] = {0.0f, 1.2f, 0.6f, 1.2f, 1.2f, 2.0f, 3.0f, 2.0f, 1.2f};
    for (int i = 0; i < 3; i++) {
        palette_colour(from, g, made->colour[i]);
    }
    if (draw_chance(g, 0.6f)) { /* mostly shades of one colour */
        float shade = draw_in(g, 0.35f, 0.85f);
        for (int i = 0; i < 3; i++) {
            made->colour[1][i] = shade * made->colour[0][i] + 0.15f * made->colour[1][i] * (1.0f - shade);
        }
    }
    made->pattern = PATTERN_PLAIN;
    if (draw_chance(g, texture)) {
        float total = 0.0f;
        for (int i = 0; i < PATTERN_COUNT; i++) {
            total += patterned[i];
        }
        float pick = draw(g) * total;
        for (int i = 0; i < PATTERN_COUNT - 1 && pick >= patterned[i]; i++) {
            pick -= patterned[i];
            made->pattern = (pattern_kind)(i + 1);
        }
    }
    made->seed = (uint32_t)draw_bits(g);
    made->duty = draw_in(g, 0.2f, 0.8f);
    float angle = draw_chance(g, 0.7f) ? 1.5707963f * (float)draw_index(g, 4) + 0.03f * draw_normal(g)
                                       : draw_in(g, 0.0f, 6.2831853f);
    if (made->pattern == PATTERN_TEXT) {
        angle = 0.06f * draw_normal(g);
    }
    made->ca = cosf(angle);
    made->sa = sinf(angle);
    made->tile = (tile_kind)draw_index(g, TILE_COUNT);
    made->weave = (tile_kind)draw_index(g, 3);
    bool by_tile = made->pattern >= PATTERN_MOTTLED && made->pattern <= PATTERN_GRAIN;
    made->period = by_tile ? size * draw_in(g, 0.5f, 6.0f) : size / draw_radius(g, 1.5f, 14.0f);
    made->weave_width = size * draw_in(g, 0.7f, 6.0f);
    float u = draw(g);
    made->weave_amount = 0.02f + 0.30f * u * u * (0.2f + texture);
    made->grain_amount = draw_chance(g, 0.7f) ? 0.4f * made->weave_amount * draw(g) + 0.04f * draw(g) : 0.0f;
    made->tint_amount = 0.25f * draw(g) * made->weave_amount;
    made->offset[0] = draw(g);
    made->offset[1] = draw(g);
}

void material_draw_calm(material *made, const palette *from, generator *g, float size, float texture)
{
    material_draw(made, from, g, size, texture);
    float keep = draw_chance(g, 0.2f) ? 0.9f : draw_in(g, 0.1f, 0.7f);   /* remaining share of the saturation */
    float lift = draw_chance(g, 0.35f) ? 0.0f : draw_in(g, 0.05f, 0.6f); /* lighter, as most walls are */
    for (int i = 0; i < 3; i++) {
        float *rgb = made->colour[i], grey = 0.25f * rgb[0] + 0.6f * rgb[1] + 0.15f * rgb[2];
        for (int c = 0; c < 3; c++) {
            rgb[c] = grey * from->light[c] + keep * (rgb[c] - grey * from->light[c]);
            rgb[c] += lift * (0.7f * from->light[c] - rgb[c]);
        }
    }
    made->weave_amount *= 0.6f;
}

/* Returns the share of [x - w/2, x + w/2] in the first `duty` of a unit period: an exact box filter */
static float pulse(float x, float w, float duty)
{
    float low = x - 0.5f * w, high = x + 0.5f * w;
    int32_t a = floori(low), b = floori(high);
    float ia = (float)a * duty + minf(low - (float)a, duty), ib = (float)b * duty + minf(high - (float)b, duty);
    return (ib - ia) / w;
}

static float unit_of(uint32_t hash)
{
    return (float)(hash >> 8) * 0x1p-24f;
}

static float smooth_step(float x)
{
    x = clampf(x, 0.0f, 1.0f);
    return x * x * (3.0f - 2.0f * x);
}

/* Returns the share of the first colour; *tint varies a cell's lightness around 1 */
static float pattern_at(const atlas *shared, const material *m, float u, float v, float footprint, float *tint)
{
    float x = (m->ca * u + m->sa * v) / m->period, y = (m->ca * v - m->sa * u) / m->period;
    float w = clampf(footprint / m->period, 1e-4f, 1e3f);
    switch (m->pattern) {
    case PATTERN_STRIPES:
        return pulse(x + m->offset[0], w, m->duty);
    case PATTERN_CHECKER: {
        float a = pulse(x + m->offset[0], w, 0.5f), b = pulse(y + m->offset[1], w, 0.5f);
        return a * b + (1.0f - a) * (1.0f - b);
    }
    case PATTERN_BRICKS: {
        float joint = 0.04f + 0.1f * m->offset[0];
        int32_t row = floori(y);
        float shift = m->offset[1] > 0.4f ? 0.5f * (float)(row & 1) : 0.0f,
              across = x / (1.0f + 2.0f * m->duty) + shift;
        float fade = clampf(1.5f - 2.0f * w, 0.0f, 1.0f);
        *tint = 1.0f + fade * 0.5f * m->offset[0] * (unit_of(hash2(m->seed, floori(across), row)) - 0.5f);
        return pulse(y, w, 1.0f - joint) * pulse(across, w / (1.0f + 2.0f * m->duty), 1.0f - joint);
    }
    case PATTERN_BOOKS: { /* unit cells, each cut once somewhere: widths from 0.2 to 1.6 */
        int32_t cell = floori(x);
        float cut = 0.2f + 0.6f * unit_of(hash2(m->seed, cell, 1)), inside = x - (float)cell;
        float share = smooth_step((inside - cut) / maxf(w, 0.02f) + 0.5f);
        float first = unit_of(hash2(m->seed, cell, 2)), second = unit_of(hash2(m->seed, cell + 1, 2));
        float fade = clampf(1.5f - 2.0f * w, 0.0f, 1.0f), mixed = first + share * (second - first);
        float groove = clampf(1.0f - fabsf(inside - cut) / maxf(w, 0.03f), 0.0f, 1.0f);
        *tint = 1.0f + fade * (0.6f * (2.0f * mixed - 1.0f) - 0.5f * groove);
        return m->duty + fade * (smooth_step(2.0f * (7.0f * mixed - (float)floori(7.0f * mixed)) - 0.5f) - m->duty);
    }
    case PATTERN_MOTTLED: {
        float value = tile_at(shared, m->tile, x + m->offset[0], y + m->offset[1], w);
        return smooth_step((value + 2.0f * m->duty - 1.0f) * 2.5f + 0.5f);
    }
    case PATTERN_TILE:
        return clampf(0.5f + 0.33f * tile_at(shared, m->tile, x + m->offset[0], y + m->offset[1], w), 0.0f, 1.0f);
    case PATTERN_GRAIN: {
        float along = 0.04f + 0.15f * m->duty;
        float value = tile_at(shared, m->tile, along * x + m->offset[0], y + m->offset[1], 0.6f * w);
        return clampf(0.5f + 0.33f * value, 0.0f, 1.0f);
    }
    case PATTERN_TEXT: { /* lines of words; a cell is 0.6 of a line high and 0.45 of a line wide */
        float line = y + m->offset[1];
        int32_t row = floori(line);
        float column = x * 2.2f;
        int32_t cell = floori(column);
        uint32_t hash = hash2(m->seed, cell, row);
        bool blank = (hash & 7) == 0 || (hash2(m->seed, cell >> 4, row) & 3) == 0;
        float ink =
            blank ? -1.0f : glyph_at(shared, hash >> 8, column - (float)cell, (line - (float)row) * 1.5f - 0.25f);
        float below = (line - (float)row) * 1.5f - 0.25f;
        if (below < 0.0f || below > 1.0f) {
            ink = -1.0f;
        }
        float sharp = clampf(ink / maxf(1.5f * w, 0.02f) + 0.5f, 0.0f, 1.0f);
        float fade = clampf(2.0f - 4.0f * w, 0.0f, 1.0f); /* letters far below a pixel become grey lines */
        float grey = blank || below < 0.0f || below > 1.0f ? 0.0f : 0.3f * clampf(2.0f - w, 0.0f, 1.0f);
        return 1.0f - (grey + fade * (sharp - grey));
    }
    default:
        return 1.0f;
    }
}

void material_at(const atlas *shared, const material *m, float u, float v, float footprint, float rgb[3])
{
    float tint = 1.0f, share = pattern_at(shared, m, u, v, footprint, &tint);
    float a = u / m->weave_width + m->offset[1], b = v / m->weave_width + m->offset[0];
    float weave = tile_at(shared, m->weave, a, b, footprint / m->weave_width);
    float fine = 0.0f;
    if (m->grain_amount > 0.0f && footprint * 40.0f < m->weave_width) {
        fine = m->grain_amount * tile_at(shared, m->weave, 9.0f * b, 9.0f * a, 9.0f * footprint / m->weave_width);
    }
    float shade = maxf(tint * (1.0f + m->weave_amount * weave + fine), 0.05f), warm = m->tint_amount * weave;
    rgb[0] = shade * (1.0f + warm) * (m->colour[1][0] + share * (m->colour[0][0] - m->colour[1][0]));
    rgb[1] = shade * (m->colour[1][1] + share * (m->colour[0][1] - m->colour[1][1]));
    rgb[2] = shade * (1.0f - warm) * (m->colour[1][2] + share * (m->colour[0][2] - m->colour[1][2]));
}
