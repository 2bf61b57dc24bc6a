/* SPDX-License-Identifier: Apache-2.0 */
#include "room/texture.h"

#include "core/fixed.h"

static uint32_t hash3(uint32_t seed, int64_t x, int64_t y)
{
    return t3r_mix32(t3r_mix32(seed + (uint32_t)x * 0x9e3779b1u) + (uint32_t)y * 0x85ebca77u);
}

/* Returns -32768..32767 at a lattice point. */
static int64_t lattice(uint32_t seed, int64_t x, int64_t y)
{
    return (int64_t)(hash3(seed, x, y) >> 16) - 32768;
}

/* Returns 3 t^2 - 2 t^3 of the 16 fraction bits, in Q12. */
static int64_t smooth_q12(int64_t x)
{
    int64_t t = (x & 0xffff) >> 4;
    return (t * t * (3 * 4096 - 2 * t)) >> 24;
}

/* Returns value noise, Q15 in -1..1; u and v in cells, Q16. */
static int64_t noise(uint32_t seed, int64_t u, int64_t v)
{
    int64_t x = u >> 16, y = v >> 16;
    int64_t s = smooth_q12(u), t = smooth_q12(v);
    int64_t top = lattice(seed, x, y) * (4096 - s) + lattice(seed, x + 1, y) * s;
    int64_t bottom = lattice(seed, x, y + 1) * (4096 - s) + lattice(seed, x + 1, y + 1) * s;
    return (top * (4096 - t) + bottom * t) >> 24;
}

/* Sums octaves of noise, each half as wide and `keep` / 256 as strong as the previous one, starting with cells of
 * `cell` (Q16 metres); octaves finer than the footprint fade out. Q15, roughly -1..1. */
static int64_t octaves(uint32_t seed, int64_t u, int64_t v, int64_t cell, uint32_t count, int64_t keep,
                       int64_t footprint)
{
    int64_t sum = 0, strength = 128 * 256;
    for (uint32_t i = 0; i < count && cell > footprint; i++) {
        int64_t here = cell < 2 * footprint ? strength * (cell - footprint) / footprint : strength;
        sum += here * noise(seed + i * 0x632be5abu, u * 65536 / cell, v * 65536 / cell);
        strength = strength * keep >> 8;
        cell /= 2;
    }
    return sum >> 16;
}

static room_colour rgb(int32_t r, int32_t g, int32_t b)
{
    return (room_colour){{r * 16, g * 16, b * 16}};
}

/* Returns colour x (1 + amount), amount in Q15. */
static room_colour scaled(room_colour a, int64_t amount_q15)
{
    for (int i = 0; i < 3; i++) {
        a.c[i] = (int32_t)t3r_clamp64((a.c[i] * (32768 + amount_q15)) >> 15, 0, 4080);
    }
    return a;
}

/* Returns a for a share of 0, b for 256. */
static room_colour mixed(room_colour a, room_colour b, int64_t share)
{
    share = t3r_clamp64(share, 0, 256);
    for (int i = 0; i < 3; i++) {
        a.c[i] = (int32_t)((a.c[i] * (256 - share) + b.c[i] * share) >> 8);
    }
    return a;
}

/* Returns how much of a footprint, at `offset` from the centre of a line of that half width, the line covers,
 * 0..256. */
static int64_t line(int64_t offset, int64_t half_width, int64_t footprint)
{
    int64_t low = T3R_MAX(-half_width, t3r_abs64(offset) - footprint / 2);
    int64_t high = T3R_MIN(half_width, t3r_abs64(offset) + footprint / 2);
    return high <= low ? 0 : T3R_MIN(256, (high - low) * 256 / T3R_MAX(footprint, 1));
}

/* Returns the offset from the nearest multiple of `pitch`. */
static int64_t from_multiple(int64_t x, int64_t pitch)
{
    int64_t rest = x % pitch;
    return rest > pitch / 2 ? rest - pitch : rest;
}

static room_colour wood(room_colour base, uint32_t seed, int64_t across, int64_t length, int64_t footprint)
{
    int64_t bend = octaves(seed + 1, across, length, ROOM_MM(400), 2, 128, footprint) * ROOM_MM(24) >> 15;
    int64_t grain = octaves(seed, across + bend, length / 10, ROOM_MM(34), 5, 190, footprint);
    return scaled(base, grain * 5 / 16);
}

static room_colour rug(uint32_t seed, int64_t u, int64_t v, int64_t footprint)
{
    int64_t a = t3r_abs64(from_multiple(u, ROOM_MM(300))), b = t3r_abs64(from_multiple(v, ROOM_MM(300)));
    room_colour colour = a + b < ROOM_MM(75)    ? rgb(212, 178, 108)
                         : a + b < ROOM_MM(130) ? rgb(52, 62, 104)
                                                : rgb(146, 48, 42);
    return scaled(colour, octaves(seed, u, v, ROOM_MM(64), 6, 215, footprint) * 5 / 16);
}

static room_colour floor_boards(uint32_t seed, int64_t u, int64_t v, int64_t footprint)
{
    /* the rug lies in front of the table */
    int64_t x = u - ROOM_MM(1050), z = v - ROOM_MM(2200);
    if (x >= 0 && x < ROOM_MM(2000) && z >= 0 && z < ROOM_MM(1500)) {
        bool border = x < ROOM_MM(60) || x >= ROOM_MM(1940) || z < ROOM_MM(60) || z >= ROOM_MM(1440);
        return border ? scaled(rgb(208, 192, 160), octaves(seed + 7, u, v, ROOM_MM(64), 6, 215, footprint) * 5 / 16)
                      : rug(seed + 8, x, z, footprint);
    }
    int64_t board = u / ROOM_MM(145);
    int64_t shifted = v + (int64_t)(hash3(seed, board, 3) % (uint32_t)ROOM_MM(1100));
    int64_t piece = shifted / ROOM_MM(1100);
    uint32_t own = hash3(seed + 5, board, piece);
    room_colour colour = scaled(rgb(158, 112, 70), (int64_t)(own >> 17) * 3 / 8 - 6000);
    colour = wood(colour, own, u, v, footprint);
    int64_t gap = line(from_multiple(u, ROOM_MM(145)), ROOM_MM(2), footprint) +
                  line(from_multiple(shifted, ROOM_MM(1100)), ROOM_MM(2), footprint);
    return mixed(colour, rgb(52, 34, 22), gap);
}

static room_colour brick(uint32_t seed, int64_t u, int64_t v, int64_t footprint)
{
    int64_t course = v / ROOM_MM(75);
    int64_t shifted = u + (course & 1) * ROOM_MM(115);
    int64_t stone = shifted / ROOM_MM(230);
    uint32_t own = hash3(seed, stone, course);
    room_colour colour = mixed(rgb(160, 86, 62), rgb(122, 70, 58), (int64_t)(own & 255));
    colour = scaled(colour, (int64_t)(own >> 19) - 4096);
    colour = scaled(colour, octaves(seed + 2, u, v, ROOM_MM(90), 6, 205, footprint) * 5 / 16);
    room_colour mortar = scaled(rgb(178, 170, 158), octaves(seed + 3, u, v, ROOM_MM(30), 4, 200, footprint) / 5);
    int64_t joint = line(from_multiple(v, ROOM_MM(75)), ROOM_MM(5), footprint);
    joint = T3R_MAX(joint, line(from_multiple(shifted, ROOM_MM(230)), ROOM_MM(5), footprint));
    return mixed(colour, mortar, joint);
}

static room_colour plaster(uint32_t seed, int64_t u, int64_t v, int64_t footprint)
{
    room_colour colour = scaled(rgb(196, 200, 186), octaves(seed, u, v, ROOM_MM(700), 8, 200, footprint) / 14);
    /* a skirting board */
    return mixed(colour, rgb(228, 224, 214), v > ROOM_MM(2880) ? 256 : 0);
}

/* Draws a landscape of 1/f noise under a sky of the same. */
static room_colour canvas(uint32_t seed, int64_t u, int64_t v, int64_t footprint)
{
    int64_t ridge = ROOM_MM(300) + (octaves(seed, u, 0, ROOM_MM(260), 6, 140, footprint) * ROOM_MM(150) >> 15);
    int64_t shore = ROOM_MM(470) + (octaves(seed + 1, u, 0, ROOM_MM(200), 6, 140, footprint) * ROOM_MM(60) >> 15);
    int64_t cloud = octaves(seed + 2, u, v * 2, ROOM_MM(300), 8, 190, footprint);
    int64_t rough = octaves(seed + 3, u, v, ROOM_MM(120), 8, 215, footprint);
    if (v < ridge) {
        return mixed(rgb(92, 132, 178), rgb(240, 226, 204), 110 + (cloud >> 7) + v * 90 / ROOM_MM(660));
    }
    if (v < shore) {
        return scaled(mixed(rgb(58, 84, 66), rgb(120, 112, 72), 110 + (rough >> 7)), cloud / 4);
    }
    return scaled(mixed(rgb(168, 138, 82), rgb(84, 66, 46), 90 + (rough >> 6)), rough / 4);
}

static room_colour cardboard(uint32_t seed, const room_hit *hit, int64_t u, int64_t v, int64_t footprint)
{
    room_colour colour = scaled(rgb(182, 142, 98), octaves(seed, u, v, ROOM_MM(80), 6, 200, footprint) / 7);
    if (hit->axis == 1) {
        return mixed(colour, rgb(214, 196, 150), line(v - ROOM_MM(145), ROOM_MM(25), footprint));
    }
    /* printing: lines of marks */
    int64_t row = v / ROOM_MM(18), column = u / ROOM_MM(9);
    bool inked = v > ROOM_MM(70) && v < ROOM_MM(180) && u > ROOM_MM(50) && u < ROOM_MM(250) &&
                 v % ROOM_MM(18) < ROOM_MM(11) && hash3(seed + hit->axis, column, row) % 5 != 0;
    return mixed(colour, rgb(58, 44, 36), inked ? 210 : 0);
}

static room_colour crate(uint32_t seed, int64_t u, int64_t v, int64_t side, int64_t footprint)
{
    int64_t edge = T3R_MIN(T3R_MIN(u, side - u), T3R_MIN(v, side - v));
    bool rim = edge < ROOM_MM(55);
    bool upright = u < ROOM_MM(55) || u > side - ROOM_MM(55);
    room_colour base = rim ? rgb(190, 150, 100) : rgb(168, 126, 80);
    room_colour colour =
        wood(base, seed + hash3(seed, upright, v / ROOM_MM(104)), upright ? u : v, upright ? v : u, footprint);
    int64_t gap = rim ? 0 : line(from_multiple(v, ROOM_MM(104)), ROOM_MM(4), footprint);
    gap = T3R_MAX(gap, line(edge - ROOM_MM(55), ROOM_MM(3), footprint));
    return mixed(colour, rgb(56, 38, 24), gap);
}

/* Draws rows of books between boards; other faces are plain wood. */
static room_colour shelf(uint32_t seed, const room_hit *hit, int64_t u, int64_t v, int64_t footprint)
{
    static const uint8_t spines[8][3] = {{134, 40, 38}, {38, 70, 108},   {52, 92, 62}, {196, 170, 110},
                                         {96, 58, 88},  {218, 210, 196}, {58, 54, 54}, {188, 108, 48}};
    room_colour board = wood(rgb(118, 82, 54), seed, v, u, footprint);
    int64_t in_row = v % ROOM_MM(316), row = v / ROOM_MM(316);
    if (hit->axis != 2 || in_row < ROOM_MM(28) || u < ROOM_MM(28) || u > ROOM_MM(1172)) {
        return board;
    }
    int64_t index = u / ROOM_MM(44);
    uint32_t own = hash3(seed, index, row);
    int64_t height = ROOM_MM(190) + (int64_t)(own >> 8 & 63) * ROOM_MM(80) / 64;
    int64_t from_top = in_row - (ROOM_MM(316) - height);
    if (from_top < 0 || own % 11 == 0) {
        return scaled(rgb(44, 32, 24), octaves(seed + 4, u, v, ROOM_MM(60), 4, 180, footprint) / 5);
    }
    const uint8_t *c = spines[own >> 16 & 7];
    room_colour colour = scaled(rgb(c[0], c[1], c[2]), (int64_t)(own >> 22 & 1023) * 10 - 5000);
    colour = scaled(colour, octaves(own, u, v, ROOM_MM(40), 5, 200, footprint) / 7);
    int64_t across = u % ROOM_MM(44), place = ROOM_MM(30) + (int64_t)(own >> 4 & 15) * ROOM_MM(6);
    if (from_top > place && from_top < place + ROOM_MM(60) && across > ROOM_MM(14) && across < ROOM_MM(30) &&
        hash3(own, from_top / ROOM_MM(7), across / ROOM_MM(5)) % 3 != 0) {
        colour = mixed(colour, rgb(226, 204, 148), 200);
    }
    return mixed(colour, rgb(24, 20, 18), line(from_multiple(u, ROOM_MM(44)), ROOM_MM(3), footprint));
}

static room_colour marble(uint32_t seed, const room_hit *hit, int64_t footprint)
{
    int64_t u = hit->local.v[0] + hit->local.v[2] / 2, v = hit->local.v[1] - hit->local.v[2] / 3;
    int64_t warp = octaves(seed, u, v, ROOM_MM(140), 6, 150, footprint);
    int64_t vein = noise(seed + 9, (u + (warp * ROOM_MM(120) >> 15)) * 65536 / ROOM_MM(60), (v * 65536) / ROOM_MM(110));
    int64_t sharp = 256 - t3r_abs64(vein) * 3 / 128;
    return mixed(scaled(rgb(222, 220, 214), warp / 10), rgb(74, 84, 96), T3R_MAX(sharp, 0) * 7 / 8);
}

static room_colour granite(uint32_t seed, int64_t u, int64_t v, int64_t footprint)
{
    int64_t speck = octaves(seed, u, v, ROOM_MM(32), 4, 240, footprint);
    return scaled(rgb(112, 124, 128), speck * 7 / 8);
}

static room_colour cloth(uint32_t seed, int64_t u, int64_t v, int64_t footprint)
{
    bool check = ((u / ROOM_MM(38)) + (v / ROOM_MM(38))) & 1;
    room_colour colour = check ? rgb(62, 118, 128) : rgb(214, 206, 188);
    return scaled(colour, octaves(seed, u, v, ROOM_MM(24), 4, 220, footprint) / 4);
}

room_colour room_texture(const room_hit *hit, uint32_t seed, int64_t footprint)
{
    /* surface coordinates, both at least 0 for boxes and the shell; unused for spheres */
    uint32_t own = t3r_mix32(seed * 0x01000193u + hit->solid * 16 + (uint32_t)hit->material);
    int64_t u = hit->local.v[hit->axis == 0 ? 2 : 0], v = hit->local.v[hit->axis == 1 ? 2 : 1];
    u = T3R_MAX(u, 0);
    v = T3R_MAX(v, 0);
    switch (hit->material) {
    case ROOM_FLOOR:
        return floor_boards(own, u, v, footprint);
    case ROOM_CEILING:
        return scaled(rgb(236, 233, 226), octaves(own, u, v, ROOM_MM(900), 4, 128, footprint) / 40);
    case ROOM_BRICK:
        return brick(own, u, v, footprint);
    case ROOM_BLANK:
        return rgb(224, 214, 196);
    case ROOM_PLASTER:
        return plaster(own, u, v, footprint);
    case ROOM_WOOD:
        return wood(rgb(176, 128, 82), own, hit->axis == 1 ? v : u, hit->axis == 1 ? u : v, footprint);
    case ROOM_CARDBOARD:
        return cardboard(own, hit, u, v, footprint);
    case ROOM_CRATE:
        return crate(own, u, v, ROOM_MM(520), footprint);
    case ROOM_SHELF:
        return shelf(own, hit, u, v, footprint);
    case ROOM_PAINTING:
        return canvas(own, u, v, footprint);
    case ROOM_FRAME_GOLD:
        return scaled(rgb(150, 112, 54), octaves(own, u, v, ROOM_MM(30), 4, 200, footprint) / 5);
    case ROOM_METAL:
        return rgb(58, 60, 66);
    case ROOM_PAINTED:
        return rgb(190, 62, 48);
    case ROOM_GRANITE:
        return granite(own, u, v, footprint);
    case ROOM_MARBLE:
        return marble(own, hit, footprint);
    case ROOM_LAMP:
        return rgb(255, 240, 206);
    case ROOM_CLOTH:
        return cloth(own, u, v, footprint);
    }
    return rgb(0, 0, 0);
}
