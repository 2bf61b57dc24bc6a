/* What a tile's pixels tell splats of all kinds, small and huge, needles, centred far outside, one behind the other:
 * against sums in double over the rasterizer's own weights, and the same bits whatever is kept between the drawings and
 * however the scene is sliced. */
#include "unit.h"

#include "refine/refine_tile.h"

enum { SIDE = 64, ACROSS = SIDE / T3R_TILE_SIDE, SPLATS = 150, MOMENTS = T3R_REFINE_MOMENTS_4 };

static uint8_t colour[3][SIDE * SIDE], validity[SIDE * SIDE];
static t3r_view view;
static t3r_gaussian scene[SPLATS];
static t3r_splat splats[SPLATS];
static t3r_blend_weights kept[4096];
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

static void clear_sums(t3r_refine_sums *sums, uint32_t first, uint32_t count)
{
    memset(sums, 0, count * sizeof *sums);
    for (uint32_t i = 0; i < count; i++) {
        const t3r_splat *s = &splats[first + i];
        sums[i].area = (uint32_t)(s->x1 - s->x0 + 1) * (uint32_t)(s->y1 - s->y0 + 1);
    }
}

/* One band: every Gaussian adds to its own sums. */
static const t3r_refine_band all_tiles = {0};
static t3r_wanted wanted;

static void measure(uint32_t x, uint32_t y, uint32_t first, uint32_t count, uint32_t kept_rows, t3r_refine_sums *sums)
{
    uint32_t list[SPLATS], listed = list_tile(x, y, list);
    clear_sums(sums, first, count);
    t3r_refine_view job = {.kernels = &t3r_kernels_c,
                           .view = &view,
                           .projection = &projection,
                           .scene = scene,
                           .splats = splats,
                           .slice = {sums, first, count},
                           .bands = &all_tiles,
                           .wanted = &wanted,
                           .kept = kept_rows == 0 ? NULL : kept,
                           .kept_rows = kept_rows,
                           .gain_q14 = gain_q14};
    t3r_refine_tile(&job, list, listed, x, y);
}

static void neither_room_nor_slices_show(void **state)
{
    (void)state;
    static t3r_refine_sums whole[SPLATS], other[SPLATS];
    static const uint32_t rooms[] = {1, 7, 16, 100, 500, 4096};
    for (uint64_t seed = 1; seed < 6; seed++) {
        make_scene(seed);
        for (uint32_t tile = 0; tile < ACROSS * ACROSS; tile++) {
            uint32_t x = tile % ACROSS, y = tile / ACROSS;
            measure(x, y, 0, SPLATS, 0, whole);
            for (size_t i = 0; i < sizeof rooms / sizeof rooms[0]; i++) {
                measure(x, y, 0, SPLATS, rooms[i], other);
                assert_memory_equal(whole, other, sizeof whole);
            }
            for (uint32_t first = 0; first < SPLATS; first += 40) {
                uint32_t count = SPLATS - first < 40 ? SPLATS - first : 40;
                measure(x, y, first, count, 300, other + first);
            }
            assert_memory_equal(whole, other, sizeof whole);
        }
    }
}

/* Sums in double, and by how much the integers may be off: g by its units (in the scale of the largest w) and the
 * reciprocal's error; each moment by a thousandth of its terms, and by a level^2. */
typedef struct expected {
    double weight, colour[3], gg[MOMENTS], gg_off[MOMENTS], gr[MOMENTS], gr_off[MOMENTS];
} expected;

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

typedef struct pixel {
    double w, left, colour[3], drawn[3], target[3], dx, dy;
} pixel;

static void add_pixel(const pixel *p, const t3r_splat *s, const own_axes *axes, double unit, expected *sum)
{
    double e[2], length;
    for (int i = 0; i < 2; i++) {
        e[i] = axes->k[i][0] * p->dx + axes->k[i][1] * p->dy;
    }
    length = hypot(e[0], e[1]);
    double gg = 0, gg_off = 0.125 * unit * unit, gr = 0, gr_off = 0.0625 * unit;
    for (int c = 0; c < 3; c++) {
        double behind = p->left == 0 ? 0 : (p->drawn[c] - p->colour[c]) / p->left, r = p->target[c] - p->drawn[c];
        double g = p->w * (s->colour_q7[c] / 128.0 - behind);
        double off = unit * (0.5 / 64 + 255.0 / 65536) + p->w * (1.0 / 128 + behind / 8192);
        gg += g * g;
        gg_off += 2 * fabs(g) * off + off * off;
        gr += g * r;
        gr_off += fabs(r) * off + fabs(g) / 32;
        sum->colour[c] += p->w * r;
    }
    sum->weight += p->w;
    for (int n = 0, i = 0; n <= 4; n++) {
        for (int l = 0; l <= n; l++, i++) {
            double power = pow(e[0], n - l) * pow(e[1], l), most = pow(1 + length, n);
            sum->gg[i] += gg * power;
            sum->gg_off[i] += (gg_off + gg / 1000) * most;
            sum->gr[i] += gr * power;
            sum->gr_off[i] += (gr_off + fabs(gr) / 1000) * most;
        }
    }
}

static void draw(const t3r_splat *s, uint32_t left, uint32_t top, t3r_tile *tile)
{
    t3r_tile_splat splat;
    t3r_splat_in_tile(s, left, top, &splat);
    t3r_blend_c(tile, &splat, NULL);
}

static pixel pixel_of(const t3r_tile *before, const t3r_tile *after, const t3r_tile *drawn, const t3r_splat *s,
                      uint32_t left, uint32_t top, uint32_t i, uint32_t j)
{
    uint32_t x = left + i, y = top + j;
    pixel p = {
        .left = after->transmittance_q16[j][i] / 65536.0, .dx = x - s->x_q12 / 4096.0, .dy = y - s->y_q12 / 4096.0};
    if (validity[y * SIDE + x] != T3R_NO_DEPTH && x >= s->x0 && x <= s->x1) {
        p.w = (before->transmittance_q16[j][i] - after->transmittance_q16[j][i]) / 65536.0;
    }
    for (int c = 0; c < 3; c++) {
        p.colour[c] = after->colour_q7[c][j][i] / 128.0;
        p.drawn[c] = drawn->colour_q7[c][j][i] / 128.0;
        p.target[c] = fmin(255, colour[c][y * SIDE + x] * (gain_q14[c] / 16384.0));
    }
    return p;
}

static void near(double got, double want, double by)
{
    if (!(fabs(got - want) <= by)) {
        print_message("%f, expected %f +- %f\n", got, want, by);
        fail();
    }
}

static void follows_double(void **state)
{
    (void)state;
    static t3r_refine_sums sums[SPLATS];
    uint32_t told = 0;
    for (uint64_t seed = 11; seed < 31; seed++) {
        make_scene(seed);
        for (uint32_t number = 0; number < ACROSS * ACROSS; number++) {
            uint32_t left = number % ACROSS * T3R_TILE_SIDE, top = number / ACROSS * T3R_TILE_SIDE;
            uint32_t list[SPLATS], count = list_tile(number % ACROSS, number / ACROSS, list);
            measure(number % ACROSS, number / ACROSS, 0, SPLATS, 200, sums);
            t3r_tile drawn, tile;
            t3r_tile_clear(&drawn);
            t3r_tile_clear(&tile);
            for (uint32_t i = 0; i < count; i++) {
                draw(&splats[list[i]], left, top, &drawn);
            }
            for (uint32_t n = 0; n < count; n++) {
                const t3r_splat *s = &splats[list[n]];
                const t3r_refine_sums *got = &sums[list[n]];
                t3r_tile before = tile;
                draw(s, left, top, &tile);
                double most = 0, h = 1 << t3r_refine_shift(got->area);
                own_axes axes = axes_of(&scene[list[n]], s);
                expected want = {0};
                for (uint32_t i = 0; i < 256; i++) {
                    most = fmax(most, pixel_of(&before, &tile, &drawn, s, left, top, i % 16, i / 16).w);
                }
                if (most == 0) {
                    assert_int_equal(got->weight, 0);
                    continue;
                }
                told++;
                double unit = exp2(floor(log2(most)) + 1); /* 2^-s */
                for (uint32_t i = 0; i < 256; i++) {
                    pixel p = pixel_of(&before, &tile, &drawn, s, left, top, i % 16, i / 16);
                    if (p.w != 0) {
                        add_pixel(&p, s, &axes, unit, &want);
                    }
                }
                near(got->weight / 32768.0 * h, want.weight, unit / 32768 * 256 + h / 32768);
                for (int c = 0; c < 3; c++) {
                    near(got->colour[c] / 2048.0 * h, want.colour[c], unit / 128 * 256 + want.weight / 16 + h / 2048);
                }
                for (int i = 0; i < MOMENTS; i++) {
                    near(got->curvature[i] / 128.0 * h, want.gg[i], want.gg_off[i] + 1 + h / 128);
                    if (i < T3R_REFINE_MOMENTS_2) {
                        near(got->gradient[i] / 128.0 * h, want.gr[i], want.gr_off[i] + 1 + h / 128);
                    }
                }
            }
        }
    }
    print_message("%u splats told\n", told);
    assert_true(told > 5000);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(neither_room_nor_slices_show),
        cmocka_unit_test(follows_double),
    };
    return cmocka_run_group_tests_name("refine_tile", tests, NULL, NULL);
}
