/* SPDX-License-Identifier: Apache-2.0 */
/* Bands of tiles: for any number of them and any room at their borders, each Gaussian's sums get every tile's
 * contribution once, and no two bands write to the same place. */
#include "unit/unit.h"

#include "refine/refine_bands.h"

enum { ACROSS = 7, DOWN = 6, TILES = ACROSS * DOWN, SPLATS = 300 };

static t3r_splat splats[SPLATS];
static uint32_t order[SPLATS], table[TILES], lists[TILES * SPLATS];
static t3r_tile_span spans[SPLATS];
static const t3r_workers alone = {NULL, 1};
static t3r_refine_sums own[SPLATS], border_sums[(T3R_MAX_WORKERS - 1) * SPLATS];
static uint32_t border_index[(T3R_MAX_WORKERS - 1) * SPLATS];

static void place_splats(uint64_t *seed)
{
    const int64_t width = ACROSS * T3R_TILE_SIDE, height = DOWN * T3R_TILE_SIDE;
    for (uint32_t i = 0; i < SPLATS; i++) {
        const int64_t reach = unit_between(seed, 0, i % 10 == 0 ? 60 : 9);
        const int64_t x = unit_between(seed, 0, width - 1), y = unit_between(seed, 0, height - 1);
        splats[i] = (t3r_splat){
            .z_q20 = i % 23 == 7 ? 0 : 1 + (int32_t)i, /* 0: culled */
            .x0 = (uint16_t)(x > reach ? x - reach : 0),
            .y0 = (uint16_t)(y > reach ? y - reach : 0),
            .x1 = (uint16_t)(x + reach < width ? x + reach : width - 1),
            .y1 = (uint16_t)(y + reach < height ? y + reach : height - 1),
        };
    }
}

static t3r_binning bin_splats(uint64_t capacity)
{
    t3r_binning bin = {.splats = splats,
                       .order = order,
                       .spans = spans,
                       .across = ACROSS,
                       .tiles = TILES,
                       .table = table,
                       .lists = lists,
                       .capacity = capacity};
    for (uint32_t i = 0; i < SPLATS; i++) {
        if (splats[i].z_q20 != 0) {
            spans[bin.visible] = t3r_span_of(&splats[i]);
            order[bin.visible++] = i;
        }
    }
    t3r_bin_count(&alone, &bin);
    return bin;
}

/* Returns a tile's contribution to a splat. */
static int32_t share_of(uint32_t tile, uint32_t index)
{
    return (int32_t)(tile * 31 + index % 13 + 1);
}

static void accumulate(const t3r_binning *bin, uint32_t begin, const t3r_refine_band *bands, uint32_t band,
                       const t3r_refine_borders *borders, const t3r_refine_slice *slice)
{
    for (uint32_t tile = bands[band].begin; tile < bands[band].end; tile++) {
        for (uint32_t at = tile == begin ? 0 : table[tile - 1]; at < table[tile]; at++) {
            const uint32_t i = lists[at];
            if (i - slice->first < slice->count) {
                t3r_refine_sums *sums = t3r_refine_sums_in(bands, band, borders, slice, &splats[i], i, bin->across);
                assert_int_equal(sums->area, 7 + i); /* the Gaussian's own, or its copy */
                sums->weight += share_of(tile, i);
                sums->colour[2] -= share_of(tile, i);
                sums->gradient[5] += 2 * share_of(tile, i);
                sums->curvature[14] += 3 * share_of(tile, i);
            }
        }
    }
}

TEST(every_share_counts_once)
{
    uint64_t seed = 20;
    for (uint32_t round = 0; round < 60; round++) {
        const uint32_t workers[] = {1, 2, 3, 8, T3R_MAX_WORKERS}, rooms[] = {0, 5, 60, SPLATS};
        const t3r_refine_borders borders = {workers[round % 5], rooms[round % 4], border_index, border_sums};
        const t3r_refine_slice slice = {own, (uint32_t)unit_between(&seed, 0, 40), 200};
        place_splats(&seed);
        const t3r_binning bin = bin_splats(round % 3 == 0 ? SPLATS : TILES * SPLATS);
        memset(own, 0, sizeof own);
        for (uint32_t i = 0; i < slice.count; i++) {
            own[i].area = 7 + slice.first + i;
        }
        for (uint32_t begin = 0, end; begin < TILES; begin = end) {
            end = t3r_bin_pass(&alone, &bin, begin);
            const uint32_t middle = (uint32_t)unit_between(&seed, begin, end - 1); /* a pass in one chunk or in two */
            for (uint32_t first = begin, last; first < end; first = last) {
                t3r_refine_band bands[T3R_MAX_WORKERS];
                const uint32_t listed = first == begin ? 0 : bin.table[first - 1];
                last = first < middle ? middle : end;
                const uint32_t count = t3r_refine_bands(&bin, first, last, listed, &slice, &borders, bands);
                assert_in_range(count, 1, borders.bands);
                assert_true(borders.most == SPLATS ? count == borders.bands || count == last - first : true);
                assert_int_equal(bands[0].begin, first);
                assert_int_equal(bands[count - 1].end, last);
                for (uint32_t b = count; b-- > 0;) { /* the last first: no band depends on an earlier one */
                    assert_true(b == 0 || bands[b].begin == bands[b - 1].end);
                    accumulate(&bin, begin, bands, b, &borders, &slice);
                }
                t3r_refine_join(bands, count, &borders, &slice);
            }
        }
        for (uint32_t i = 0; i < slice.count; i++) {
            const t3r_splat *s = &splats[slice.first + i];
            int32_t sum = 0;
            for (uint32_t y = s->y0 / T3R_TILE_SIDE; s->z_q20 != 0 && y <= s->y1 / T3R_TILE_SIDE; y++) {
                for (uint32_t x = s->x0 / T3R_TILE_SIDE; x <= s->x1 / T3R_TILE_SIDE; x++) {
                    sum += share_of(y * ACROSS + x, slice.first + i);
                }
            }
            assert_int_equal(own[i].weight, sum);
            assert_int_equal(own[i].colour[2], -sum);
            assert_int_equal(own[i].gradient[5], 2 * sum);
            assert_int_equal(own[i].curvature[14], 3 * sum);
        }
    }
}
