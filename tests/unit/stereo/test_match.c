/* SPDX-License-Identifier: Apache-2.0 */
/* Matching: the census against its definition, semi-global matching in blocks against one that keeps everything, and
 * the treatment of wrong disparities. */
#include "unit/unit.h"

#include "stereo/match.h"
#include "stereo/match_clean.h"

static const int opposite[17][2] = {{1, 0}, {2, 0},  {3, 0},  {-3, 1}, {-2, 1}, {-1, 1}, {0, 1}, {1, 1}, {2, 1},
                                    {3, 1}, {-3, 2}, {-2, 2}, {-1, 2}, {0, 2},  {1, 2},  {2, 2}, {3, 2}};
static const int around[7][2] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {2, 0}, {-2, 0}, {0, 2}};

static int at(const uint8_t *picture, int width, int height, int x, int y)
{
    x = x < 0 ? 0 : x >= width ? width - 1 : x;
    y = y < 0 ? 0 : y >= height ? height - 1 : y;
    return picture[y * width + x];
}

/* Computes the 24 comparisons of SPEC.md, each a byte. */
static void census_of(const uint8_t *picture, int width, int height, int x, int y, uint8_t bits[24])
{
    for (int i = 0; i < 17; i++) {
        const int *d = opposite[i];
        bits[i] = at(picture, width, height, x + d[0], y + d[1]) > at(picture, width, height, x - d[0], y - d[1]);
    }
    for (int i = 0; i < 7; i++) {
        const int *d = around[i];
        bits[17 + i] = at(picture, width, height, x + d[0], y + d[1]) > at(picture, width, height, x, y);
    }
}

static int naive_cost(const t3r_match *m, int x, int y, int k)
{
    const int width = (int)m->width, height = (int)m->height, right = width + (int)m->disparities - 1;
    const int j = x + (int)m->disparities - 1 - k;
    uint8_t a[24], b[24];
    int cost = 0;
    if (m->luma[0][y * width + x] == 0) {
        return 0;
    }
    census_of(m->luma[0], width, height, x, y, a);
    census_of(m->luma[1], right, height, j, y, b);
    for (int i = 0; i < 24; i++) {
        cost += a[i] != b[i];
    }
    return m->luma[1][y * right + j] == 0 && cost < 12 ? 12 : cost;
}

static void census(void **state)
{
    (void)state;
    uint64_t seed = 3;
    for (int width = 2; width <= 40; width++) {
        uint8_t *picture = unit_array((size_t)width * 5, 1), *bits = unit_array((size_t)width * 3, 1);
        const uint8_t *rows[T3R_CENSUS_ROWS];
        for (int i = 0; i < 5 * width; i++) {
            picture[i] = (uint8_t)unit_between(&seed, 1, 9);
        }
        for (int i = 0; i < 5; i++) {
            rows[i] = picture + i * width;
        }
        t3r_census_row_c(rows, (uint32_t)width, (uint32_t)width, bits);
        for (int x = 0; x < width; x++) {
            uint8_t expected[24];
            census_of(picture, width, 5, x, 2, expected);
            for (int i = 0; i < 24; i++) {
                assert_int_equal(bits[i / 8 * width + x] >> (7 - i % 8) & 1, expected[i]);
            }
        }
        free(picture);
        free(bits);
    }
}

typedef struct pair {
    t3r_match m;
    uint8_t *luma[2];
    size_t pixels[2];
} pair;

static pair pair_new(uint32_t width, uint32_t height, uint32_t disparities, uint32_t paths)
{
    pair p = {.m = {.width = width,
                    .height = height,
                    .disparities = disparities,
                    .kernels = &t3r_kernels_c,
                    .paths = paths,
                    .p1 = 12,
                    .p2 = 60,
                    .p2_min = 15}};
    p.pixels[0] = (size_t)width * height;
    p.pixels[1] = T3R_MATCH_RIGHT(width, disparities) * height;
    for (int i = 0; i < 2; i++) {
        p.luma[i] = unit_array(p.pixels[i], 1);
        p.m.luma[i] = p.luma[i];
        p.m.disparity[i] = unit_array(p.pixels[i], 2);
        p.m.confidence[i] = unit_array(p.pixels[i], 1);
    }
    p.m.work = unit_array(T3R_MATCH_WORK_BYTES(width, height, disparities, paths), 1);
    return p;
}

static void pair_free(pair *p)
{
    for (int i = 0; i < 2; i++) {
        free(p->luma[i]);
        free(p->m.disparity[i]);
        free(p->m.confidence[i]);
    }
    free(p->m.work);
}

/* Computes all costs of all paths; sums: width x height x disparities. */
static void naive_sums(const t3r_match *m, int *sums)
{
    static const int steps[8][2] = {{0, 1}, {1, 0}, {0, -1}, {-1, 0}, {1, 1}, {-1, 1}, {1, -1}, {-1, -1}};
    const int width = (int)m->width, height = (int)m->height, count = (int)m->disparities;
    int *cost = unit_array((size_t)width * (size_t)height * (size_t)count, sizeof(int));
    int *path = unit_array((size_t)width * (size_t)height * (size_t)count, sizeof(int));
    for (int i = 0; i < width * height * count; i++) {
        cost[i] = naive_cost(m, i / count % width, i / count / width, i % count);
        sums[i] = 0;
    }
    for (uint32_t d = 0; d < m->paths; d++) {
        const int dx = steps[d][0], dy = steps[d][1];
        for (int n = 0; n < width * height; n++) {
            const int x = dx < 0 ? width - 1 - n % width : n % width, y = dy < 0 ? height - 1 - n / width : n / width;
            const int u = x - dx, v = y - dy, here = (y * width + x) * count, before = (v * width + u) * count;
            int least = 1 << 30, p2 = 0;
            if (u >= 0 && v >= 0 && u < width && v < height) {
                for (int k = 0; k < count; k++) {
                    least = path[before + k] < least ? path[before + k] : least;
                }
                p2 = (int)m->p2 * 8 / (8 + abs(m->luma[0][y * width + x] - m->luma[0][v * width + u]));
                p2 = p2 < (int)m->p2_min ? (int)m->p2_min : p2;
            }
            for (int k = 0; k < count; k++) {
                int best = 0;
                if (least < 1 << 30) {
                    best = path[before + k];
                    for (int side = -1; side <= 1; side += 2) {
                        if (k + side >= 0 && k + side < count && path[before + k + side] + (int)m->p1 < best) {
                            best = path[before + k + side] + (int)m->p1;
                        }
                    }
                    best = best - least < p2 ? best - least : p2;
                }
                path[here + k] = cost[here + k] + best;
                sums[here + k] += path[here + k];
            }
        }
    }
    free(cost);
    free(path);
}

static int refined(int k, int before, int least, int after)
{
    const int steeper = (before > after ? before : after) - least;
    return steeper == 0 ? 128 * k : 128 * k + (int)floor((before - after) * 128.0 / (2.0 * steeper) + 0.5);
}

static void blocks(void **state)
{
    (void)state;
    /* tall pictures have blocks of 16, 32 and 64 rows */
    static const uint32_t shapes[][3] = {{16, 8, 16},  {17, 9, 16}, {20, 33, 32}, {9, 131, 16},
                                         {33, 16, 48}, {8, 8, 64},  {9, 515, 16}, {8, 2050, 16}};
    uint64_t seed = 5;
    for (size_t shape = 0; shape < sizeof shapes / sizeof *shapes; shape++) {
        for (uint32_t paths = 4; paths <= 8; paths += 4) {
            pair p = pair_new(shapes[shape][0], shapes[shape][1], shapes[shape][2], paths);
            const int width = (int)p.m.width, height = (int)p.m.height, count = (int)p.m.disparities;
            const int right = width + count - 1;
            for (int i = 0; i < 2; i++) {
                for (size_t n = 0; n < p.pixels[i]; n++) {
                    p.luma[i][n] = unit_random(&seed) % 16 == 0 ? 0 : (uint8_t)unit_between(&seed, 1, 255);
                }
            }
            t3r_match_pair(&p.m);
            int *sums = unit_array((size_t)width * (size_t)height * (size_t)count, sizeof(int));
            naive_sums(&p.m, sums);
            for (int y = 0; y < height; y++) {
                for (int x = 0; x < width; x++) {
                    const int *s = sums + (y * width + x) * count;
                    int k = 0;
                    for (int i = 1; i < count; i++) {
                        k = s[i] < s[k] ? i : k;
                    }
                    const int shown = p.luma[0][y * width + x] && p.luma[1][y * right + x + count - 1 - k];
                    const int inside = k > 0 && k + 1 < count;
                    const int expected = !shown    ? T3R_NO_DISPARITY
                                         : !inside ? 128 * k
                                                   : refined(k, s[k - 1], s[k], s[k + 1]);
                    assert_int_equal(p.m.disparity[0][y * width + x], expected);
                    assert_int_equal(p.m.confidence[0][y * width + x] != 0, shown);
                }
                for (int j = 0; j < right; j++) {
                    int k = -1;
                    for (int i = 0; i < count; i++) {
                        const int x = j - (count - 1) + i;
                        if (x >= 0 && x < width && p.luma[0][y * width + x] != 0) {
                            const int before = k < 0 ? 1 << 30 : sums[(y * width + j - (count - 1) + k) * count + k];
                            k = sums[(y * width + x) * count + i] < before ? i : k;
                        }
                    }
                    const int got = p.m.disparity[1][y * right + j];
                    if (k < 0 || p.luma[1][y * right + j] == 0) {
                        assert_int_equal(got, T3R_NO_DISPARITY);
                    } else {
                        assert_in_range(got + 64, 128 * k, 128 * k + 128);
                    }
                }
            }
            free(sums);
            pair_free(&p);
        }
    }
}

/* Draws a texture twice, the second time `shift` columns further with a gain of `gain` / 256. */
static void seen_twice(pair *p, uint32_t shift, uint32_t gain)
{
    const uint32_t width = p->m.width, height = p->m.height, right = (uint32_t)T3R_MATCH_RIGHT(width, p->m.disparities);
    uint64_t seed = 9;
    for (uint32_t y = 0; y < height; y++) {
        for (uint32_t j = 0; j < right; j++) {
            const uint32_t value = (uint32_t)unit_between(&seed, 10, 250);
            const uint32_t x = j + shift - (p->m.disparities - 1); /* j = x + disparities - 1 - shift */
            p->luma[1][y * right + j] = (uint8_t)(value * gain / 256);
            if (x < width) {
                p->luma[0][y * width + x] = (uint8_t)value;
            }
        }
    }
}

static void shifted(void **state)
{
    (void)state;
    for (uint32_t gain = 256; gain >= 128; gain -= 128) {
        for (uint32_t paths = 4; paths <= 8; paths += 4) {
            pair p = pair_new(64, 40, 32, paths);
            seen_twice(&p, 11, gain);
            t3r_match_all(&p.m, true);
            /* the last columns' partners also lie inside: all of the left plane is found, to the last pixel */
            for (size_t i = 0; i < p.pixels[0]; i++) {
                if (p.luma[0][i] != 0) {
                    assert_in_range(p.m.disparity[0][i], 11 * 128 - 64, 11 * 128 + 64);
                    assert_true(p.m.confidence[0][i] > 60);
                }
            }
            pair_free(&p);
        }
    }
}

static void set(pair *p, uint32_t side, uint16_t disparity, uint8_t confidence)
{
    for (size_t i = 0; i < p->pixels[side]; i++) {
        p->m.disparity[side][i] = disparity;
        p->m.confidence[side][i] = confidence;
        p->luma[side][i] = 100;
    }
}

static void agreement(void **state)
{
    (void)state;
    pair p = pair_new(40, 8, 16, 4);
    const uint32_t right = 55;
    set(&p, 0, 5 * 128, 77);
    set(&p, 1, 5 * 128, 0);
    p.m.disparity[0][3 * 40 + 20] = 5 * 128 + 128; /* a pixel off still counts as agreement */
    p.m.disparity[0][3 * 40 + 21] = 7 * 128 + 1;   /* more does not */
    p.m.disparity[1][5 * right + 30] = T3R_NO_DISPARITY;
    t3r_match_agree(&p.m);
    for (uint32_t y = 0; y < 8; y++) {
        for (uint32_t x = 0; x < 40; x++) {
            const int wrong = (y == 3 && x == 21) || (y == 5 && x == 20); /* 20 + 15 - 5 = 30 */
            assert_int_equal(p.m.confidence[0][y * 40 + x], wrong ? 0 : 77);
        }
        for (uint32_t j = 0; j < right; j++) {
            const int wrong = j < 10 || j >= 50 || (y == 3 && j == 31) || (y == 5 && j == 30);
            assert_int_equal(p.m.confidence[1][y * right + j], wrong ? 0 : 77);
        }
    }
    pair_free(&p);
}

static void speckles(void **state)
{
    (void)state;
    pair p = pair_new(128, 80, 16, 4); /* 11 pixels are large */
    set(&p, 0, 5 * 128, 9);
    for (uint32_t i = 0; i < 10; i++) {
        p.m.disparity[0][30 * 128 + 20 + i] = 9 * 128;
    }
    for (uint32_t i = 0; i < 11; i++) {
        p.m.disparity[0][50 * 128 + 20 + i] = (uint16_t)(9 * 128 + 100 * (i % 2)); /* within a pixel of each other */
    }
    assert_int_equal(t3r_match_speckles(&p.m, 0), 10);
    for (uint32_t i = 0; i < 128 * 80; i++) {
        assert_int_equal(p.m.confidence[0][i], i >= 30 * 128 + 20 && i < 30 * 128 + 30 ? 0 : 9);
    }
    pair_free(&p);

    /* against labels spread until nothing changes */
    uint64_t seed = 21;
    p = pair_new(60, 70, 16, 8);
    for (int turn = 0; turn < 20; turn++) {
        uint32_t label[60 * 70], size[60 * 70] = {0}, least = T3R_MATCH_LEAST_REGION(60, 70), changed = 1;
        uint8_t before[60 * 70];
        for (uint32_t i = 0; i < 60 * 70; i++) {
            p.m.disparity[0][i] = (uint16_t)(unit_random(&seed) % 3 * 129);
            p.m.confidence[0][i] = before[i] = unit_random(&seed) % 9 != 0;
            label[i] = i;
        }
        while (changed) {
            changed = 0;
            for (uint32_t i = 0; i < 60 * 70; i++) {
                const uint32_t next[2] = {i % 60 < 59 ? i + 1 : i, i + 60 < 60 * 70 ? i + 60 : i};
                for (int n = 0; n < 2; n++) {
                    const uint32_t j = next[n];
                    if (before[i] && before[j] && p.m.disparity[0][i] == p.m.disparity[0][j] && label[i] != label[j]) {
                        label[i] = label[j] = label[i] < label[j] ? label[i] : label[j];
                        changed = 1;
                    }
                }
            }
        }
        for (uint32_t i = 0; i < 60 * 70; i++) {
            size[label[i]] += before[i];
        }
        t3r_match_speckles(&p.m, 0);
        for (uint32_t i = 0; i < 60 * 70; i++) {
            assert_int_equal(p.m.confidence[0][i], before[i] && size[label[i]] >= least);
        }
    }
    pair_free(&p);
}

static int rising(const void *a, const void *b)
{
    return *(const uint16_t *)a - *(const uint16_t *)b;
}

static void smoothing(void **state)
{
    (void)state;
    uint64_t seed = 8;
    pair p = pair_new(37, 30, 16, 4);
    for (uint32_t side = 0; side < 2; side++) {
        const int width = side == 0 ? 37 : 52;
        uint16_t before[52 * 30];
        for (int i = 0; i < width * 30; i++) {
            before[i] = p.m.disparity[side][i] = (uint16_t)unit_between(&seed, 0, 32767);
            p.m.confidence[side][i] = unit_random(&seed) % 40 != 0;
        }
        int changed = 0;
        t3r_match_smooth(&p.m, side);
        for (int i = 0; i < width * 30; i++) {
            const int x = i % width, y = i / width;
            uint16_t nine[9];
            int count = 0;
            for (int n = 0; n < 9; n++) {
                const int u = x + n % 3 - 1, v = y + n / 3 - 1;
                if (u >= 0 && v >= 0 && u < width && v < 30 && p.m.confidence[side][v * width + u] != 0) {
                    nine[count++] = before[v * width + u];
                }
            }
            qsort(nine, (size_t)count, sizeof *nine, rising);
            assert_int_equal(p.m.disparity[side][i], count == 9 ? nine[4] : before[i]);
            changed += count == 9;
        }
        assert_true(changed > width * 30 / 2);
    }
    pair_free(&p);
}

static void filling(void **state)
{
    (void)state;
    pair p = pair_new(60, 40, 16, 4);
    set(&p, 0, 0, 9);
    set(&p, 1, T3R_NO_DISPARITY, 0);
    for (uint32_t i = 0; i < 60 * 40; i++) {
        p.m.disparity[0][i] = i % 60 < 30 ? 4 * 128 : 10 * 128;
    }
    for (uint32_t y = 10; y < 20; y++) {
        for (uint32_t x = 26; x < 34; x++) {
            p.m.confidence[0][y * 60 + x] = 0;
        }
    }
    for (uint32_t y = 25; y < 40; y++) {
        for (uint32_t x = 0; x < 60; x++) {
            p.m.confidence[0][y * 60 + x] = 0;
        }
    }
    t3r_match_fill(&p.m, 0);
    /* no pixel of the other picture leads there: hidden, so the farther surface is used */
    for (uint32_t y = 10; y < 20; y++) {
        for (uint32_t x = 26; x < 34; x++) {
            assert_int_equal(p.m.disparity[0][y * 60 + x], 4 * 128);
            assert_int_equal(p.m.confidence[0][y * 60 + x], 0);
        }
    }
    /* open to three sides: not a hole */
    for (uint32_t i = 25 * 60; i < 40 * 60; i++) {
        assert_int_equal(p.m.disparity[0][i], T3R_NO_DISPARITY);
    }
    /* an edge of luma between the hole's nearer half and the farther surface: each half takes its own side */
    for (uint32_t i = 0; i < 60 * 40; i++) {
        p.luma[0][i] = i % 60 < 30 ? 60 : 160;
    }
    t3r_match_fill(&p.m, 0);
    for (uint32_t x = 26; x < 34; x++) {
        assert_int_equal(p.m.disparity[0][14 * 60 + x], x < 30 ? 4 * 128 : 10 * 128);
    }
    /* black pixels stay empty */
    p.luma[0][15 * 60 + 28] = 0;
    t3r_match_fill(&p.m, 0);
    assert_int_equal(p.m.disparity[0][15 * 60 + 28], T3R_NO_DISPARITY);
    pair_free(&p);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(census),   cmocka_unit_test(blocks),    cmocka_unit_test(shifted), cmocka_unit_test(agreement),
        cmocka_unit_test(speckles), cmocka_unit_test(smoothing), cmocka_unit_test(filling)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
