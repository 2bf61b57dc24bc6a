/* SPDX-License-Identifier: Apache-2.0 */
/* Order and lists of splats: stable by depth for any shared bytes of the depths, and the same lists for any number of
 * workers and any room for them. */
#include "unit/unit.h"

#include "core/fixed.h"
#include "raster/raster_tile.h"

enum { ACROSS = 9, DOWN = 7, TILES = ACROSS * DOWN, SPLATS = 20000, ENTRIES = 8 * SPLATS };

static t3r_splat splats[SPLATS];
static t3r_tile_span spans[SPLATS];
static uint32_t order[SPLATS], table[TILES], lists[ENTRIES];

TEST(depths_are_ordered)
{
    static uint32_t keys[2][SPLATS], indices[2][SPLATS], given[SPLATS], histogram[T3R_RADIX_DIGITS * T3R_RADIX];
    const uint32_t shared[] = {0, 0xffffffff, 0xff000000, 0x00ff0000, 0x0000ff00, 0x000000ff, 0xff00ff00, 0x00ff00ff};
    uint64_t seed = 3;
    for (uint32_t round = 0; round < 8 * 3; round++) {
        const uint32_t count = round < 8 ? SPLATS : round % 3, common = (uint32_t)unit_random(&seed);
        for (uint32_t i = 0; i < count; i++) {
            given[i] = (common & shared[round % 8]) | ((uint32_t)unit_random(&seed) & ~shared[round % 8]);
            keys[0][i] = given[i];
            indices[0][i] = i;
        }
        uint32_t *key_sides[2] = {keys[0], keys[1]}, *index_sides[2] = {indices[0], indices[1]};
        const uint32_t side = t3r_order(&t3r_kernels_c, key_sides, index_sides, count, histogram);
        for (uint32_t i = 0; i < count; i++) {
            const uint32_t here = indices[side][i];
            assert_int_equal(keys[side][i], given[here]);
            if (i > 0) {
                const uint32_t before = indices[side][i - 1];
                assert_true(given[before] < given[here] || (given[before] == given[here] && before < here));
            }
        }
    }
}

static void backwards(void *user, uint32_t count, void (*task)(void *context, uint32_t index, uint32_t worker),
                      void *context)
{
    const uint32_t workers = *(const uint32_t *)user;
    while (count-- > 0) {
        task(context, count, count % workers);
    }
}

static void place_splats(uint64_t *seed)
{
    for (uint32_t i = 0; i < SPLATS; i++) {
        const int64_t x = unit_between(seed, 0, ACROSS * T3R_TILE_SIDE - 1);
        const int64_t y = unit_between(seed, 0, DOWN * T3R_TILE_SIDE - 1);
        const int64_t reach = i % 1000 == 0 ? 200 : unit_between(seed, 0, 4);
        splats[i] = (t3r_splat){
            .z_q20 = 1,
            .x0 = (uint16_t)(x > reach ? x - reach : 0),
            .y0 = (uint16_t)(y > reach ? y - reach : 0),
            .x1 = (uint16_t)T3R_MIN(x + reach, ACROSS * T3R_TILE_SIDE - 1),
            .y1 = (uint16_t)T3R_MIN(y + reach, DOWN * T3R_TILE_SIDE - 1),
        };
        spans[i] = t3r_span_of(&splats[i]);
        order[i] = SPLATS - 1 - i;
    }
}

/* Checks that the list has exactly the splats of the tile, in their order. */
static void judge_list(uint32_t tile, const uint32_t *list, uint32_t length)
{
    const uint32_t left = tile % ACROSS * T3R_TILE_SIDE, top = tile / ACROSS * T3R_TILE_SIDE;
    uint32_t found = 0;
    for (uint32_t i = 0; i < SPLATS; i++) {
        const t3r_splat *s = &splats[order[i]];
        if (s->x0 < left + T3R_TILE_SIDE && s->x1 >= left && s->y0 < top + T3R_TILE_SIDE && s->y1 >= top) {
            assert_true(found < length && list[found] == order[i]);
            found++;
        }
    }
    assert_int_equal(found, length);
}

TEST(lists_hold_what_reaches_a_tile)
{
    uint64_t seed = 7;
    place_splats(&seed);
    for (uint32_t i = 0; i < SPLATS; i++) { /* in depth order */
        spans[i] = t3r_span_of(&splats[order[i]]);
    }
    for (uint32_t round = 0; round < 6; round++) {
        const uint32_t counts[] = {1, 2, 3, 5, 8, T3R_MAX_WORKERS};
        uint32_t count = counts[round];
        const t3r_hooks hooks = {.user = &count, .parallel_for = backwards};
        const t3r_workers workers = {&hooks, count};
        const t3r_binning bin = {.splats = splats,
                                 .order = order,
                                 .spans = spans,
                                 .visible = SPLATS,
                                 .across = ACROSS,
                                 .tiles = TILES,
                                 .table = table,
                                 .lists = lists,
                                 .capacity = round % 2 == 0 ? ENTRIES : SPLATS,
                                 .most = UINT32_MAX};
        t3r_bin_count(&workers, &bin);
        uint32_t passes = 0;
        for (uint32_t begin = 0, end; begin < TILES; begin = end, passes++) {
            end = t3r_bin_pass(&workers, &bin, begin);
            for (uint32_t tile = begin; tile < end; tile++) {
                const uint32_t from = tile == begin ? 0 : table[tile - 1];
                judge_list(tile, lists + from, table[tile] - from);
            }
        }
        assert_true(round % 2 == 0 ? passes == 1 : passes > 1);
    }
}
