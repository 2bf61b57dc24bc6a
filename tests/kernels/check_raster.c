/* SPDX-License-Identifier: Apache-2.0 */
/* Projection, blending, scattering and solving. The tests of the rasterizer and of refinement judge plain C in
 * doubles; here a variant must give the same bits, and blending is checked pixel by pixel. */
#include "checks.h"
#include "core/fixed.h"
#include "guarded.h"
#include "raster/raster_splat.h"

enum { SIDE = T3R_TILE_SIDE, COUNT = 40 };

/* Makes the rows of a rotation, a camera's centre and its lens. */
static t3r_projection any_projection(uint64_t *seed)
{
    t3r_projection p = {.fx_q16 = (int32_t)any_value(seed, 1 << 16, 1 << 28),
                        .fy_q16 = (int32_t)any_value(seed, 1 << 16, 1 << 28),
                        .cx_q16 = (int32_t)any_value(seed, -(1 << 24), 1 << 24),
                        .cy_q16 = (int32_t)any_value(seed, -(1 << 24), 1 << 24),
                        .limit_x_q24 = (int32_t)any_value(seed, 1 << 20, 16 << 24),
                        .limit_y_q24 = (int32_t)any_value(seed, 1 << 20, 16 << 24),
                        .width = (uint32_t)unit_between(seed, 1, 4096),
                        .height = (uint32_t)unit_between(seed, 1, 4096)};
    double w = 1, x = 0, y = 0, z = 0;
    if (unit_random(seed) % 4 != 0) {
        w = (double)unit_between(seed, 1, 1000);
        x = (double)unit_between(seed, -300, 300);
        y = (double)unit_between(seed, -300, 300);
        z = (double)unit_between(seed, -300, 300);
    }
    const double norm = (double)(1 << 30) / (w * w + x * x + y * y + z * z);
    const double rows[9] = {
        w * w + x * x - y * y - z * z, 2 * (x * y - w * z),           2 * (x * z + w * y),
        2 * (x * y + w * z),           w * w - x * x + y * y - z * z, 2 * (y * z - w * x),
        2 * (x * z - w * y),           2 * (y * z + w * x),           w * w - x * x - y * y + z * z};
    const int64_t reach = unit_random(seed) % 4 == 0 ? 1 << 30 : 1 << 20;
    for (int i = 0; i < 9; i++) {
        p.world_to_camera_q30[i] = (int32_t)(rows[i] * norm);
        p.centre_q20[i / 3] = (int32_t)any_value(seed, -reach, reach);
    }
    return p;
}

/* Makes a Gaussian like a scene's, in units about as large as the scene. Each bit of `unusual` adds an unusual
 * property: a mean anywhere, any size, a needle. */
static t3r_gaussian any_gaussian(uint64_t *seed, const t3r_projection *p, uint64_t unusual)
{
    const bool anywhere = (unusual & 1) != 0, any_size = (unusual & 2) != 0, needle = (unusual & 4) != 0;
    t3r_gaussian g = {.opacity_q15 = (uint16_t)any_value(seed, anywhere ? 0 : 129, 32767),
                      .factor_exponent = (int8_t)any_value(seed, any_size ? -60 : -24, any_size ? 15 : -14)};
    const int64_t reach = anywhere ? (int64_t)1 << unit_between(seed, 20, 31) : 1 << 20;
    for (int k = 0; k < 3; k++) {
        const int64_t ahead = (int64_t)p->world_to_camera_q30[6 + k] >> 8; /* up to 4 units before the camera */
        const int64_t at = p->centre_q20[k] + ahead + any_value(seed, -reach, reach);
        g.position_q20[k] = (int32_t)t3r_clamp64(at, -(1 << 30), 1 << 30);
        g.colour_q7[k] = (uint16_t)any_value(seed, 0, 32640);
    }
    const int64_t most = any_size ? 32767 : unit_between(seed, 1, 32767);
    for (int k = 0; k < 9; k++) {
        g.factor[k] = (int16_t)(needle && k % 3 != 0 ? 0 : any_value(seed, -most - 1, most));
    }
    return g;
}

const char *check_project(const t3r_kernels *kernels, uint64_t *seed)
{
    const uint32_t count = any_length(seed, COUNT);
    const t3r_projection p = any_projection(seed);
    t3r_gaussian *g = guarded_take(count * sizeof *g, _Alignof(t3r_gaussian));
    t3r_splat *splats = guarded_take(count * sizeof *splats, _Alignof(t3r_splat)), want[COUNT];
    for (uint32_t i = 0; i < count; i++) {
        g[i] = any_gaussian(seed, &p, unit_random(seed) % 8);
    }
    kernels->project(&p, g, count, splats);
    t3r_project_c(&p, g, count, want);
    for (uint32_t i = 0; i < count; i++) {
        if (splats[i].z_q20 != want[i].z_q20 || (want[i].z_q20 != 0 && !SAME(&splats[i], &want[i], 1))) {
            return "a splat differs";
        }
    }
    return NULL;
}

const char *check_axes(const t3r_kernels *kernels, uint64_t *seed)
{
    const uint32_t count = any_length(seed, COUNT);
    const t3r_projection p = any_projection(seed);
    t3r_gaussian *g = guarded_take(count * sizeof *g, _Alignof(t3r_gaussian));
    t3r_splat *splats = guarded_take(count * sizeof *splats, _Alignof(t3r_splat));
    t3r_refine_sums *sums = guarded_take(count * sizeof *sums, _Alignof(t3r_refine_sums)), want[COUNT];
    for (uint32_t i = 0; i < count; i++) {
        g[i] = any_gaussian(seed, &p, unit_random(seed) % 8);
    }
    t3r_project_c(&p, g, count, splats);
    memset(sums, 0, count * sizeof *sums);
    memset(want, 0, sizeof want);
    kernels->axes(&p, g, splats, count, sums);
    t3r_axes_c(&p, g, splats, count, want);
    for (uint32_t i = 0; i < count; i++) {
        want[i].axes = splats[i].z_q20 != 0 ? want[i].axes : sums[i].axes;
        if (!SAME(&sums[i], &want[i], 1)) {
            return "the axes of a splat differ";
        }
    }
    return NULL;
}

const char *check_compare_row(const t3r_kernels *kernels, uint64_t *seed)
{
    const uint32_t count = (uint32_t)any_value(seed, 1, SIDE), spread = (uint32_t)(unit_random(seed) % 2);
    uint8_t *shown = guarded_take(((count - 1) << spread) + 1, 1);
    uint16_t *drawn = guarded_take(count * sizeof *drawn, _Alignof(uint16_t));
    int16_t *residual = guarded_take(count * sizeof *residual, _Alignof(int16_t)), want[SIDE];
    const uint16_t gain = (uint16_t)any_value(seed, 0, UINT16_MAX);
    for (uint32_t i = 0; i < count; i++) {
        shown[i << spread] = (uint8_t)any_value(seed, 0, 255);
        drawn[i] = (uint16_t)any_value(seed, 0, UINT16_MAX);
    }
    kernels->compare_row(shown, spread, gain, drawn, count, residual);
    t3r_compare_row_c(shown, spread, gain, drawn, count, want);
    return SAME(residual, want, count) ? NULL : "a residual differs";
}

/* Makes splats that reach one tile of a view, or of a part of its pixels: projects Gaussians until each does. */
static uint32_t any_splats(uint64_t *seed, t3r_splat splats[COUNT], t3r_tile_place *tile)
{
    const t3r_projection p = any_projection(seed);
    const uint32_t spread = (uint32_t)(unit_random(seed) % 2), odd = spread * 3 & (uint32_t)unit_random(seed);
    const t3r_lattice lattice = {spread, odd & 1, odd >> 1};
    uint32_t count = 0;
    for (uint32_t tries = 0; tries < 20 * COUNT && count < COUNT; tries++) {
        const t3r_gaussian g = any_gaussian(seed, &p, unit_random(seed) % 4 == 0 ? unit_random(seed) % 8 : 0);
        t3r_splat *s = &splats[count];
        if (!t3r_project(&p, &g, s)) {
            continue;
        }
        t3r_to_lattice(&lattice, s);
        if (s->z_q20 == 0) {
            continue;
        }
        if (count == 0) {
            *tile = t3r_tile_place_of((uint32_t)unit_between(seed, s->x0, s->x1) / SIDE * SIDE,
                                      (uint32_t)unit_between(seed, s->y0, s->y1) / SIDE * SIDE, spread);
        }
        count += s->x0 < tile->left + SIDE && s->x1 >= tile->left && s->y0 < tile->top + SIDE && s->y1 >= tile->top;
    }
    return count;
}

const char *check_place(const t3r_kernels *kernels, uint64_t *seed)
{
    t3r_splat reach[COUNT];
    t3r_tile_place tile;
    const uint32_t splats_count = any_splats(seed, reach, &tile);
    if (splats_count == 0) {
        return NULL;
    }
    const uint32_t count = any_length(seed, COUNT), room = (count + T3R_PLACED - 1) / T3R_PLACED * T3R_PLACED;
    t3r_splat *splats = guarded_take(splats_count * sizeof *splats, _Alignof(t3r_splat));
    uint32_t *list = guarded_take(count * sizeof *list, _Alignof(uint32_t));
    t3r_tile_splat *placed = guarded_take(room * sizeof *placed, _Alignof(t3r_tile_splat)), want[COUNT];
    memcpy(splats, reach, splats_count * sizeof *splats);
    for (uint32_t i = 0; i < count; i++) {
        list[i] = (uint32_t)(unit_random(seed) % splats_count);
    }
    kernels->place(splats, list, count, &tile, placed);
    t3r_place_c(splats, list, count, &tile, want);
    for (uint32_t i = 0; i < count; i++) {
        const t3r_tile_splat *s = &placed[i], *w = &want[i];
        if (s->a != w->a || s->b != w->b || s->c != w->c || s->opacity_q16 != w->opacity_q16 ||
            !SAME(s->colour_q7, w->colour_q7, 3) || s->column != w->column || s->groups != w->groups ||
            s->drawn != w->drawn || s->first != w->first || s->last != w->last || s->x0 != w->x0 || s->x1 != w->x1) {
            return "a splat differs";
        }
        for (uint32_t g = 0; g < w->groups; g++) {
            if ((w->drawn >> g & 1) != 0 && !SAME(&s->group[g], &w->group[g], 1)) {
                return "a splat's quadratic differs";
            }
        }
    }
    return NULL;
}

static t3r_tile_splat any_splat(uint64_t *seed)
{
    t3r_tile_splat s = {.a = (int32_t)any_value(seed, 0, 218453), /* 1 / 0.6 in Q17 */
                        .c = (int32_t)any_value(seed, 0, 218453),
                        .opacity_q16 = (uint16_t)any_value(seed, 258, 65534)};
    s.b = (int32_t)any_value(seed, -s.a / 2, s.a / 2);
    s.groups = (uint8_t)unit_between(seed, 1, 2);
    s.drawn = (uint8_t)unit_between(seed, 0, (1 << s.groups) - 1);
    s.column = (uint8_t)(s.groups == 2 ? 0 : unit_between(seed, 0, SIDE - T3R_LANES));
    s.first = (uint8_t)unit_between(seed, 0, SIDE - 1);
    s.last = (uint8_t)unit_between(seed, s.first, SIDE - 1);
    s.x0 = (uint8_t)unit_between(seed, s.column, s.column + 8 * s.groups - 1);
    s.x1 = (uint8_t)unit_between(seed, s.x0, s.column + 8 * s.groups - 1);
    for (int g = 0; g < s.groups; g++) {
        s.group[g].q = (int32_t)any_value(seed, -4, 6 << 17);
        s.group[g].gx = (int32_t)any_value(seed, -(1 << 17), 1 << 17);
        s.group[g].gy = (int32_t)any_value(seed, -(1 << 17), 1 << 17);
    }
    for (int c = 0; c < 3; c++) {
        s.colour_q7[c] = (uint16_t)any_value(seed, 0, 32640);
    }
    return s;
}

/* Makes a tile in which some splats have been blended. */
static void any_tile(uint64_t *seed, t3r_tile *tile)
{
    memset(tile, 0, sizeof *tile);
    memset(tile->transmittance_q16, 0xff, sizeof tile->transmittance_q16);
    for (uint64_t i = unit_random(seed) % 12; i > 0; i--) {
        const t3r_tile_splat s = any_splat(seed);
        t3r_blend_c(tile, &s);
    }
}

/* Blends pixel by pixel, by the formulas of SPEC.md. Returns all bits of the weights. */
static uint16_t blend_by_pixels(t3r_tile *tile, const t3r_tile_splat *s, t3r_blended_row *row)
{
    uint16_t bits = 0;
    for (uint32_t g = 0; g < s->groups; g++) {
        for (uint32_t j = s->first; j <= s->last; j++, row++) {
            for (int64_t i = 0; i < T3R_LANES; i++) {
                const int64_t y = j, x = s->column + 8 * g + i;
                const int64_t q = s->group[g].q + i * s->group[g].gx + y * s->group[g].gy + i * i * s->a +
                                  i * y * s->b + y * y * s->c;
                uint16_t *t = &tile->transmittance_q16[j][x];
                uint64_t alpha = t3r_alpha_q16((int32_t)q, s->opacity_q16);
                alpha = *t < T3R_STOP_Q16 || !(s->drawn >> g & 1) ? 0 : alpha;
                const uint64_t w = (*t * alpha + 32768) >> 16;
                *t = (uint16_t)(*t - w);
                for (int c = 0; c < 3; c++) {
                    tile->colour_q7[c][j][x] =
                        (uint16_t)(tile->colour_q7[c][j][x] + ((w * s->colour_q7[c] + 32768) >> 16));
                }
                row->weight_q16[i] = (uint16_t)w;
                row->alpha_q15[i] = (int16_t)(w == 0 ? 0 : alpha >> 1);
                bits |= (uint16_t)w;
            }
        }
    }
    return bits;
}

const char *check_blend(const t3r_kernels *kernels, uint64_t *seed)
{
    t3r_tile *tile = guarded_take(sizeof *tile, 2), want;
    const t3r_tile_splat s = any_splat(seed);
    t3r_blended_row rows[T3R_BLENDED_ROWS_MOST];
    any_tile(seed, tile);
    want = *tile;
    kernels->blend(tile, &s);
    (void)blend_by_pixels(&want, &s, rows);
    return SAME(tile, &want, 1) ? NULL : "a pixel differs";
}

const char *check_blend_keep(const t3r_kernels *kernels, uint64_t *seed)
{
    t3r_tile *tile = guarded_take(sizeof *tile, 2), want;
    const t3r_tile_splat s = any_splat(seed);
    t3r_blended_row *rows = guarded_take(t3r_rows_of(&s) * sizeof *rows, 2), want_rows[T3R_BLENDED_ROWS_MOST];
    any_tile(seed, tile);
    want = *tile;
    const uint16_t bits = kernels->blend_keep(tile, &s, rows), want_bits = blend_by_pixels(&want, &s, want_rows);
    if (bits != want_bits) {
        return "the bits of all weights differ";
    }
    if (!SAME(rows, want_rows, t3r_rows_of(&s))) {
        return "a weight or an alpha differs";
    }
    return SAME(tile, &want, 1) ? NULL : "a pixel differs";
}

static void any_place(uint64_t *seed, t3r_scatter_splat *splat)
{
    for (int k = 0; k < 2; k++) {
        splat->origin_q13[k] = (int16_t)any_value(seed, INT16_MIN, INT16_MAX);
        splat->right_q13[k] = (int16_t)any_value(seed, -7537, 7537);
        splat->down_q13[k] = (int16_t)any_value(seed, -7537, 7537);
    }
    splat->pixels = (uint32_t)unit_between(seed, 1, 256);
}

const char *check_scatter(const t3r_kernels *kernels, uint64_t *seed)
{
    t3r_wanted *tile = guarded_take(sizeof *tile, 2), want;
    const t3r_tile_splat s = any_splat(seed);
    t3r_blended_row *rows = guarded_take(t3r_rows_of(&s) * sizeof *rows, 2);
    any_tile(seed, &tile->pixels);
    const uint16_t bits = t3r_blend_keep_c(&tile->pixels, &s, rows);
    if (bits == 0) {
        return NULL; /* such a splat is not kept */
    }
    t3r_scatter_splat splat = {.span = &s, .rows = rows, .scale = 15 - t3r_msb32(bits)};
    any_place(seed, &splat);
    const uint64_t one_in = 1 + unit_random(seed) % 6;
    for (uint32_t i = 0; i < SIDE * SIDE; i++) {
        tile->counts[i / SIDE][i % SIDE] = unit_random(seed) % one_in == 0 ? UINT16_MAX : 0;
        for (int c = 0; c < 3; c++) {
            tile->pixels.colour_q7[c][i / SIDE][i % SIDE] = (uint16_t)any_value(seed, 0, 32640);
            tile->residual_q4[c][i / SIDE][i % SIDE] = (int16_t)any_value(seed, -4080, 4080);
        }
    }
    want = *tile;
    t3r_refine_sums *sums = guarded_take(sizeof *sums, 4), want_sums;
    memset(sums, 0, sizeof *sums);
    sums->area = (uint32_t)any_value(seed, splat.pixels, (1 << 28) - 1);
    sums->weight = 7;
    want_sums = *sums;
    const bool wanted = unit_random(seed) % 8 != 0;
    kernels->scatter(tile, &splat, wanted ? sums : NULL);
    t3r_scatter_c(&want, &splat, wanted ? &want_sums : NULL);
    if (!SAME(tile, &want, 1)) {
        return "what is behind differs";
    }
    return SAME(sums, &want_sums, 1) ? NULL : "a sum differs";
}

const char *check_solve(const t3r_kernels *kernels, uint64_t *seed)
{
    const uint32_t count = any_length(seed, COUNT);
    t3r_refine_sums *sums = guarded_take(count * sizeof *sums, 4);
    t3r_correction *corrections = guarded_take(count * sizeof *corrections, 2), want[COUNT];
    memset(corrections, 0, count * sizeof *corrections);
    for (uint32_t i = 0; i < count; i++) {
        int32_t *words = (int32_t *)&sums[i];
        const int64_t most = (int64_t)1 << unit_between(seed, 1, 30);
        for (size_t k = 0; k < offsetof(t3r_refine_sums, area) / 4; k++) {
            words[k] = (int32_t)any_value(seed, -most, most);
        }
        sums[i].area = (uint32_t)any_value(seed, 1, (1 << 28) - 1);
    }
    for (int pass = 0; pass < 2; pass++) { /* the second pass continues with the first one's corrections */
        memcpy(want, corrections, count * sizeof *want);
        kernels->solve(sums, count, corrections);
        t3r_solve_c(sums, count, want);
        if (!SAME(corrections, want, count)) {
            return "a correction differs";
        }
    }
    return NULL;
}
