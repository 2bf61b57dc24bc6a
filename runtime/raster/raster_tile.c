/* SPDX-License-Identifier: Apache-2.0 */
#include "raster_tile.h"

#include "core/fixed.h"
#include "core/memory.h"

/* Whether the transmittance of any of eight pixels has just fallen below one half. Without branches, and not inlined,
 * so that the compiler vectorizes it. */
static __attribute__((noinline)) bool is_halved(const uint16_t *restrict transmittance_q16,
                                                const uint32_t *restrict depth_q20)
{
    _Static_assert(T3R_HALF_Q16 == 1 << 15, "the highest bit is enough");
    uint32_t any = 0;
    for (uint32_t i = 0; i < T3R_LANES; i++) {
        const uint32_t is_below = (uint32_t)(transmittance_q16[i] >> 15) - 1u, is_open = (depth_q20[i] != 0) - 1u;
        any |= is_below & is_open;
    }
    return any != 0;
}

/* A splat that depth is noted of. Its surface is computed only if a pixel needs it. */
typedef struct noted_splat {
    const t3r_binning *bin;
    uint32_t index;
    bool has_surface;
    t3r_splat_surface surface;
} noted_splat;

static uint32_t depth_at(noted_splat *noted, uint32_t x, uint32_t y)
{
    const t3r_splat *splat = &noted->bin->splats[noted->index];
    if (splat->z_q20 == T3R_WITHOUT_DEPTH) {
        return (uint32_t)T3R_WITHOUT_DEPTH;
    }
    if (!noted->has_surface) {
        noted->surface = t3r_splat_surface_of(noted->bin->projection, &noted->bin->gaussians[noted->index], splat);
        noted->has_surface = true;
    }
    return t3r_surface_depth_q20(&noted->surface, x, y);
}

static void note_depth(t3r_drawn_tile *tile, const t3r_tile_splat *placed, noted_splat *noted)
{
    for (uint32_t group = 0; group < placed->groups; group++) {
        const uint32_t column = placed->column + group * T3R_LANES;
        for (uint32_t j = placed->first; j <= placed->last && (placed->drawn >> group & 1) != 0; j++) {
            const uint16_t *transmittance_q16 = tile->pixels.transmittance_q16[j] + column;
            uint32_t *depth_q20 = tile->depth_q20[j] + column;
            for (uint32_t i = 0; i < T3R_LANES && is_halved(transmittance_q16, depth_q20); i++) {
                if (transmittance_q16[i] < T3R_HALF_Q16 && depth_q20[i] == 0) {
                    depth_q20[i] = depth_at(noted, tile->place.left + column + i, tile->place.top + j);
                }
            }
        }
    }
}

/* In most tiles the first row already has a pixel that isn't. */
bool t3r_tile_is_below(const t3r_tile *tile, uint16_t transmittance_q16)
{
    for (uint32_t j = 0; j < T3R_TILE_SIDE; j++) {
        uint16_t most = 0;
        for (uint32_t i = 0; i < T3R_TILE_SIDE; i++) {
            const uint16_t t = tile->transmittance_q16[j][i];
            most = t > most ? t : most;
        }
        if (most >= transmittance_q16) {
            return false;
        }
    }
    return true;
}

static uint8_t byte_of(uint16_t colour_q7)
{
    uint32_t rounded = (colour_q7 + 64u) >> 7;
    return (uint8_t)T3R_MIN(rounded, 255u);
}

static void write_colours(const t3r_tile *tile, uint32_t j, uint32_t columns, uint8_t *rgb)
{
    for (uint32_t i = 0; i < columns; i++) {
        rgb[3 * i] = byte_of(tile->colour_q7[0][j][i]);
        rgb[3 * i + 1] = byte_of(tile->colour_q7[1][j][i]);
        rgb[3 * i + 2] = byte_of(tile->colour_q7[2][j][i]);
    }
}

static void write_alphas(const t3r_tile *tile, uint32_t j, uint32_t columns, uint16_t *alpha_q15)
{
    for (uint32_t i = 0; i < columns; i++) {
        alpha_q15[i] = (uint16_t)((T3R_ONE_Q16 - tile->transmittance_q16[j][i]) >> 1);
    }
}

/* Writes the noted depths; where a splat without depth was noted, none. */
static void write_depths(const t3r_drawn_tile *tile, uint32_t j, uint32_t columns, uint32_t *depth_q20)
{
    for (uint32_t i = 0; i < columns; i++) {
        const uint32_t z_q20 = tile->depth_q20[j][i];
        depth_q20[i] = z_q20 == (uint32_t)T3R_WITHOUT_DEPTH ? 0 : z_q20;
    }
}

void t3r_draw_end(const t3r_drawn_tile *tile, const t3r_target *target)
{
    const uint32_t left = tile->place.left, top = tile->place.top;
    const uint32_t columns = T3R_MIN(target->width - left, (uint32_t)T3R_TILE_SIDE);
    const uint32_t rows = T3R_MIN(target->height - top, (uint32_t)T3R_TILE_SIDE);
    for (uint32_t j = 0; j < rows; j++) {
        const size_t y = top + j;
        if (target->rgb != NULL) {
            write_colours(&tile->pixels, j, columns, target->rgb + y * target->rgb_stride_bytes + 3 * (size_t)left);
        }
        if (target->alpha_q15 != NULL) {
            write_alphas(&tile->pixels, j, columns,
                         target->alpha_q15 + y * (target->alpha_stride_bytes / sizeof *target->alpha_q15) + left);
        }
        if (target->depth_q20 != NULL) {
            write_depths(tile, j, columns,
                         target->depth_q20 + y * (target->depth_stride_bytes / sizeof *target->depth_q20) + left);
        }
    }
}

void t3r_tile_clear(t3r_tile *tile)
{
    memset(tile, 0, sizeof *tile);
    for (uint32_t j = 0; j < T3R_TILE_SIDE; j++) {
        for (uint32_t i = 0; i < T3R_TILE_SIDE; i++) {
            tile->transmittance_q16[j][i] = T3R_ONE_Q16;
        }
    }
}

void t3r_draw_begin(t3r_drawn_tile *tile, uint32_t tile_x, uint32_t tile_y)
{
    tile->place = t3r_tile_place_of(tile_x * T3R_TILE_SIDE, tile_y * T3R_TILE_SIDE, 0);
    tile->noted = tile->stopped = false;
    memset(tile->depth_q20, 0, sizeof tile->depth_q20);
    t3r_tile_clear(&tile->pixels);
}

/* Splats placed in one batch. */
#define PLACE_SPLATS T3R_PLACED
_Static_assert(T3R_STOP_INTERVAL % PLACE_SPLATS == 0, "a part of a list ends with a batch");

/* Prefetches the splats of the next batch while this one is blended: they lie anywhere in memory. */
static void fetch(const t3r_splat *splats, const uint32_t *list, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        __builtin_prefetch(&splats[list[i]]);
        __builtin_prefetch(&splats[list[i]].y1);
    }
}

/* Finds whether further splats add nothing: to the depth below a half, to colour and alpha where all is opaque. */
static void look_for_end(t3r_drawn_tile *tile, const t3r_target *target)
{
    tile->noted = tile->noted || target->depth_q20 == NULL || t3r_tile_is_below(&tile->pixels, T3R_HALF_Q16);
    tile->stopped = tile->noted && ((target->rgb == NULL && target->alpha_q15 == NULL) ||
                                    t3r_tile_is_below(&tile->pixels, T3R_STOP_Q16));
}

void t3r_draw_list(t3r_drawn_tile *tile, const t3r_binning *bin, const uint32_t *list, uint32_t count,
                   const t3r_target *target)
{
    const t3r_splat *splats = bin->splats;
    t3r_tile_splat placed[PLACE_SPLATS];
    for (uint32_t i = 0; i < count && !tile->stopped; i++) {
        const uint32_t at = i % PLACE_SPLATS;
        if (at == 0) {
            const uint32_t next = T3R_MIN(count - i, 2 * PLACE_SPLATS);
            fetch(splats, list + i + PLACE_SPLATS, next > PLACE_SPLATS ? next - PLACE_SPLATS : 0);
            bin->kernels->place(splats, list + i, T3R_MIN(count - i, PLACE_SPLATS), &tile->place, placed);
        }
        if (i % T3R_STOP_INTERVAL == T3R_STOP_INTERVAL - 1) {
            look_for_end(tile, target);
        }
        if (!tile->stopped) {
            bin->kernels->blend(&tile->pixels, &placed[at]);
        }
        if (!tile->noted && target->depth_q20 != NULL) {
            noted_splat noted = {.bin = bin, .index = list[i]};
            note_depth(tile, &placed[at], &noted);
        }
    }
}
