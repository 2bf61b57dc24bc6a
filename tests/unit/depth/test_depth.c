/* SPDX-License-Identifier: Apache-2.0 */
/* Depth: validity, and holes that are filled or kept. */
#include "unit/unit.h"

#include "depth/depth.h"

enum { W = 24, H = 20 };

static const t3r_workers alone = {NULL, 1};

typedef struct canvas {
    uint8_t colour[3][W * H];
    uint16_t depth[W * H];
    uint8_t validity[W * H];
    t3r_view view;
} canvas;

static canvas *canvas_new(uint16_t depth)
{
    canvas *c = unit_array(1, sizeof *c);
    for (int i = 0; i < W * H; i++) {
        c->depth[i] = depth;
    }
    c->view.width = W;
    c->view.height = H;
    for (int k = 0; k < 3; k++) {
        c->view.colour[k] = c->colour[k];
    }
    c->view.depth = c->depth;
    c->view.validity = c->validity;
    return c;
}

static void hole(canvas *c, int x0, int y0, int x1, int y1)
{
    for (int y = y0; y < y1; y++) {
        for (int x = x0; x < x1; x++) {
            c->depth[y * W + x] = 0;
        }
    }
}

/* Fills the canvas; returns the number of filled pixels. */
static uint32_t fill(canvas *c, uint32_t radius)
{
    uint32_t filled = 0;
    t3r_depth_fill(&c->view, radius, &alone);
    for (int i = 0; i < W * H; i++) {
        filled += c->validity[i] == T3R_FILLED;
    }
    return filled;
}

TEST(confidence)
{
    canvas *c = canvas_new(9);
    hole(c, 3, 4, 5, 6);
    t3r_depth_validity(&c->view);
    for (int i = 0; i < W * H; i++) {
        assert_int_equal(c->validity[i], c->depth[i] != 0 ? T3R_MEASURED : T3R_NO_DEPTH);
    }
    free(c);
}

TEST(interpolated)
{
    canvas *c = canvas_new(0);
    /* a ramp along x with a gap of three, in a single row */
    for (int x = 0; x < W; x++) {
        c->depth[5 * W + x] = (uint16_t)(1000 + 10 * x);
    }
    hole(c, 8, 5, 11, 6);
    t3r_depth_validity(&c->view);
    assert_int_equal(fill(c, 3), 3);
    for (int x = 8; x < 11; x++) {
        assert_int_equal(c->depth[5 * W + x], 1000 + 10 * x);
        assert_int_equal(c->validity[5 * W + x], T3R_FILLED);
    }
    assert_int_equal(c->depth[4 * W + 9], 0);
    free(c);
}

/* Only pixels with measured ones within the radius on both sides are filled, for any shape of the hole. */
TEST(reach)
{
    for (uint32_t radius = 0; radius <= 8; radius++) {
        for (int size = 1; size <= 12; size++) {
            canvas *c = canvas_new(500);
            hole(c, 4, 4, 4 + size, 4 + size);
            t3r_depth_validity(&c->view);
            uint32_t expected = 0;
            for (int y = 0; y < size; y++) {
                for (int x = 0; x < size; x++) {
                    int across = x + 1 <= (int)radius && size - x <= (int)radius;
                    int along = y + 1 <= (int)radius && size - y <= (int)radius;
                    expected += across || along;
                }
            }
            assert_int_equal(fill(c, radius), expected);
            if (size > 2 * (int)radius) {
                assert_int_equal(expected, 0);
            }
            free(c);
        }
    }
}

/* Holes at the border are bracketed only along it; a hole in the corner not at all. */
TEST(border)
{
    canvas *c = canvas_new(500);
    hole(c, 0, 6, 1, 8);
    hole(c, W - 1, 0, W, 1);
    hole(c, 0, H - 1, 1, H);
    t3r_depth_validity(&c->view);
    assert_int_equal(fill(c, 8), 2);
    assert_int_equal(c->depth[6 * W], 500);
    assert_int_equal(c->depth[W - 1], 0);
    assert_int_equal(c->depth[(H - 1) * W], 0);
    free(c);
}

/* Across an edge the colour decides, and no depth is invented between the surfaces. */
TEST(edge)
{
    canvas *c = canvas_new(0);
    for (int x = 0; x < W; x++) {
        c->depth[5 * W + x] = x < 10 ? 1000 : 2000;
        c->colour[1][5 * W + x] = x < 9 ? 40 : 200; /* the near object ends between 8 and 9 */
    }
    hole(c, 7, 5, 11, 6);
    t3r_depth_validity(&c->view);
    assert_int_equal(fill(c, 4), 4);
    for (int x = 7; x < 11; x++) {
        assert_int_equal(c->depth[5 * W + x], x < 9 ? 1000 : 2000);
    }
    free(c);

    /* the same colour on both sides: the nearer side; of two at equal distance the first */
    c = canvas_new(0);
    for (int x = 0; x < W; x++) {
        c->depth[5 * W + x] = x < 10 ? 1000 : 2000;
    }
    hole(c, 7, 5, 12, 6);
    t3r_depth_validity(&c->view);
    assert_int_equal(fill(c, 8), 5);
    for (int x = 7; x < 12; x++) {
        assert_int_equal(c->depth[5 * W + x], x <= 9 ? 1000 : 2000);
    }
    free(c);
}

/* Relative difference: up to 1/16 of the lesser depth is still one surface. */
TEST(agreement)
{
    const uint16_t others[] = {1700, 1701};
    const uint16_t between[] = {1650, 1600};
    for (int i = 0; i < 2; i++) {
        canvas *c = canvas_new(0);
        c->depth[5 * W + 5] = 1600;
        c->depth[5 * W + 7] = others[i];
        t3r_depth_validity(&c->view);
        assert_int_equal(fill(c, 1), 1);
        assert_int_equal(c->depth[5 * W + 6], between[i]);
        free(c);
    }
}

/* The narrower of two brackets is taken; of equal ones the horizontal one. */
TEST(nearer_pair)
{
    canvas *c = canvas_new(0);
    c->depth[5 * W + 4] = c->depth[5 * W + 8] = 1000;
    c->depth[4 * W + 6] = c->depth[6 * W + 6] = 3000;
    c->depth[12 * W + 5] = c->depth[12 * W + 7] = 1000;
    c->depth[11 * W + 6] = c->depth[13 * W + 6] = 3000;
    t3r_depth_validity(&c->view);
    (void)fill(c, 2);
    assert_int_equal(c->depth[5 * W + 6], 3000);
    assert_int_equal(c->depth[12 * W + 6], 1000);
    free(c);
}

/* Filled pixels are no seeds: every one lies between two measured ones, whose range holds it. */
TEST(never_seeds)
{
    uint64_t seed = 31;
    for (int turn = 0; turn < 50; turn++) {
        canvas *c = canvas_new(0);
        uint16_t before[W * H];
        for (int i = 0; i < W * H; i++) {
            c->depth[i] = unit_random(&seed) % 3 == 0 ? (uint16_t)unit_between(&seed, 1, 65535) : 0;
            for (int k = 0; k < 3; k++) {
                c->colour[k][i] = (uint8_t)unit_random(&seed);
            }
        }
        memcpy(before, c->depth, sizeof before);
        t3r_depth_validity(&c->view);
        uint32_t filled = fill(c, 3);
        for (int i = 0; i < W * H; i++) {
            if (c->validity[i] == T3R_FILLED) {
                int low = 65536, high = 0;
                for (int k = -3; k <= 3; k++) {
                    int x = i % W + k, y = i / W + k;
                    int across = x >= 0 && x < W ? before[i + k] : 0, along = y >= 0 && y < H ? before[i + k * W] : 0;
                    for (int side = 0; side < 2; side++) {
                        int z = side == 0 ? across : along;
                        low = z != 0 && z < low ? z : low;
                        high = z > high ? z : high;
                    }
                }
                assert_in_range(c->depth[i], low, high);
                filled--;
            } else {
                assert_int_equal(c->depth[i], before[i]);
            }
        }
        assert_int_equal(filled, 0);
        free(c);
    }
}
