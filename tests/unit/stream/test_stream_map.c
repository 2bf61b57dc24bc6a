/* SPDX-License-Identifier: Apache-2.0 */
/* The Gaussians that stay in a stream's map: compared with sorting; those that stay grow and change in nothing else;
 * moves are exact. */
#include "unit/unit.h"

#include "budget/budget.h"
#include "core/fixed.h"
#include "stream/stream_map.h"

enum { WIDTH = 24, HEIGHT = 20, PIXELS = WIDTH * HEIGHT, MOST = 400 };

typedef struct site {
    t3r_gaussian gaussians[MOST];
    t3r_map_record records[MOST];
    t3r_map map;
    uint8_t validity[PIXELS], label[PIXELS];
    uint16_t texture[PIXELS], key[PIXELS];
    t3r_view view;
    t3r_budget_settings settings;
} site;

static void fill(site *s, uint64_t *seed, uint32_t key_range)
{
    memset(s, 0, sizeof *s);
    s->map = (t3r_map){s->gaussians, s->records, (uint32_t)unit_between(seed, 0, MOST)};
    for (uint32_t i = 0; i < s->map.count; i++) {
        s->gaussians[i].position_q20[0] = (int32_t)i; /* identifies the Gaussian */
        s->gaussians[i].factor[0] = 1000;
        s->gaussians[i].factor_exponent = -20;
        s->records[i].key = (uint16_t)(T3R_MAP_KEY_LEAST + unit_between(seed, 0, key_range));
        s->records[i].faded_q10 = (uint16_t)(unit_between(seed, 0, 3) == 0 ? unit_between(seed, 0, 40000) : 0);
        s->records[i].wanted_q10 = (int16_t)unit_between(seed, 0, 8000);
    }
    static const uint8_t validities[] = {T3R_MEASURED, T3R_FILLED, T3R_MEASURED | T3R_MARK_COVERED,
                                         T3R_MEASURED | T3R_MARK_DOUBTFUL, T3R_NO_DEPTH};
    for (int i = 0; i < PIXELS; i++) {
        s->validity[i] = validities[unit_between(seed, 0, 4)];
        s->key[i] =
            (uint16_t)(T3R_MAP_KEY_LEAST + (unit_between(seed, 0, 9) == 0 ? 0 : unit_between(seed, 0, key_range)));
    }
    s->view = (t3r_view){.width = WIDTH,
                         .height = HEIGHT,
                         .validity = s->validity,
                         .texture = s->texture,
                         .key = s->key,
                         .label = s->label};
    s->settings = (t3r_budget_settings){.allocate = T3R_ALLOCATE_PIXEL, .clusters = 1, .pass_over_covered = true};
}

static uint32_t key_of(const t3r_map_record *r)
{
    return T3R_MIN((uint32_t)r->key + r->faded_q10, 65535u);
}

/* A competitor: ordered by key, then points, then Gaussians from the newest on. */
typedef struct rival {
    uint32_t key, rank;
    int gaussian; /* -1: a point */
} rival;

static int by_order(const void *a, const void *b)
{
    const rival *x = a, *y = b;
    return x->key != y->key ? (x->key > y->key) - (x->key < y->key) : (x->rank > y->rank) - (x->rank < y->rank);
}

/* Returns how many points are retained by the cut: as many Gaussians will be made of them. */
static uint32_t count_retained(site *s, const t3r_map_cut *cut)
{
    static uint32_t mask[(PIXELS + 31) / 32];
    t3r_cluster clusters[2];
    memset(clusters, 0, sizeof clusters);
    uint32_t count = 0;
    s->view.mask = mask;
    t3r_retain_below(&s->view, &s->settings, cut->threshold, cut->point_ties, clusters);
    for (size_t i = 0; i < PIXELS; i++) {
        count += t3r_retained(&s->view, i);
    }
    return count;
}

TEST(compete_as_sorted)
{
    static site s;
    static rival rivals[PIXELS + MOST];
    uint64_t seed = 1;
    for (int round = 0; round < 300; round++) {
        fill(&s, &seed, round % 3 == 0 ? 6 : 20000); /* few keys: many ties */
        uint32_t most = (uint32_t)unit_between(&seed, 1, MOST), count = 0;
        for (uint32_t i = 0; i < s.map.count; i++) {
            rivals[count++] = (rival){key_of(&s.records[i]), PIXELS + MOST - i, (int)i};
        }
        for (uint32_t i = 0; i < PIXELS; i++) {
            if (s.validity[i] == T3R_MEASURED || s.validity[i] == T3R_FILLED) {
                rivals[count++] = (rival){s.key[i], i, -1};
            }
        }
        qsort(rivals, count, sizeof *rivals, by_order);
        uint32_t stay = T3R_MIN(count, most), added = 0;
        bool stays[MOST] = {false};
        for (uint32_t i = 0; i < stay; i++) {
            added += rivals[i].gaussian < 0;
            if (rivals[i].gaussian >= 0) {
                stays[rivals[i].gaussian] = true;
            }
        }
        t3r_map_cut cut = t3r_map_compete(&s.map, &s.view, &s.settings, most);
        assert_int_equal(cut.added, added);
        assert_int_equal(count_retained(&s, &cut), added);
        assert_int_equal(cut.kept, stay - added);
        t3r_map_thin(&s.map, &cut);
        assert_int_equal(s.map.count, stay - added);
        uint32_t next = 0;
        for (uint32_t i = 0; i < MOST; i++) { /* in their order */
            if (stays[i]) {
                assert_int_equal(s.gaussians[next++].position_q20[0], i);
            }
        }
        assert_int_equal(next, s.map.count);
    }
}

static double size_of(const t3r_gaussian *g)
{
    return ldexp(g->factor[0], g->factor_exponent);
}

/* A quarter of the density gives twice the width; without thinning nothing changes; nothing narrows. */
TEST(widens_by_density)
{
    static site s;
    uint64_t seed = 5;
    for (int thinned_q10 = 0; thinned_q10 <= 12 << 10; thinned_q10 += 100) {
        fill(&s, &seed, 20000);
        s.map.count = 1;
        s.records[0] = (t3r_map_record){.key = 0, .wanted_q10 = 5000, .density_q10 = -1000};
        double before = size_of(&s.gaussians[0]);
        t3r_map_cut cut = {.threshold = (uint32_t)(T3R_KEY_ZERO - 5000 - 1000 - thinned_q10), .ties = 1};
        t3r_map_thin(&s.map, &cut);
        int now = T3R_MAX(-1000 - thinned_q10, T3R_LEAST_DENSITY_Q10);
        if (thinned_q10 < 64) {
            assert_true(size_of(&s.gaussians[0]) == before);
            assert_int_equal(s.records[0].density_q10, -1000);
        } else {
            double wanted = before * exp2(T3R_MIN(-1000 - now, 8192) / 2048.0);
            assert_true(fabs(size_of(&s.gaussians[0]) / wanted - 1) < 1e-3);
            assert_int_equal(s.records[0].density_q10, now);
        }
        double wide = size_of(&s.gaussians[0]);
        cut.threshold = UINT16_MAX;
        t3r_map_thin(&s.map, &cut);
        assert_true(s.map.count == 1 && size_of(&s.gaussians[0]) == wide);
    }
}

/* Where all stay nothing widens, however long a Gaussian was unseen: its neighbours are still there. */
TEST(nothing_widens_where_all_stay)
{
    static site s;
    uint64_t seed = 6;
    fill(&s, &seed, 20000);
    s.map.count = 1;
    s.records[0] = (t3r_map_record){.key = 40000, .faded_q10 = 60000, .wanted_q10 = 5000, .density_q10 = -1000};
    const double before = size_of(&s.gaussians[0]);
    t3r_map_thin(&s.map, &(t3r_map_cut){.threshold = UINT16_MAX, .ties = 1});
    assert_true(s.map.count == 1 && size_of(&s.gaussians[0]) == before);
    assert_int_equal(s.records[0].density_q10, -1000);
}

static uint32_t see(site *s, const t3r_pointmap *keyframe, uint32_t keyframes, uint32_t half_life)
{
    const t3r_workers alone = {NULL, 1};
    uint8_t looks[MOST];
    return t3r_map_see(&s->map, keyframe, keyframes, half_life, &alone, looks);
}

/* The density halves, an octave, in every `half_life` consecutive keyframes, evenly. */
TEST(fades_by_half_life)
{
    static site s;
    const uint32_t half_lives[] = {1, 3, 32, 341, 342, 600, 1000, 1024};
    for (size_t h = 0; h < sizeof half_lives / sizeof *half_lives; h++) {
        uint64_t seed = 11;
        fill(&s, &seed, 100);
        memset(s.validity, T3R_NO_DEPTH, sizeof s.validity); /* a keyframe that sees nothing */
        s.map.count = 1;
        s.records[0].faded_q10 = 0;
        s.view.fx_q16 = s.view.fy_q16 = 30 << 16;
        s.view.depth_unit_q40 = UINT64_C(1) << 30;
        const t3r_pointmap keyframe = t3r_pointmap_of(&s.view, 0);
        for (uint32_t n = 1; n <= 2 * half_lives[h]; n++) {
            assert_int_equal(see(&s, &keyframe, 7 * half_lives[h] + n - 1, half_lives[h]), 0);
            assert_int_equal(s.records[0].faded_q10, n * 1024 / half_lives[h]);
            assert_int_equal(s.records[0].idle, T3R_MIN(n, 255u));
        }
    }
}

/* The counts of a Gaussian that is never seen stay at their maximum. */
TEST(counts_are_held)
{
    static site s;
    uint64_t seed = 13;
    fill(&s, &seed, 100);
    memset(s.validity, T3R_NO_DEPTH, sizeof s.validity);
    s.map.count = 1;
    s.records[0].idle = UINT8_MAX - 1;
    s.records[0].faded_q10 = UINT16_MAX - 1;
    s.view.fx_q16 = s.view.fy_q16 = 30 << 16;
    s.view.depth_unit_q40 = UINT64_C(1) << 30;
    const t3r_pointmap keyframe = t3r_pointmap_of(&s.view, 0);
    for (int n = 0; n < 3; n++) {
        assert_int_equal(see(&s, &keyframe, 0, 1), 0);
        assert_int_equal(s.records[0].idle, UINT8_MAX);
        assert_int_equal(s.records[0].faded_q10, UINT16_MAX);
    }
}

/* Lets the keyframe look along z from the origin, so that pixel u shows x = (u - 10) / 15 at a depth of 2. */
static void look_ahead(t3r_view *view)
{
    view->fx_q16 = view->fy_q16 = 30 << 16;
    view->cx_q16 = view->cy_q16 = 10 << 16;
    view->depth_unit_q40 = UINT64_C(1) << 30;
    for (int i = 0; i < 3; i++) {
        view->pose.rotation_q30[4 * i] = 1 << 30;
    }
}

/* Gaussians on a pixel that is not measured, or up to 16 pixels beside the picture, keep their fading. Hidden ones and
 * those elsewhere fade. */
TEST(fades_where_its_surroundings_are_not_seen)
{
    static site s;
    uint64_t seed = 19;
    uint16_t depth[PIXELS];
    for (int i = 0; i < PIXELS; i++) {
        depth[i] = 1024; /* 1, so that all are hidden */
    }
    const struct {
        int32_t u, v, z;
        bool fades;
    } places[] = {{12, 10, 2, false},          {-15, 10, 2, false}, {WIDTH + 14, 10, 2, false}, {10, -15, 2, false},
                  {10, HEIGHT + 14, 2, false}, {-18, 10, 2, true},  {WIDTH + 17, 10, 2, true},  {10, -18, 2, true},
                  {10, HEIGHT + 17, 2, true},  {12, 10, -2, true}};
    for (int measured = 0; measured < 2; measured++) {
        fill(&s, &seed, 100);
        memset(s.validity, measured ? T3R_MEASURED : T3R_NO_DEPTH, sizeof s.validity);
        s.view.depth = depth;
        look_ahead(&s.view);
        s.map.count = sizeof places / sizeof *places;
        for (uint32_t i = 0; i < s.map.count; i++) {
            const int32_t z_q20 = places[i].z * (1 << 20);
            s.gaussians[i] = (t3r_gaussian){
                .position_q20 = {(places[i].u - 10) * (z_q20 / 30), (places[i].v - 10) * (z_q20 / 30), z_q20}};
            s.records[i].faded_q10 = 100;
        }
        const t3r_pointmap keyframe = t3r_pointmap_of(&s.view, 0);
        assert_int_equal(see(&s, &keyframe, 0, 4), 0);
        for (uint32_t i = 0; i < s.map.count; i++) {
            const bool hidden = measured && i == 0;
            assert_int_equal(s.records[i].faded_q10, places[i].fades || hidden ? 356 : 100);
            assert_int_equal(s.records[i].idle, 1);
        }
    }
}

/* A hidden Gaussian leaves after two half-lives, and never without one. */
TEST(hidden_ones_leave)
{
    static site s;
    uint64_t seed = 21;
    uint16_t depth[PIXELS];
    for (int i = 0; i < PIXELS; i++) {
        depth[i] = 1024;
    }
    const uint32_t half_lives[] = {0, 1, 32, 64};
    for (size_t h = 0; h < sizeof half_lives / sizeof *half_lives; h++) {
        fill(&s, &seed, 100);
        memset(s.validity, T3R_MEASURED, sizeof s.validity);
        s.view.depth = depth;
        look_ahead(&s.view);
        s.map.count = 1;
        s.gaussians[0] = (t3r_gaussian){.position_q20 = {0, 0, 2 << 20}};
        s.records[0].faded_q10 = 0;
        const t3r_pointmap keyframe = t3r_pointmap_of(&s.view, 0);
        uint32_t stayed = 0;
        while (stayed < 600 && see(&s, &keyframe, stayed, half_lives[h]) == 0) {
            stayed++;
        }
        assert_int_equal(stayed, half_lives[h] == 0 ? 600 : 2 * half_lives[h]);
    }
}

/* A keyframe without a depth there leaves a Gaussian in the map, but not one of an earlier piece. */
TEST(earlier_pieces_are_not_trusted)
{
    static site s;
    uint64_t seed = 15;
    fill(&s, &seed, 100);
    memset(s.validity, T3R_NO_DEPTH, sizeof s.validity);
    s.map.count = 2;
    for (int i = 0; i < 2; i++) {
        s.gaussians[i] = (t3r_gaussian){.position_q20 = {0, 0, 2 << 20}};
    }
    s.records[1].fitted = T3R_EARLIER_PIECE;
    look_ahead(&s.view);
    const t3r_pointmap keyframe = t3r_pointmap_of(&s.view, 0);
    assert_int_equal(see(&s, &keyframe, 0, 0), 1);
    assert_true(s.map.count == 1 && s.records[0].fitted != T3R_EARLIER_PIECE);
}

/* A head's Gaussians at the end of the range or beyond are dropped; the others keep their own pixel's record. */
TEST(what_is_out_of_range_is_left_out)
{
    static site s;
    uint64_t seed = 17;
    fill(&s, &seed, 100);
    uint32_t mask[(PIXELS + 31) / 32] = {0};
    uint16_t depth[PIXELS];
    t3r_cluster cluster = {.points = PIXELS};
    enum { MADE = 7 };
    for (int i = 0; i < PIXELS; i++) {
        depth[i] = 1500;
        s.validity[i] = T3R_MEASURED;
    }
    for (uint32_t i = 0; i < MADE; i++) {
        mask[0] |= 1u << (4 * i);
        s.key[4 * i] = (uint16_t)(40000 + i);
    }
    s.view.mask = mask;
    s.view.depth = depth;
    s.view.fx_q16 = s.view.fy_q16 = 30 << 16;
    s.view.depth_unit_q40 = UINT64_C(1) << 30;
    s.settings.gamma_q8 = 512;
    s.texture[24] = UINT16_MAX;
    s.map.count = 2;
    memset(s.gaussians, 0, sizeof s.gaussians);
    for (uint32_t i = 0; i < MADE; i++) { /* the first six beyond either end of an axis */
        const int32_t most = T3R_POSITION_MOST_Q20;
        s.gaussians[2 + i].position_q20[i % 3] = i == 6 ? most - 1 : i < 3 ? -most : most;
    }
    const t3r_pointmap keyframe = t3r_pointmap_of(&s.view, 0);
    assert_int_equal(t3r_map_append(&s.map, MADE, &keyframe, &s.settings, &cluster), 1);
    assert_int_equal(s.map.count, 3);
    assert_int_equal(s.gaussians[2].position_q20[0], T3R_POSITION_MOST_Q20 - 1);
    assert_int_equal(s.records[2].key, 40006);
    assert_int_equal(s.records[2].wanted_q10, INT16_MAX); /* 2 log2 of 65,543 is slightly larger */
}

TEST(moves_are_exact)
{
    static site s;
    uint64_t seed = 9;
    fill(&s, &seed, 100);
    s.map.count = 3;
    const int32_t at[3] = {1000 << 20, -(1000 << 20), 7};
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < 3; k++) {
            s.gaussians[i].position_q20[k] = at[i];
        }
    }
    t3r_map_move(&s.map, (int64_t[3]){0, 0, -((int64_t)500 << 20)});
    assert_int_equal(s.map.count, 2); /* the one at -1,000 would be at -1,500 */
    assert_int_equal(s.gaussians[0].position_q20[2], 500 << 20);
    assert_int_equal(s.gaussians[1].position_q20[2], 7 - (500 << 20));
    t3r_map_move(&s.map, (int64_t[3]){0, 0, (int64_t)500 << 20});
    assert_int_equal(s.gaussians[0].position_q20[2], 1000 << 20);
    assert_int_equal(s.gaussians[1].position_q20[2], 7);
    /* out of range along one axis or several: dropped in each case */
    s.gaussians[0].position_q20[1] = -(1000 << 20);
    t3r_map_move(&s.map, (int64_t[3]){(int64_t)100 << 20, -((int64_t)100 << 20), 0});
    assert_int_equal(s.map.count, 1);
    assert_int_equal(s.gaussians[0].position_q20[2], 7);
}
