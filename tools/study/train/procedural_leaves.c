/* SPDX-License-Identifier: Apache-2.0 */
#include "procedural.h"

#include <stdlib.h>
#include <string.h>

typedef enum {
    SHAPE_ELLIPSE,
    SHAPE_BAR,
    SHAPE_ROUNDED,
    SHAPE_LENS,
    SHAPE_POLYGON,
    SHAPE_RING,
    SHAPE_FRAME,
    SHAPE_ARC,
    SHAPE_BLOB,
    SHAPE_GLYPH,
    SHAPE_COUNT,
} shape_kind;

enum { MAX_LEAVES = 20000, MAX_GROUPS = 8, GROUP_MATERIALS = 10, MAX_SIDES = 7, MAX_LAYERS = 3 };

/* A leaf: s and t run from -1 to 1 over its box, turned by (ca, sa); 1/z = w + wx dx + wy dy, a plane in space */
typedef struct {
    shape_kind shape;
    float x, y, ca, sa, half_s, half_t;
    float w, wx, wy;
    float extra;              /* ring, frame, arc: the thin part's share; blob: the tile's width */
    float side[MAX_SIDES][3]; /* polygon: inside where nx s + ny t < d for all */
    int sides, material;
    uint32_t glyph;
    float gain, shade_s, shade_t; /* lightness = gain (1 + shade_s s + shade_t t) */
    float round, shine;           /* strength of shading as a rounded body, glossiness */
    float offset[2];
} leaf;

/* A group: one kind of clutter with few materials */
typedef struct {
    float x, y, spread_x, spread_y; /* centre and extent, pixels */
    float low, high;                /* sizes */
    float near, far;                /* ratio of the leaves' 1/z to their background's */
    float shapes[SHAPE_COUNT];
    float upright; /* share of leaves parallel to the picture's axes */
    float stretch; /* largest aspect ratio */
    float slant, round, shine;
} group;

typedef struct {
    const atlas *shared;
    int width, height, leaf_count, material_count, layers;
    leaf *leaves;
    material *materials;
    palette colours;
    float light[3]; /* towards the light, as seen in the picture */
    float gradient[2], unevenness, light_width, light_offset;
    float occlusion, shadow_x, shadow_y, shadow_width;
    float focus, aperture; /* 1/metre; pixels of blur per 1/metre */
    /* per subsample */
    float *near;
    uint16_t *owner;
    /* per pixel */
    float *w, *soft, *scratch;
    float *layer[MAX_LAYERS]; /* colour times coverage, coverage */
} painting;

/* ---- leaves ----------------------------------------------------------------------------------------------------- */

static void polygon_draw(leaf *made, generator *g)
{
    made->sides = 3 + draw_index(g, MAX_SIDES - 2);
    float turn = draw_in(g, 0.0f, 6.2831853f);
    for (int i = 0; i < made->sides; i++) {
        float angle = turn + 6.2831853f * ((float)i + draw_in(g, -0.3f, 0.3f)) / (float)made->sides;
        made->side[i][0] = cosf(angle);
        made->side[i][1] = sinf(angle);
        made->side[i][2] = draw_in(g, 0.5f, 0.9f);
    }
}

static void leaf_draw(const painting *p, const group *from, generator *g, leaf *made)
{
    float pick = 0.0f;
    for (int i = 0; i < SHAPE_COUNT; i++) {
        pick += from->shapes[i];
    }
    pick *= draw(g);
    made->shape = SHAPE_ELLIPSE;
    for (int i = 0; i < SHAPE_COUNT - 1 && pick >= from->shapes[i]; i++) {
        pick -= from->shapes[i];
        made->shape = (shape_kind)(i + 1);
    }
    made->x = from->x + from->spread_x * draw_in(g, -1.0f, 1.0f);
    made->y = from->y + from->spread_y * draw_in(g, -1.0f, 1.0f);
    float size = draw_radius(g, from->low, from->high), u = draw(g);
    float aspect = made->shape == SHAPE_GLYPH ? 1.0f : sqrtf(1.0f + (from->stretch - 1.0f) * u * u);
    made->half_s = size * aspect;
    made->half_t = size / aspect;
    float angle = draw_chance(g, from->upright) ? 1.5707963f * (float)draw_index(g, 2) + 0.03f * draw_normal(g)
                                                : draw_in(g, 0.0f, 6.2831853f);
    if (made->shape == SHAPE_GLYPH) {
        angle = 0.1f * draw_normal(g);
    }
    made->ca = cosf(angle);
    made->sa = sinf(angle);
    made->glyph = (uint32_t)draw_bits(g);
    made->extra = draw_in(g, 0.1f, 0.4f);
    if (made->shape == SHAPE_BLOB) {
        made->extra = draw_in(g, 2.0f, 8.0f);
    }
    if (made->shape == SHAPE_POLYGON) {
        polygon_draw(made, g);
    }
    /* nearer than the wall by a ratio, and parallel to it up to a slant that keeps 1/z within 40 % over the leaf */
    const leaf *wall = &p->leaves[0];
    float behind = wall->w + wall->wx * (made->x - wall->x) + wall->wy * (made->y - wall->y);
    float ratio = from->far * powf(from->near / from->far, draw(g));
    made->w = behind * ratio;
    float slant = from->slant * made->w / maxf(made->half_s, made->half_t);
    float x = clampf(draw_normal(g), -2.0f, 2.0f), y = clampf(draw_normal(g), -2.0f, 2.0f);
    made->wx = wall->wx * ratio + slant * x;
    made->wy = wall->wy * ratio + slant * y;
    made->gain = draw_in(g, 0.5f, 1.2f) * (1.0f + 0.4f * (p->light[0] * x + p->light[1] * y) * from->slant * 5.0f);
    made->gain = clampf(made->gain, 0.25f, 1.6f);
    float varied = draw(g);
    made->shade_s = 0.3f * varied * draw_normal(g);
    made->shade_t = 0.3f * varied * draw_normal(g);
    made->round = draw_chance(g, from->round) ? draw_in(g, 0.3f, 1.0f) : 0.0f;
    made->shine = made->round > 0.0f && draw_chance(g, from->shine) ? draw_in(g, 0.1f, 0.8f) : 0.0f;
    made->offset[0] = draw_in(g, -1000.0f, 1000.0f);
    made->offset[1] = draw_in(g, -1000.0f, 1000.0f);
}

static inline bool inside(const painting *p, const leaf *l, const shape_kind shape, float s, float t)
{
    switch (shape) {
    case SHAPE_ELLIPSE:
        return s * s + t * t < 1.0f;
    case SHAPE_BAR:
        return fabsf(s) < 1.0f && fabsf(t) < 1.0f;
    case SHAPE_ROUNDED:
        return s * s * s * s + t * t * t * t < 1.0f;
    case SHAPE_LENS:
        return fabsf(t) < 1.0f - s * s;
    case SHAPE_POLYGON: {
        bool in = true;
        for (int i = 0; i < l->sides; i++) {
            in &= l->side[i][0] * s + l->side[i][1] * t < l->side[i][2];
        }
        return in;
    }
    case SHAPE_RING: {
        float r = s * s + t * t, hole = 1.0f - l->extra;
        return r < 1.0f && r > hole * hole;
    }
    case SHAPE_FRAME: {
        float r = maxf(fabsf(s), fabsf(t));
        return r < 1.0f && r > 1.0f - 0.5f * l->extra;
    }
    case SHAPE_ARC:
        return fabsf(s) < 1.0f && fabsf(t - (1.0f - l->extra) * (2.0f * s * s - 1.0f)) < l->extra;
    case SHAPE_BLOB: {
        float r = s * s + t * t, width = 1.0f / l->extra;
        if (r >= 1.0f) {
            return false;
        }
        float edge = 0.7f + 0.17f * tile_at(p->shared, TILE_SMOOTH, s * width + l->offset[0], t * width, 0.0f);
        return r < edge * edge;
    }
    default:
        return fabsf(s) < 1.0f && fabsf(t) < 1.0f &&
               glyph_at(p->shared, l->glyph, 0.5f * s + 0.5f, 0.5f * t + 0.5f) > 0.0f;
    }
}

static inline __attribute__((always_inline)) void mark(painting *p, int index, const shape_kind shape)
{
    const leaf *l = &p->leaves[index];
    float reach_x = fabsf(l->ca) * l->half_s + fabsf(l->sa) * l->half_t;
    float reach_y = fabsf(l->sa) * l->half_s + fabsf(l->ca) * l->half_t;
    int columns = p->width * SUBSAMPLES, rows = p->height * SUBSAMPLES;
    const float step = 1.0f / SUBSAMPLES, first = 0.5f * step - 0.5f;
    int x0 = floori(clampf((l->x - reach_x - first) * SUBSAMPLES, 0.0f, (float)columns));
    int x1 = floori(clampf((l->x + reach_x - first) * SUBSAMPLES + 1.0f, 0.0f, (float)columns));
    int y0 = floori(clampf((l->y - reach_y - first) * SUBSAMPLES, 0.0f, (float)rows));
    int y1 = floori(clampf((l->y + reach_y - first) * SUBSAMPLES + 1.0f, 0.0f, (float)rows));
    float s_scale = 1.0f / l->half_s, t_scale = 1.0f / l->half_t;
    for (int y = y0; y < y1; y++) {
        float dy = first + step * (float)y - l->y;
        float *near = p->near + (size_t)y * columns;
        uint16_t *owner = p->owner + (size_t)y * columns;
        for (int x = x0; x < x1; x++) {
            float dx = first + step * (float)x - l->x;
            float s = (l->ca * dx + l->sa * dy) * s_scale, t = (l->ca * dy - l->sa * dx) * t_scale;
            float w = l->w + l->wx * dx + l->wy * dy;
            if (w > near[x] && inside(p, l, shape, s, t)) {
                near[x] = w;
                owner[x] = (uint16_t)index;
            }
        }
    }
}

/* One loop per shape, so that the compiler may vectorise the simple ones */
static void mark_leaf(painting *p, int index)
{
    switch (p->leaves[index].shape) {
#define MARK(shape)                                                                                                    \
    case shape:                                                                                                        \
        mark(p, index, shape);                                                                                         \
        break
        MARK(SHAPE_ELLIPSE);
        MARK(SHAPE_BAR);
        MARK(SHAPE_ROUNDED);
        MARK(SHAPE_LENS);
        MARK(SHAPE_POLYGON);
        MARK(SHAPE_RING);
        MARK(SHAPE_FRAME);
        MARK(SHAPE_ARC);
        MARK(SHAPE_BLOB);
    default:
        mark(p, index, SHAPE_GLYPH);
    }
}

/* ---- contents of a place ---------------------------------------------------------------------------------------- */

static void group_draw(const painting *p, group *made, generator *g, float fine)
{
    float side = (float)(p->width < p->height ? p->width : p->height);
    bool everywhere = draw_chance(g, 0.25f);
    made->x = everywhere ? 0.5f * (float)p->width : draw(g) * (float)p->width;
    made->y = everywhere ? 0.5f * (float)p->height : draw(g) * (float)p->height;
    made->spread_x = everywhere ? 0.55f * (float)p->width : side * draw_in(g, 0.08f, 0.5f);
    made->spread_y = everywhere ? 0.55f * (float)p->height : side * draw_in(g, 0.1f, 0.5f);
    float size = draw(g);
    made->low = side * (0.004f + 0.08f * size * size * size * (1.2f - fine) + (draw_chance(g, 0.4f) ? 0.03f : 0.0f));
    made->high = side * draw_in(g, 0.15f, 0.6f);
    if (draw_chance(g, 0.25f)) {
        made->high = made->low * draw_in(g, 2.0f, 6.0f); /* things of one kind: leaves, tins, keys */
    }
    made->far = 1.0f + 0.3f * draw(g) * draw(g);
    made->near = made->far * (1.02f + 3.0f * draw(g) * draw(g));
    for (int i = 0; i < SHAPE_COUNT; i++) {
        float u = draw(g);
        made->shapes[i] = u * u * u;
    }
    made->shapes[SHAPE_BAR] *= 3.0f;
    made->shapes[SHAPE_POLYGON] *= 1.5f;
    made->shapes[SHAPE_RING] *= 0.2f;
    made->shapes[SHAPE_FRAME] *= 0.4f;
    made->shapes[SHAPE_ARC] *= 0.5f;
    made->shapes[SHAPE_GLYPH] *= draw_chance(g, 0.15f) ? 1.0f : 0.0f;
    made->shapes[SHAPE_BLOB] *= 2.0f;
    made->upright = draw_chance(g, 0.5f) ? 0.95f : draw(g);
    made->stretch = 1.5f + 14.0f * draw(g) * draw(g);
    made->slant = draw_in(g, 0.0f, 0.2f);
    made->round = draw(g);
    made->shine = draw(g) * draw(g);
}

static int add_material(painting *p, generator *g, float size, float texture)
{
    material_draw(&p->materials[p->material_count], &p->colours, g, size, texture);
    return p->material_count++;
}

/* Adds half of the picture or a band through it as a plane of its own: ceiling, floor, side wall, table, door */
static void add_surface(painting *p, generator *g, float texture)
{
    leaf *l = &p->leaves[p->leaf_count++];
    const leaf *wall = &p->leaves[0];
    float big = 1.5f * (float)(p->width + p->height), angle = 1.5707963f * (float)draw_index(g, 4);
    memset(l, 0, sizeof *l);
    angle += draw_chance(g, 0.5f) ? 0.3f * draw_normal(g) : 0.02f * draw_normal(g);
    l->shape = SHAPE_BAR;
    l->ca = cosf(angle);
    l->sa = sinf(angle);
    bool half = draw_chance(g, 0.6f);
    l->half_s = big;
    l->half_t = half ? big : (float)p->height * draw_in(g, 0.03f, 0.3f);
    float x = draw_in(g, 0.05f, 0.95f) * (float)p->width, y = draw_in(g, 0.05f, 0.95f) * (float)p->height;
    l->x = half ? x - l->sa * big : x;
    l->y = half ? y + l->ca * big : y;
    float at = (wall->w + wall->wx * (x - wall->x) + wall->wy * (y - wall->y)) * draw_in(g, 1.0f, 1.5f);
    float rise = half ? at * draw_in(g, 0.0f, 2.0f) / (float)p->height : 0.0f;
    l->wx = wall->wx - l->sa * rise;
    l->wy = wall->wy + l->ca * rise;
    l->w = at + l->wx * (l->x - x) + l->wy * (l->y - y);
    l->material = p->material_count++;
    material_draw_calm(&p->materials[l->material], &p->colours, g, (float)p->height * 0.6f, texture * draw(g));
    l->gain = draw_in(g, 0.4f, 1.2f);
    l->offset[0] = draw_in(g, -1000.0f, 1000.0f);
}

/* Adds parts on a leaf: in its box, on its plane, mostly along its axes */
static void add_parts(painting *p, generator *g, const leaf *on, int first, int count, int parts)
{
    float size = minf(on->half_s, on->half_t);
    shape_kind usual = (shape_kind)draw_index(g, SHAPE_COUNT);
    bool rows = draw_chance(g, 0.3f);
    int material_of_all = first + draw_index(g, count);
    for (int i = 0; i < parts && p->leaf_count < MAX_LEAVES; i++) {
        leaf *l = &p->leaves[p->leaf_count++];
        float s = 0.8f * draw_in(g, -1.0f, 1.0f), t = 0.8f * draw_in(g, -1.0f, 1.0f);
        *l = *on;
        l->shape = draw_chance(g, 0.6f) ? usual : (shape_kind)draw_index(g, SHAPE_COUNT);
        if (l->shape == SHAPE_POLYGON) {
            polygon_draw(l, g);
        }
        l->extra = l->shape == SHAPE_BLOB ? draw_in(g, 2.0f, 8.0f) : draw_in(g, 0.1f, 0.4f);
        l->half_s = draw_radius(g, 0.05f, 0.6f) * size;
        l->half_t = l->half_s * draw_in(g, 0.2f, 1.0f);
        if (rows) { /* drawers, windows, keys, lines */
            s = 0.0f;
            t = 1.6f * ((float)i + 0.5f) / (float)parts - 0.8f;
            l->half_s = 0.8f * on->half_s;
            l->half_t = 0.6f * on->half_t / (float)parts;
            l->shape = SHAPE_BAR;
        }
        float u = s * on->half_s, v = t * on->half_t, dx = on->ca * u - on->sa * v, dy = on->sa * u + on->ca * v;
        l->x = on->x + dx;
        l->y = on->y + dy;
        l->w = (on->w + on->wx * dx + on->wy * dy) * 1.004f;
        l->material = rows ? material_of_all : first + draw_index(g, count);
        l->gain = on->gain * draw_in(g, 0.7f, 1.3f);
        l->round = draw_chance(g, 0.3f) ? draw(g) : 0.0f;
        l->shine = 0.0f;
        l->glyph = (uint32_t)draw_bits(g);
        l->offset[0] = draw_in(g, -1000.0f, 1000.0f);
    }
}

static void place_draw(painting *p, generator *g)
{
    float side = (float)(p->width < p->height ? p->width : p->height);
    float busy = draw(g), texture = draw_in(g, 0.1f, 0.9f), metres = 1.2f * powf(10.0f, draw(g));
    palette_draw(&p->colours, g);
    float angle = draw_in(g, 0.0f, 6.2831853f);
    p->light[0] = 0.6f * cosf(angle);
    p->light[1] = -0.2f - 0.5f * draw(g);
    p->light[2] = sqrtf(1.0f - p->light[0] * p->light[0] - p->light[1] * p->light[1]);
    p->gradient[0] = 0.5f * draw_normal(g) * draw(g) / side;
    p->gradient[1] = 0.5f * draw_normal(g) * draw(g) / side;
    p->unevenness = 0.35f * draw(g);
    p->light_width = 1.0f / (side * draw_in(g, 2.0f, 6.0f));
    p->light_offset = draw(g);
    p->occlusion = draw_in(g, 0.2f, 1.0f);
    p->shadow_width = side * draw_in(g, 0.006f, 0.03f);
    p->shadow_x = -p->light[0] * p->shadow_width;
    p->shadow_y = -p->light[1] * p->shadow_width;

    leaf *wall = &p->leaves[p->leaf_count++];
    memset(wall, 0, sizeof *wall);
    wall->shape = SHAPE_BAR;
    wall->ca = 1.0f;
    wall->x = 0.5f * (float)p->width;
    wall->y = 0.5f * (float)p->height;
    wall->half_s = (float)p->width;
    wall->half_t = (float)p->height;
    wall->w = 1.0f / metres;
    wall->wx = wall->w * draw_in(g, -0.6f, 0.6f) / (float)p->width; /* 1/z keeps to 0.4..1.6 of the middle's */
    wall->wy = wall->w * draw_in(g, -0.6f, 0.6f) / (float)p->height;
    wall->gain = 1.0f;
    wall->material = p->material_count++;
    material_draw_calm(&p->materials[wall->material], &p->colours, g, side, 0.7f * texture);
    for (int n = draw_index(g, 7); n > 0; n--) {
        add_surface(p, g, texture);
    }

    int groups = 1 + draw_index(g, MAX_GROUPS);
    if (busy < 0.15f) {
        groups = 1;
    }
    for (int i = 0; i < groups; i++) {
        group made;
        group_draw(p, &made, g, busy);
        int first = p->material_count, count = 2 + draw_index(g, GROUP_MATERIALS - 1);
        float tint = texture * draw(g);
        for (int k = 0; k < count; k++) {
            add_material(p, g, maxf(4.0f * made.low, 0.25f * made.high), tint);
        }
        /* enough to cover the group's own area `cover` times; mean area of a leaf 2 low^2 ln(high / low) x 0.7 pi */
        float mean = 4.4f * made.low * made.low * logf(made.high / made.low);
        float area = minf(4.0f * made.spread_x * made.spread_y, 1.3f * (float)(p->width * p->height));
        float cover = 0.02f + 2.2f * busy * sqrtf(busy) * draw(g);
        int wanted = 1 + (int)minf(cover * area / mean, 6000.0f);
        for (int k = 0; k < wanted && p->leaf_count < MAX_LEAVES; k++) {
            leaf *l = &p->leaves[p->leaf_count];
            leaf_draw(p, &made, g, l);
            l->material = first + draw_index(g, count);
            p->leaf_count++;
            if (maxf(l->half_s, l->half_t) > 0.07f * side && draw_chance(g, 0.55f)) {
                add_parts(p, g, l, first, count, 1 + draw_index(g, 24));
            }
        }
    }
    p->layers = draw_chance(g, 0.2f) ? MAX_LAYERS : 1;
    p->focus = wall->w * (draw_chance(g, 0.5f) ? 1.0f : draw_in(g, 1.0f, 3.0f));
    p->aperture = side * 0.008f * draw(g) / wall->w;
}

/* ---- light ------------------------------------------------------------------------------------------------------ */

static int layer_of(const painting *p, float w)
{
    float ratio = w / p->leaves[0].w;
    return p->layers == 1 ? 0 : ratio > 1.9f ? 2 : ratio > 1.25f ? 1 : 0;
}

static void shade(const painting *p, const leaf *l, float x, float y, float rgb[3])
{
    float dx = x - l->x, dy = y - l->y;
    float u = l->ca * dx + l->sa * dy, v = l->ca * dy - l->sa * dx;
    float s = u / l->half_s, t = v / l->half_t;
    material_at(p->shared, &p->materials[l->material], u + l->offset[0], v + l->offset[1], 1.0f, rgb);
    float light = l->gain * maxf(1.0f + l->shade_s * s + l->shade_t * t, 0.2f);
    if (l->round > 0.0f) {
        bool bar = l->shape == SHAPE_BAR || l->shape == SHAPE_ARC;
        float ns = bar ? 0.0f : s, z = sqrtf(maxf(1.0f - ns * ns - t * t, 0.0f));
        float nx = l->ca * ns - l->sa * t, ny = l->sa * ns + l->ca * t;
        float lit = p->light[0] * nx + p->light[1] * ny + p->light[2] * z;
        light *= 1.0f + l->round * (0.35f + 0.65f * maxf(lit, 0.0f) - 1.0f);
        if (l->shine > 0.0f && lit > 0.8f) {
            float gloss = (lit - 0.8f) * 5.0f;
            for (int c = 0; c < 3; c++) {
                rgb[c] += l->shine * gloss * gloss * gloss * gloss * p->colours.light[c];
            }
        }
    }
    /* Darker where the surroundings towards the light are nearer on average: contact shadows, corners */
    float w = l->w + l->wx * dx + l->wy * dy;
    int sx = (int)clampf(x + p->shadow_x, 0.0f, (float)(p->width - 1));
    int sy = (int)clampf(y + p->shadow_y, 0.0f, (float)(p->height - 1));
    float over = p->soft[sy * p->width + sx] / w - 1.0f;
    if (over > 0.0f) {
        light *= 1.0f - p->occlusion * minf(3.0f * over, 1.0f) * (0.8f - 0.2f * minf(over, 1.0f));
    }
    float uneven = tile_at(p->shared, TILE_SMOOTH, x * p->light_width + p->light_offset, y * p->light_width, 0.0f);
    light *= maxf(1.0f + p->unevenness * uneven, 0.2f);
    light *= maxf(1.0f + p->gradient[0] * (x - 0.5f * (float)p->width) + p->gradient[1] * (y - 0.5f * (float)p->height),
                  0.2f);
    for (int c = 0; c < 3; c++) {
        rgb[c] *= light;
    }
}

/* Shades every leaf that a pixel's subsamples see once, at their mean, weighted by their number */
static void shade_pixel(painting *p, int x, int y)
{
    seen found[SUBSAMPLES * SUBSAMPLES];
    for (int k = pixel_owners(p->owner, p->width, x, y, found), i = 0; i < k; i++) {
        const seen *f = &found[i];
        const leaf *l = &p->leaves[f->owner];
        float rgb[3], share = f->count * (1.0f / (SUBSAMPLES * SUBSAMPLES));
        shade(p, l, (float)x + f->x / f->count, (float)y + f->y / f->count, rgb);
        float *to = p->layer[layer_of(p, l->w)] + 4 * (y * p->width + x);
        for (int c = 0; c < 3; c++) {
            to[c] += share * rgb[c];
        }
        to[3] += share;
    }
}

/* Composes from far to near. The farthest layer is extended into its hidden area; a nearer layer has only its visible
 * part, so that beside a blurred edge of the nearest layer the farthest may show through the middle one. The edge is
 * still soft. */
static void compose(painting *p, float *linear)
{
    int count = p->width * p->height;
    static const float typical[MAX_LAYERS] = {1.0f, 1.5f, 2.6f};
    for (int k = 0; k < p->layers; k++) {
        float sigma = fabsf(typical[k] * p->leaves[0].w - p->focus) * p->aperture;
        if (p->layers > 1 && sigma > 0.3f) {
            blur_planes(p->layer[k], p->scratch, p->width, p->height, 4, minf(sigma, 0.02f * (float)p->width));
        }
        for (int i = 0; i < count; i++) {
            const float *from = p->layer[k] + 4 * i;
            if (k == 0) {
                float scale = 1.0f / maxf(from[3], 1e-3f);
                for (int c = 0; c < 3; c++) {
                    linear[3 * i + c] = from[c] * scale;
                }
                continue;
            }
            float cover = minf(from[3], 1.0f), behind = 1.0f - cover;
            for (int c = 0; c < 3; c++) {
                linear[3 * i + c] = linear[3 * i + c] * behind + from[c];
            }
        }
    }
}

/* ---- the picture ------------------------------------------------------------------------------------------------ */

static bool painting_alloc(painting *p)
{
    size_t pixels = (size_t)p->width * p->height, rays = pixels * SUBSAMPLES * SUBSAMPLES;
    p->leaves = malloc(MAX_LEAVES * sizeof *p->leaves);
    p->materials = malloc((MAX_GROUPS * GROUP_MATERIALS + 8) * sizeof *p->materials);
    p->near = calloc(rays, sizeof *p->near);
    p->owner = calloc(rays, sizeof *p->owner);
    p->w = malloc(pixels * sizeof *p->w);
    p->soft = malloc(pixels * sizeof *p->soft);
    p->scratch = malloc(4 * pixels * sizeof *p->scratch);
    bool all = p->leaves && p->materials && p->near && p->owner && p->w && p->soft && p->scratch;
    for (int i = 0; i < MAX_LAYERS; i++) {
        p->layer[i] = calloc(4 * pixels, sizeof *p->layer[i]);
        all = all && p->layer[i];
    }
    return all;
}

static void painting_free(painting *p)
{
    free(p->leaves);
    free(p->materials);
    free(p->near);
    free(p->owner);
    free(p->w);
    free(p->soft);
    free(p->scratch);
    for (int i = 0; i < MAX_LAYERS; i++) {
        free(p->layer[i]);
    }
}

int procedural_leaves(const atlas *shared, uint64_t seed, int width, int height, uint8_t *image, float *depth)
{
    if (width < 16 || width > 2048 || height < 16 || height > 2048) {
        return -1;
    }
    painting p = {.shared = shared, .width = width, .height = height};
    if (!painting_alloc(&p)) {
        painting_free(&p);
        return -1;
    }
    generator g = {seed};
    camera_look look;
    look_draw(&look, &g);
    place_draw(&p, &g);
    for (int i = 0; i < p.leaf_count; i++) {
        mark_leaf(&p, i);
    }
    int columns = width * SUBSAMPLES;
    for (int y = 0; y < height; y++) {
        for (int x = 0; x < width; x++) { /* the middle ray is the pixel's centre */
            float w = p.near[(size_t)(y * SUBSAMPLES + SUBSAMPLES / 2) * columns + x * SUBSAMPLES + SUBSAMPLES / 2];
            p.w[y * width + x] = w;
            depth[y * width + x] = 1.0f / w;
        }
    }
    memcpy(p.soft, p.w, (size_t)width * height * sizeof *p.soft);
    blur_planes(p.soft, p.scratch, width, height, 1, p.shadow_width);
    for (int y = 0; y < height; y++) {
        for (int x = 0; x < width; x++) {
            shade_pixel(&p, x, y);
        }
    }
    /* the layers are no longer needed: the first holds the picture, the second the camera's scratch */
    float *linear = p.scratch, *rest = p.layer[0];
    if (p.layers > 1) {
        linear = calloc((size_t)width * height * 3, sizeof *linear);
    }
    if (!linear) {
        painting_free(&p);
        return -1;
    }
    compose(&p, linear);
    look.exposure = look_exposure(linear, width, height, draw_in(&g, 0.08f, 0.22f));
    develop(&look, &g, width, height, linear, rest, image);
    if (p.layers > 1) {
        free(linear);
    }
    painting_free(&p);
    return 0;
}

atlas *procedural_atlas(void)
{
    atlas *shared = malloc(sizeof *shared);
    if (shared && !atlas_fill(shared, 0x7472696d3372u)) {
        free(shared);
        shared = NULL;
    }
    return shared;
}
