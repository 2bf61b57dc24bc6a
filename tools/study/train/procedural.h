/* SPDX-License-Identifier: Apache-2.0 */
/* Generated pictures with depth: unlimited training data without a licence to ask for.
 *
 * Dead leaves (Lee, Mumford & Huang 2001): objects with sizes by the power law r^-3 that hide each other, which gives
 * the spectrum, the edges and the gradient statistics of natural pictures. Rooms: boxes and round bodies with the same
 * materials, seen by posed cameras. Both end in the same camera: optics, exposure, tone curve, sensor noise.
 *
 * Everything follows from a 64-bit seed through integer arithmetic and IEEE single floats without contraction; machines
 * differ only where their libm rounds differently. Colours are linear light, red green blue, 1 = white paper in the
 * scene's full light. Pixel (0, 0) is the centre of the top-left pixel; cameras look along +z, x right, y down. */
#ifndef TRIM3R_TRAIN_PROCEDURAL_H
#define TRIM3R_TRAIN_PROCEDURAL_H

#include <math.h>
#include <stdbool.h>
#include <stdint.h>

/* ---- numbers ---------------------------------------------------------------------------------------------------- */

typedef struct {
    uint64_t state;
} generator; /* SplitMix64 (Steele et al. 2014) */

static inline uint64_t draw_bits(generator *g)
{
    uint64_t z = g->state += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
}

/* [0, 1), a multiple of 2^-24 */
static inline float draw(generator *g)
{
    return (float)(draw_bits(g) >> 40) * 0x1p-24f;
}

static inline float draw_in(generator *g, float low, float high)
{
    return low + (high - low) * draw(g);
}

/* 0..count-1; the bias is below count / 2^32 */
static inline int draw_index(generator *g, int count)
{
    return (int)(((draw_bits(g) >> 32) * (uint64_t)count) >> 32);
}

static inline bool draw_chance(generator *g, float chance)
{
    return draw(g) < chance;
}

/* Four uniform 16-bit numbers in one draw: mean 0, variance 1, tails to 3.5 */
static inline float draw_normal(generator *g)
{
    uint64_t bits = draw_bits(g);
    int32_t sum = (int32_t)(bits & 0xffff) + (int32_t)(bits >> 16 & 0xffff) + (int32_t)(bits >> 32 & 0xffff) +
                  (int32_t)(bits >> 48);
    return ((float)sum - 131070.0f) * (1.7320508f / 65536.0f);
}

/* Density r^-3 between low and high */
static inline float draw_radius(generator *g, float low, float high)
{
    float u = draw(g);
    return 1.0f / sqrtf(u / (high * high) + (1.0f - u) / (low * low));
}

static inline uint32_t hash2(uint32_t seed, int32_t x, int32_t y)
{
    uint32_t h = seed ^ ((uint32_t)x * 0x9e3779b1u) ^ ((uint32_t)y * 0x85ebca77u);
    h = (h ^ (h >> 16)) * 0x7feb352du;
    h = (h ^ (h >> 15)) * 0x846ca68bu;
    return h ^ (h >> 16);
}

static inline float minf(float a, float b)
{
    return a < b ? a : b;
}

static inline float maxf(float a, float b)
{
    return a > b ? a : b;
}

static inline float clampf(float x, float low, float high)
{
    return minf(maxf(x, low), high);
}

/* Largest integer not above x, for |x| < 2^31 */
static inline int32_t floori(float x)
{
    int32_t i = (int32_t)x;
    return i - (x < (float)i);
}

/* ---- materials -------------------------------------------------------------------------------------------------- */

enum {
    TILE_SIDE_LOG2 = 9, /* tiles repeat after 512 texels */
    TILE_SIDE = 1 << TILE_SIDE_LOG2,
    TILE_TEXELS = (TILE_SIDE * TILE_SIDE * 4 - 1) / 3, /* including all coarser levels */
    GLYPH_COUNT = 96,
    GLYPH_SIDE = 16,
};

typedef enum {
    TILE_ROUGH,   /* 1/f^0.8 */
    TILE_NATURAL, /* 1/f^1.1 */
    TILE_SMOOTH,  /* 1/f^1.7 */
    TILE_RIDGED,  /* cracks, veins */
    TILE_LEAVES,  /* grey dead leaves, with few large ones */
    TILE_PEBBLES, /* grey dead leaves of similar sizes */
    TILE_COUNT,
} tile_kind;

/* Shared by all pictures: tiles with mean 0 and variance 1 (Q12, clipped at 8), and glyphs (signed distance from the
 * stroke's edge, 1/16 glyph heights, positive inside) */
typedef struct {
    int16_t tiles[TILE_COUNT][TILE_TEXELS];
    int8_t glyphs[GLYPH_COUNT][GLYPH_SIDE * GLYPH_SIDE];
} atlas;

typedef enum {
    PATTERN_PLAIN,
    PATTERN_STRIPES,
    PATTERN_CHECKER,
    PATTERN_BRICKS,
    PATTERN_BOOKS,   /* stripes of random widths and colours */
    PATTERN_MOTTLED, /* two colours, separated at a contour of a tile */
    PATTERN_TILE,    /* two colours mixed by a tile */
    PATTERN_GRAIN,   /* a tile stretched along u: wood, brushed metal, grass */
    PATTERN_TEXT,
    PATTERN_COUNT,
} pattern_kind;

/* A surface's reflectance over (u, v); the caller chooses their unit: pixels for leaves, metres for rooms */
typedef struct {
    float colour[3][3];
    pattern_kind pattern;
    uint32_t seed;
    float period;    /* period of stripes, checks, bricks, text lines; width of the whole tile for tiles; in u's unit */
    float duty;      /* share of the first colour, 0..1 */
    float ca, sa;    /* the pattern's rotation */
    tile_kind tile;  /* of the pattern */
    tile_kind weave; /* a tile that varies the lightness everywhere */
    float weave_width, weave_amount, tint_amount;
    float grain_amount; /* amount of the same tile, 9 times finer */
    float offset[2];
} material;

/* The palette of a place: how often each family of colours occurs, and its light */
typedef struct {
    float weight[16];
    float light[3];
} palette;

/* Fills the atlas; false if out of memory */
bool atlas_fill(atlas *shared, uint64_t seed);
/* Returns a tile's value at (u, v) in turns of the tile, filtered for `footprint` turns a pixel */
float tile_at(const atlas *shared, tile_kind tile, float u, float v, float footprint);
/* Returns the glyph's signed distance at (x, y) in 0..1, in glyph heights, positive inside */
float glyph_at(const atlas *shared, uint32_t glyph, float x, float y);
void palette_draw(palette *made, generator *g);
void palette_colour(const palette *from, generator *g, float rgb[3]);
/* Draws a material. `size`: the object's extent in u's unit; `texture`: 0 plain .. 1 busy */
void material_draw(material *made, const palette *from, generator *g, float size, float texture);
/* Draws a material for surfaces that fill the view: walls, floors, large objects. Their colours are muted, like paint.
 */
void material_draw_calm(material *made, const palette *from, generator *g, float size, float texture);
void material_at(const atlas *shared, const material *m, float u, float v, float footprint, float rgb[3]);

/* ---- the camera ------------------------------------------------------------------------------------------------- */

enum { SUBSAMPLES = 3 }; /* 3 x 3 rays per pixel */

typedef struct {
    float exposure; /* linear gain */
    float balance[3];
    float vignette;               /* loss of light in the corner, 0..1 */
    float blur;                   /* standard deviation of the optics, pixels */
    float sharpen;                /* unsharp masking after the tone curve */
    float contrast;               /* contrast of the S-shaped tone curve, 0 = sRGB's */
    float shot_noise, read_noise; /* standard deviations at white and black, of full scale */
    float saturation;
} camera_look;

void look_draw(camera_look *made, generator *g);
/* Returns the gain that brings the picture's geometric mean to `key` of full scale, lowered by up to 0.7 stops if over
 * 2 % would clip */
float look_exposure(const float *linear, int width, int height, float key);
/* linear: [height][width][3], overwritten; scratch: as large; image: [height][width][3] */
void develop(const camera_look *look, generator *noise, int width, int height, float *linear, float *scratch,
             uint8_t *image);
/* Blurs by three passes of a running mean, which approximate a Gaussian; planes of `channels`; scratch is as large
 * as data */
void blur_planes(float *data, float *scratch, int width, int height, int channels, float sigma);

/* The owner of some of a pixel's subsamples: their number, and the sums of their places from the pixel's centre */
typedef struct {
    uint16_t owner;
    float count, x, y;
} seen;

/* Finds each owner that a pixel sees; `owner` has SUBSAMPLES^2 entries a pixel. Returns their number */
int pixel_owners(const uint16_t *owner, int width, int x, int y, seen found[SUBSAMPLES * SUBSAMPLES]);

/* ---- the interface for Python ----------------------------------------------------------------------------------- */

/* Returns an atlas, to be freed by free(); NULL if out of memory. */
atlas *procedural_atlas(void);
/* Draws dead leaves. image: [height][width][3]; depth: [height][width] metres along the axis. Returns 0, or -1 if out
 * of memory or for a side outside 16..2048. */
int procedural_leaves(const atlas *shared, uint64_t seed, int width, int height, uint8_t *image, float *depth);
/* Draws views of a room along one hand-held path. images: [views][height][width][3]; depths: [views][height][width]
 * metres; intrinsics: [views][4] fx fy cx cy pixels; poses: [views][16] camera-to-world, row by row. Returns 0, or -1
 * for the same reasons or for more than 16 views. */
int procedural_room(const atlas *shared, uint64_t seed, int width, int height, int views, uint8_t *images,
                    float *depths, float *intrinsics, float *poses);

#endif
