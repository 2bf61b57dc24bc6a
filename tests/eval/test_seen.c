/* SPDX-License-Identifier: Apache-2.0 */
/* Which pixels of a target a context view saw too: walls, borders, what hides them, what was not measured. */
#include <stdbool.h>

#include "geometry/seen.h"
#include "test.h"

#define SIDE 16
#define WALL 2000 /* steps of a millimetre */

static uint16_t wall[SIDE * SIDE], other[SIDE * SIDE];
static uint8_t seen[SIDE * SIDE];

/* Looks at the wall from x world units to the right; half a turn looks away from it. */
static t3r_camera camera_at(double x, bool away)
{
    const int32_t one = INT32_C(1) << 30;
    return (t3r_camera){.fx_q16 = 16 << 16,
                        .fy_q16 = 16 << 16,
                        .cx_q16 = 15 << 15,
                        .cy_q16 = 15 << 15,
                        .position_q32 = {(int64_t)(x * 4294967296.0), 0, 0},
                        .rotation_q30 = {away ? 0 : one, 0, away ? one : 0, 0}};
}

static void fill(uint16_t *depth, uint16_t step)
{
    for (int i = 0; i < SIDE * SIDE; i++) {
        depth[i] = step;
    }
}

static void mark(const t3r_camera *target, const t3r_camera *context)
{
    const seen_view views[2] = {{target, wall, 0.001}, {context, other, 0.001}};
    seen_mask(seen, SIDE, SIDE, &views[0], &views[1], 1);
}

/* Returns the number of columns that are seen; all rows are alike. */
static int columns_seen(void)
{
    int count = 0;
    for (int x = 0; x < SIDE; x++) {
        count += seen[x] != 0;
        for (int y = 1; y < SIDE; y++) {
            assert_int_equal(seen[y * SIDE + x], seen[x]);
        }
    }
    return count;
}

TEST(test_border)
{
    const t3r_camera here = camera_at(0, false), there = camera_at(0.5, false), away = camera_at(0, true);
    fill(wall, WALL);
    fill(other, WALL);
    mark(&here, &here);
    assert_int_equal(columns_seen(), SIDE);
    mark(&here, &there); /* 16 pixels x 0.5 / 2 to the left */
    assert_int_equal(columns_seen(), SIDE - 4);
    assert_int_equal(seen[3], 0);
    assert_int_equal(seen[4], 255);
    mark(&here, &away);
    assert_int_equal(columns_seen(), 0);
}

TEST(test_what_hides_the_wall)
{
    const t3r_camera here = camera_at(0, false);
    fill(wall, WALL);
    fill(other, WALL);
    for (int y = 0; y < SIDE; y++) {
        for (int x = 0; x < 8; x++) {
            other[y * SIDE + x] = 1000;
        }
    }
    mark(&here, &here);
    assert_int_equal(columns_seen(), 9); /* one column more by the neighbours */
    fill(other, WALL + WALL / 20 - 1);
    mark(&here, &here);
    assert_int_equal(columns_seen(), SIDE);
    fill(other, WALL + WALL / 20 + 1);
    mark(&here, &here);
    assert_int_equal(columns_seen(), 0);
}

TEST(test_not_measured)
{
    const t3r_camera here = camera_at(0, false);
    fill(wall, WALL);
    fill(other, 0);
    mark(&here, &here);
    assert_int_equal(columns_seen(), 0);
    fill(other, WALL);
    fill(wall, 0);
    mark(&here, &here);
    assert_int_equal(columns_seen(), 0);
}
