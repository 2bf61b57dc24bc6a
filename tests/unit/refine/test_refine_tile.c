/* SPDX-License-Identifier: Apache-2.0 */
/* The contributions of a tile's pixels to splats of all kinds, small and huge, needles, centred far outside, one in
 * front of the other: against sums in double over the rasterizer's own weights, and the same bits for any kept data
 * and any slices of the scene. */
#include "unit/unit.h"

#include "raster/raster_list.h"
#include "refine/refine_tile.h"
#include "state/state.h"

enum { SIDE_OF_TILE = T3R_TILE_SIDE };
enum { SIDE = 64, ACROSS = SIDE / T3R_TILE_SIDE, SPLATS = 150, MOMENTS = T3R_REFINE_MOMENTS_4 };

static uint8_t colour[3][SIDE * SIDE], validity[SIDE * SIDE];
static t3r_view view;
static t3r_gaussian scene[SPLATS];
static t3r_splat splats[SPLATS];
static uint32_t kept[4096 * 8];
static const uint16_t gain_q14[3] = {1 << 14, 17000, 16000};
/* 64 px of focal length, the camera at the origin */
static const t3r_projection projection = {.world_to_camera_q30 = {1 << 30, 0, 0, 0, 1 << 30, 0, 0, 0, 1 << 30},
                                          .fx_q16 = SIDE << 16,
                                          .fy_q16 = SIDE << 16,
                                          .cx_q16 = SIDE << 15,
                                          .cy_q16 = SIDE << 15,
                                          .limit_x_q24 = 16 << 24,
                                          .limit_y_q24 = 16 << 24,
                                          .width = SIDE,
                                          .height = SIDE};

/* Deviations a, b px along an angle, centred at (x, y) px, one after the other in depth */
static bool make_splat(uint32_t i, double x, double y, double a, double b, double angle, uint64_t *seed)
{
    double z = 1 + i / 1024.0, along[3][2] = {{a * cos(angle), -b * sin(angle)}, {a * sin(angle), b * cos(angle)}};
    int exponent = (int)ceil(log2(fmax(a, b) / SIDE * z)) - 14;
    t3r_gaussian *g = &scene[i];
    memset(g, 0, sizeof *g);
    g->position_q20[0] = (int32_t)lround((x - SIDE / 2) / SIDE * z * 1048576);
    g->position_q20[1] = (int32_t)lround((y - SIDE / 2) / SIDE * z * 1048576);
    g->position_q20[2] = (int32_t)lround(z * 1048576);
    g->factor_exponent = (int8_t)exponent;
    for (int row = 0; row < 2; row++) {
        for (int column = 0; column < 2; column++) {
            g->factor[3 * row + column] = (int16_t)lround(ldexp(along[row][column] / SIDE * z, -exponent));
        }
    }
    g->opacity_q15 = (uint16_t)(unit_random(seed) % 3 == 0 ? 32767 : unit_between(seed, 130, 32767));
    for (int c = 0; c < 3; c++) {
        g->colour_q7[c] = (uint16_t)(unit_random(seed) % 8 == 0 ? 32640 : unit_between(seed, 0, 32640));
    }
    return t3r_project(&projection, g, &splats[i]);
}

static double between(uint64_t *seed, double low, double high)
{
    return low + (high - low) * (double)unit_between(seed, 0, 1 << 20) / (1 << 20);
}

static void make_scene(uint64_t seed)
{
    for (uint32_t i = 0; i < SPLATS;) {
        bool huge = i % 10 == 0;
        double size = huge ? exp(between(&seed, log(30), log(4000))) : exp(between(&seed, log(0.2), log(20)));
        double away = huge ? 2 * size : 24, thin = unit_random(&seed) % 2 ? 1 : between(&seed, 0, 1);
        i += make_splat(i, SIDE / 2.0 + between(&seed, -away, away), SIDE / 2.0 + between(&seed, -away, away), size,
                        size * thin, between(&seed, 0, 6.3), &seed);
    }
    for (uint32_t i = 0; i < SIDE * SIDE; i++) {
        for (int c = 0; c < 3; c++) {
            colour[c][i] = (uint8_t)unit_random(&seed);
        }
        validity[i] = unit_random(&seed) % 10 == 0 ? T3R_NO_DEPTH : T3R_MEASURED;
    }
    view.width = view.height = SIDE;
    view.validity = validity;
    for (int c = 0; c < 3; c++) {
        view.colour[c] = colour[c];
    }
}

static uint32_t list_tile(uint32_t x, uint32_t y, uint32_t list[SPLATS])
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < SPLATS; i++) {
        const t3r_splat *s = &splats[i];
        if (s->x0 / T3R_TILE_SIDE <= x && s->x1 / T3R_TILE_SIDE >= x && s->y0 / T3R_TILE_SIDE <= y &&
            s->y1 / T3R_TILE_SIDE >= y) {
            list[count++] = i;
        }
    }
    return count;
}

/* e = T^T S^-1 d, of the splat's own integers */
typedef struct own_axes {
    double k[2][2];
} own_axes;

static own_axes axes_of(const t3r_gaussian *g, const t3r_splat *s)
{
    int32_t row[2][3];
    own_axes axes;
    assert_true(t3r_footprint_rows(&projection, g, row[0], row[1]));
    for (int i = 0; i < 2; i++) {
        axes.k[i][0] = 2 * (row[0][i] / 4096.0 * s->a_q30 + row[1][i] / 4096.0 * s->b_q30) / (1 << 30);
        axes.k[i][1] = 2 * (row[0][i] / 4096.0 * s->b_q30 + row[1][i] / 4096.0 * s->c_q30) / (1 << 30);
    }
    return axes;
}

static void clear_sums(t3r_refine_sums *sums, uint32_t first, uint32_t count)
{
    memset(sums, 0, count * sizeof *sums);
    for (uint32_t i = 0; i < count; i++) {
        const t3r_splat *s = &splats[first + i];
        const own_axes axes = axes_of(&scene[first + i], s);
        sums[i].area = (uint32_t)(s->x1 - s->x0 + 1) * (uint32_t)(s->y1 - s->y0 + 1);
        for (int k = 0; k < 2; k++) {
            sums[i].axes.right_q15[k] = (int16_t)lround(axes.k[k][0] * 32768);
            sums[i].axes.down_q15[k] = (int16_t)lround(axes.k[k][1] * 32768);
        }
    }
}

/* One band: every Gaussian uses its own sums. */
static const t3r_refine_band all_tiles = {0};
static t3r_wanted wanted;

/* The most splats that are drawn again at once. */
static uint32_t again_most;

static bool draws_again(void *context, uint32_t count)
{
    again_most = count > again_most ? count : again_most;
    return context == NULL;
}

static void measure(uint32_t x, uint32_t y, uint32_t first, uint32_t count, uint32_t kept_words, t3r_refine_sums *sums)
{
    uint32_t list[SPLATS], listed = list_tile(x, y, list);
    clear_sums(sums, first, count);
    t3r_refine_view job = {.kernels = &t3r_kernels_c,
                           .view = &view,
                           .splats = splats,
                           .slice = {sums, first, count},
                           .bands = &all_tiles,
                           .wanted = &wanted,
                           .kept = kept,
                           .kept_words = kept_words,
                           .gain_q14 = gain_q14,
                           .goes_on = draws_again};
    t3r_refine_tile(&job, list, listed, x, y);
}

TEST(neither_room_nor_slices_show)
{
    static t3r_refine_sums whole[SPLATS], other[SPLATS];
    static const uint32_t rooms[] = {T3R_KEPT_LEAST, T3R_KEPT_LEAST + 7, 400, 1000, 5000};
    for (uint64_t seed = 1; seed < 6; seed++) {
        make_scene(seed);
        for (uint32_t tile = 0; tile < ACROSS * ACROSS; tile++) {
            uint32_t x = tile % ACROSS, y = tile / ACROSS;
            measure(x, y, 0, SPLATS, sizeof kept / sizeof kept[0], whole);
            for (size_t i = 0; i < sizeof rooms / sizeof rooms[0]; i++) {
                measure(x, y, 0, SPLATS, rooms[i], other);
                assert_memory_equal(whole, other, sizeof whole);
            }
            for (uint32_t first = 0; first < SPLATS; first += 40) {
                uint32_t count = SPLATS - first < 40 ? SPLATS - first : 40;
                measure(x, y, first, count, 600, other + first);
            }
            assert_memory_equal(whole, other, sizeof whole);
        }
    }
}

/* No tile is drawn for Gaussians that do not reach into it. */
TEST(tiles_without_the_slice_are_left_alone)
{
    static t3r_refine_sums none[SPLATS];
    make_scene(1);
    measure(0, 0, 0, SPLATS, sizeof kept / sizeof kept[0], none);
    memset(&wanted, 0x55, sizeof wanted);
    const t3r_wanted before = wanted;
    measure(0, 0, SPLATS, 0, sizeof kept / sizeof kept[0], none);
    assert_memory_equal(&wanted, &before, sizeof wanted);
}

/* A splat's weights in a tile, by its own integers; 0 outside its rows. */
typedef struct layer {
    double weight[SIDE_OF_TILE][SIDE_OF_TILE], alpha[SIDE_OF_TILE][SIDE_OF_TILE];
    bool draws;
} layer;

static void blend_layer(const t3r_splat *s, uint32_t left, uint32_t top, t3r_tile *tile, layer *out)
{
    t3r_tile_splat splat;
    t3r_blended_row rows[T3R_BLENDED_ROWS_MOST];
    const t3r_tile_place place = t3r_tile_place_of(left, top, 0);
    t3r_place(s, &place, &splat);
    memset(out, 0, sizeof *out);
    out->draws = t3r_blend_keep_c(tile, &splat, rows) != 0;
    const t3r_blended_row *row = rows;
    for (uint32_t group = 0; group < splat.groups; group++) {
        for (uint32_t j = splat.first; j <= splat.last; j++, row++) {
            for (uint32_t i = 0; i < T3R_LANES; i++) {
                out->weight[j][splat.column + group * T3R_LANES + i] = row->weight_q16[i] / 65536.0;
                out->alpha[j][splat.column + group * T3R_LANES + i] = row->alpha_q15[i] / 32768.0;
            }
        }
    }
}

/* A tile in double, from the last layer to the first: the colour behind, and the bound on the integers' error. */
typedef struct tile_behind {
    double colour[3][SIDE_OF_TILE][SIDE_OF_TILE], off[SIDE_OF_TILE][SIDE_OF_TILE];
} tile_behind;

/* Sums of a layer in double. `all`: of the absolute values of the terms, with powers of 1 + |e|; `most`: their
 * maximum. */
typedef struct expected {
    double weight, colour[3], lacks_all[3], gg[MOMENTS], gg_all[5], gr[MOMENTS], gr_all[5], gr_most[5], off[5],
        gr_off[5];
} expected;

/* The error of g is at most a unit of w times the largest step, half a unit of its own, and the error of the colour
 * behind. */
static void add_pixel(double w, double unit, double dx, double dy, const double step[3], const double lacks[3],
                      double behind_off, const own_axes *axes, expected *sum)
{
    const double e[2] = {axes->k[0][0] * dx + axes->k[0][1] * dy, axes->k[1][0] * dx + axes->k[1][1] * dy};
    const double g_off = unit * (255.0 / 32768 + 0.5 / 128) + w * behind_off, length = 1 + hypot(e[0], e[1]);
    double gg = 0, gr = 0, gg_off = 0, gr_off = 0;
    for (int c = 0; c < 3; c++) {
        const double g = w * step[c];
        gg += g * g;
        gr += g * lacks[c];
        gg_off += 2 * fabs(g) * g_off + g_off * g_off;
        gr_off += fabs(lacks[c]) * g_off + fabs(g) / 32;
        sum->colour[c] += w * lacks[c];
        sum->lacks_all[c] += fabs(lacks[c]);
    }
    sum->weight += w;
    for (int n = 0, i = 0; n <= 4; n++) {
        for (int l = 0; l <= n; l++, i++) {
            sum->gg[i] += gg * pow(e[0], n - l) * pow(e[1], l);
            sum->gr[i] += gr * pow(e[0], n - l) * pow(e[1], l);
        }
        sum->gg_all[n] += gg * pow(length, n);
        sum->gr_all[n] += fabs(gr) * pow(length, n);
        sum->gr_most[n] = fmax(sum->gr_most[n], fabs(gr) * pow(length, n));
        sum->off[n] += gg_off * pow(length, n);
        sum->gr_off[n] += gr_off * pow(length, n);
    }
}

static double near(double got, double want, double by)
{
    if (!(fabs(got - want) <= by)) {
        print_message("%f, expected %f +- %f\n", got, want, by);
        fail();
    }
    return fabs(got - want) / by;
}

/* Returns the contributions of the layer's pixels, and removes the layer from the tile. */
static expected take_off(const layer *l, const t3r_splat *s, const own_axes *axes, uint32_t left, uint32_t top,
                         const t3r_tile *drawn, double unit, tile_behind *behind)
{
    expected sum = {0};
    for (uint32_t j = 0; j < SIDE_OF_TILE; j++) {
        for (uint32_t i = 0; i < SIDE_OF_TILE; i++) {
            const uint32_t x = left + i, y = top + j;
            double step[3], lacks[3];
            for (int c = 0; c < 3; c++) {
                const double target = fmin(255, colour[c][y * SIDE + x] * (gain_q14[c] / 16384.0));
                step[c] = s->colour_q7[c] / 128.0 - behind->colour[c][j][i];
                lacks[c] = target - drawn->colour_q7[c][j][i] / 128.0;
                behind->colour[c][j][i] += l->alpha[j][i] * step[c];
            }
            if (l->weight[j][i] != 0 && validity[y * SIDE + x] != T3R_NO_DEPTH) {
                add_pixel(l->weight[j][i], unit, x - s->x_q12 / 4096.0, y - s->y_q12 / 4096.0, step, lacks,
                          behind->off[j][i], axes, &sum);
            }
            behind->off[j][i] = (1 - l->alpha[j][i]) * behind->off[j][i] + 0.5 / 128;
        }
    }
    return sum;
}

static double largest_of(const layer *l)
{
    double most = 0;
    for (uint32_t k = 0; k < SIDE_OF_TILE * SIDE_OF_TILE; k++) {
        most = fmax(most, l->weight[k / SIDE_OF_TILE][k % SIDE_OF_TILE]);
    }
    return most;
}

/* Weights have 10 to 15 bits, rounded down. The error of moments is at most a hundredth of their terms, which have 8
 * to 14 bits, and the largest g . r. */
static double compare_sums(const t3r_refine_sums *got, const expected *want, double unit)
{
    const double h = 1 << t3r_refine_shift(got->area);
    double share = near(got->weight / 32768.0 * h, want->weight, unit / 1024 * 256 + h / 32768);
    for (int c = 0; c < 3; c++) {
        const double off = unit / 1024 * want->lacks_all[c] + want->weight / 16 + h / 2048;
        share = fmax(share, near(got->colour[c] / 2048.0 * h, want->colour[c], off));
    }
    for (int n = 0, i = 0; n <= 4; n++) {
        for (int l = 0; l <= n; l++, i++) {
            const double off = want->off[n] + want->gg_all[n] / 100 + h / 128;
            share = fmax(share, near(got->curvature[i] / 128.0 * h, want->gg[i], off));
            if (n <= 2) {
                const double gr_off = want->gr_off[n] + want->gr_all[n] / 100 + want->gr_most[n] + h / 128;
                share = fmax(share, near(got->gradient[i] / 128.0 * h, want->gr[i], gr_off));
            }
        }
    }
    return share;
}

TEST(follows_double)
{
    static t3r_refine_sums sums[SPLATS];
    static layer layers[SPLATS];
    static tile_behind behind;
    uint32_t accumulated = 0;
    double share = 0;
    for (uint64_t seed = 11; seed < 31; seed++) {
        make_scene(seed);
        for (uint32_t number = 0; number < ACROSS * ACROSS; number++) {
            const uint32_t left = number % ACROSS * T3R_TILE_SIDE, top = number / ACROSS * T3R_TILE_SIDE;
            uint32_t list[SPLATS], count = list_tile(number % ACROSS, number / ACROSS, list);
            measure(number % ACROSS, number / ACROSS, 0, SPLATS, 2000, sums);
            t3r_tile drawn;
            t3r_tile_clear(&drawn);
            for (uint32_t n = 0; n < count; n++) {
                blend_layer(&splats[list[n]], left, top, &drawn, &layers[n]);
            }
            memset(&behind, 0, sizeof behind);
            for (uint32_t n = count; n-- > 0;) {
                if (!layers[n].draws) {
                    assert_int_equal(sums[list[n]].weight, 0);
                    continue;
                }
                const t3r_splat *s = &splats[list[n]];
                const own_axes axes = axes_of(&scene[list[n]], s);
                const double unit = exp2(floor(log2(largest_of(&layers[n]))) + 1); /* 2^-scale */
                const expected want = take_off(&layers[n], s, &axes, left, top, &drawn, unit, &behind);
                share = fmax(share, compare_sums(&sums[list[n]], &want, unit));
                accumulated++;
            }
        }
    }
    print_message("%u splats accumulated, off by at most %.2f of what is allowed\n", accumulated, share);
    assert_true(accumulated > 5000);
}

/* A Gaussian that is not in front of the camera has no footprint there. */
TEST(unseen_have_no_footprint)
{
    t3r_gaussian g = scene[0];
    int32_t a[3], b[3];
    assert_true(t3r_footprint_rows(&projection, &g, a, b));
    for (int i = 0; i < 3; i++) {
        g.position_q20[i] = 2 * projection.centre_q20[i] - g.position_q20[i];
    }
    assert_false(t3r_footprint_rows(&projection, &g, a, b));
}

/* Makes small splats in the view and around it; faint ones have boxes of one pixel. */
static void make_small(uint64_t *seed)
{
    for (uint32_t i = 0; i < SPLATS;) {
        const double x = between(seed, -3, SIDE + 3), y = between(seed, -3, SIDE + 3);
        const bool shows =
            make_splat(i, x, y, between(seed, 0.1, 1.5), between(seed, 0.1, 1.5), between(seed, 0, 6.3), seed);
        scene[i].opacity_q15 = i % 2 == 0 ? scene[i].opacity_q15 : 130;
        i += shows && t3r_project(&projection, &scene[i], &splats[i]);
    }
}

/* Returns whether a splat's box on a lattice holds those of its pixels that the box in the view holds; `any`: of them
 * there is one. */
static bool is_same_box(const t3r_splat *in_view, const t3r_splat *s, const t3r_lattice *lattice, bool *any)
{
    bool same = true;
    *any = false;
    for (uint32_t pixel = 0; pixel < SIDE * SIDE / 4; pixel++) {
        const uint32_t x = pixel % (SIDE / 2), y = pixel / (SIDE / 2), u = 2 * x + lattice->x, v = 2 * y + lattice->y;
        const bool on = u >= in_view->x0 && u <= in_view->x1 && v >= in_view->y0 && v <= in_view->y1;
        same = same && (s->z_q20 != 0 && x >= s->x0 && x <= s->x1 && y >= s->y0 && y <= s->y1) == on;
        *any = *any || on;
    }
    return same;
}

/* A splat's box on a lattice holds those of its pixels that the box in the view holds, and its centre stays. */
TEST(boxes_on_lattices)
{
    static _Alignas(T3R_ARENA_ALIGN) uint8_t arena[1 << 20];
    static t3r_splat listed[SPLATS];
    static uint32_t order[T3R_SORT_BYTES / 4 + 4 * SPLATS], table[ACROSS * ACROSS], lists[SPLATS];
    const t3r_raster_room room = {listed, order, table, lists, SPLATS};
    const t3r_config config = t3r_default_config(SIDE, SIDE, 0, SPLATS);
    const t3r_scene_frame frame = {0};
    t3r_runtime *rt;
    uint64_t seed = 9;
    assert_int_equal(t3r_init(&rt, arena, sizeof arena, &config), T3R_OK);
    for (uint32_t turn = 0; turn < 40; turn++) {
        const t3r_lattice lattice = {1, turn & 1, turn >> 1 & 1};
        make_small(&seed);
        assert_int_equal(t3r_scene_begin(rt, &frame), T3R_OK);
        for (uint32_t i = 0; i < SPLATS; i++) {
            assert_int_equal(t3r_scene_append(rt, &scene[i]), T3R_OK);
        }
        const t3r_binning bin = t3r_raster_list(rt, &projection, &lattice, &room);
        uint32_t visible = 0;
        for (uint32_t i = 0; i < SPLATS; i++) {
            bool any;
            assert_true(is_same_box(&splats[i], &listed[i], &lattice, &any));
            assert_int_equal(listed[i].x_q12, splats[i].x_q12 - (int32_t)(lattice.x << 12));
            assert_int_equal(listed[i].y_q12, splats[i].y_q12 - (int32_t)(lattice.y << 12));
            visible += any;
        }
        assert_int_equal(bin.visible, visible);
        assert_true(visible < SPLATS);
    }
}
