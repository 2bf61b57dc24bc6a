/* SPDX-License-Identifier: Apache-2.0 */
/* Divided memory ends exactly where the plan's formulas say, for all sizes. */
#include "unit/unit.h"

#include "core/cut.h"
#include "stereo/match_layout.h"
#include "stereo/stereo_planes.h"
#include "trim3r.h"

TEST(parts)
{
    static uint8_t memory[5 * T3R_ARENA_ALIGN];
    t3r_cut cut = t3r_cut_of(memory, sizeof memory);
    assert_ptr_equal(t3r_take(&cut, 1), memory);
    assert_ptr_equal(t3r_take(&cut, T3R_ARENA_ALIGN), memory + T3R_ARENA_ALIGN);
    assert_ptr_equal(t3r_take(&cut, 0), memory + 2 * T3R_ARENA_ALIGN);
    assert_ptr_equal(t3r_take(&cut, T3R_ARENA_ALIGN + 1), memory + 2 * T3R_ARENA_ALIGN);
    assert_int_equal(t3r_cut_left(&cut), T3R_ARENA_ALIGN);
}

/* Checks that parts are disjoint, each of the length in the table, and the last ends at the end. */
TEST(matching)
{
    static const uint32_t sizes[][2] = {{8, 8}, {9, 11}, {97, 31}, {130, 129}, {320, 513}};
    for (size_t s = 0; s < sizeof sizes / sizeof *sizes; s++) {
        for (uint32_t disparities = 16; disparities <= T3R_PATH_MOST; disparities += 48) {
            for (uint32_t paths = 4; paths <= 8; paths += 4) {
                const uint32_t width = sizes[s][0], height = sizes[s][1];
                const t3r_match match = {.width = width, .height = height, .disparities = disparities, .paths = paths};
                const size_t bytes = T3R_MATCH_PATH_BYTES_(width, height, disparities, paths);
                uint8_t *work = unit_array(bytes, 1);
                t3r_cut cut = t3r_cut_of(work, bytes);
                const t3r_match_layout layout = t3r_match_lay_out(&match, &cut);
                assert_int_equal(t3r_cut_left(&cut), 0);
                /* the states end before the next part begins */
                assert_true(layout.up[1] + layout.state_bytes <= layout.bits);
                assert_ptr_equal(layout.down[0], layout.states + T3R_MATCH_BLOCKS(height) * layout.state_bytes);
                assert_true(bytes <= T3R_MATCH_WORK_BYTES(width, height, disparities, paths));
                free(work);
            }
        }
    }
}

TEST(stereo)
{
    for (uint32_t side = T3R_STEREO_LEAST_SIDE; side <= 1024; side += 1 + side / 7) {
        for (uint32_t disparities = 16; disparities <= T3R_PATH_MOST; disparities += 80) {
            const size_t left = T3R_STEREO_LEFT_(side, side), right = T3R_STEREO_RIGHT_(side, side, disparities);
            const size_t bytes = T3R_STEREO_PLANES_(side, side, disparities);
            uint8_t *work = unit_array(bytes, 1);
            t3r_cut cut = t3r_cut_of(work, bytes);
            (void)t3r_take_side(&cut, left);
            const t3r_stereo_side last = t3r_take_side(&cut, right);
            assert_int_equal(t3r_cut_left(&cut), 0);
            assert_true((uint8_t *)(last.disparity + right) <= work + bytes);
            free(work);
        }
    }
}
