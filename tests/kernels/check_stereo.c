/* Places of rays, census, its costs, and the paths' step. */
#include "checks.h"
#include "core/fixed.h"
#include "guarded.h"

enum { MOST = 500 };

/* A map of rays whose coordinates stay below 2^27, whatever a and b below their own `most` are. */
static t3r_ray_map any_map(uint64_t *seed, int64_t most_a, int64_t most_b)
{
    t3r_ray_map map = {.steepest = unit_random(seed) % 2 ? 16 : 4};
    for (int i = 0; i < 2; i++) {
        const int64_t most = (INT64_C(1) << unit_between(seed, 3, 30)) - 1;
        map.scale_q16[i] = (int32_t)any_value(seed, 0, most);
        map.offset_q16[i] = (int32_t)any_value(seed, -most, most);
    }
    for (int i = 0; i < 3; i++) {
        /* a third of 2^57 for each of the three products; z as a rule much smaller, or x and y */
        const int64_t share = (INT64_C(1) << 57) / 3 >> unit_between(seed, 0, 12);
        const int64_t turn = T3R_MIN(share / most_a, 1 << 30), slope = T3R_MIN(share / most_b, 1 << 30);
        map.turn_q30[i] = (int32_t)any_value(seed, -turn, turn);
        map.slope_q30[i] = (int32_t)any_value(seed, -slope, slope);
        map.base_q54[i] = any_value(seed, i == 2 ? share / 2 : -share, share);
    }
    return map;
}

const char *check_ray_row(const t3r_kernels *kernels, uint64_t *seed)
{
    const uint32_t count = 16 * (uint32_t)unit_between(seed, 1, T3R_RAYS / 16);
    const int64_t most_a = INT64_C(1) << unit_between(seed, 1, 28), most_b = INT64_C(1) << unit_between(seed, 0, 24);
    const t3r_ray_map map = any_map(seed, most_a, most_b);
    int32_t *a = guarded_take(count * 4, 4), *b = guarded_take(count * 4, 4);
    t3r_ray_places *places = guarded_take(sizeof *places, 4);
    for (uint32_t i = 0; i < count; i++) {
        a[i] = (int32_t)any_value(seed, -most_a, most_a);
        b[i] = (int32_t)any_value(seed, -most_b, most_b);
    }
    kernels->ray_row(&map, a, b, count, places);
    for (uint32_t i = 0; i < count; i++) {
        int64_t ray[3], want[2] = {0, 0};
        for (int k = 0; k < 3; k++) {
            const int64_t sum = (int64_t)a[i] * map.turn_q30[k] + (int64_t)b[i] * map.slope_q30[k] + map.base_q54[k];
            ray[k] = t3r_round_shift64(sum, 30);
        }
        const int64_t z = ray[2], most = map.steepest * z;
        const bool any = z >= 1 << 18 && t3r_abs64(ray[0]) <= most && t3r_abs64(ray[1]) <= most;
        for (int k = 0; k < 2 && any; k++) {
            const int64_t at = t3r_round_div64(ray[k] * (1 << 24), z);
            want[k] =
                t3r_clamp64(t3r_round_shift64(at * map.scale_q16[k], 24) + map.offset_q16[k], INT32_MIN, INT32_MAX);
        }
        if (places->z_q24[i] != (any ? z : 0)) {
            return "a ray differs";
        }
        if (places->x_q16[i] != want[0] || places->y_q16[i] != want[1]) {
            return "a place differs";
        }
    }
    return NULL;
}

const char *check_census_row(const t3r_kernels *kernels, uint64_t *seed)
{
    static const int extra[7][2] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {2, 0}, {-2, 0}, {0, 2}};
    const uint32_t width = 2 + any_length(seed, MOST), pitch = width + (uint32_t)unit_between(seed, 0, 3);
    const uint8_t *rows[T3R_CENSUS_ROWS];
    for (int i = 0; i < T3R_CENSUS_ROWS; i++) {
        uint8_t *row = guarded_take(width, 1);
        for (uint32_t x = 0; x < width; x++) {
            row[x] = (uint8_t)unit_between(seed, 100, 103);
        }
        rows[i] = row;
    }
    uint8_t *bits = guarded_take((size_t)2 * pitch + width, 1);
    kernels->census_row(rows, width, pitch, bits);
    for (int64_t x = 0; x < width; x++) {
        uint32_t want = 0;
        for (int i = 0; i < T3R_CENSUS_PAIRS; i++) {
            /* pairs (1, 0), (2, 0), (3, 0), then rows 1 and 2 from left to right; then the seven against the pixel */
            const int ax = i < 3 ? i + 1 : i < 17 ? (i - 3) % 7 - 3 : extra[i - 17][0];
            const int ay = i < 3 ? 0 : i < 17 ? (i - 3) / 7 + 1 : extra[i - 17][1];
            const int64_t a = x + ax, b = i < 17 ? x - ax : x;
            const uint8_t p = rows[2 + ay][a < 0 ? 0 : a >= width ? width - 1 : a];
            const uint8_t q = rows[i < 17 ? 2 - ay : 2][b < 0 ? 0 : b >= width ? width - 1 : b];
            want = want << 1 | (p > q);
        }
        if (bits[x] != want >> 16 || bits[pitch + x] != (want >> 8 & 255) || bits[2 * pitch + x] != (want & 255)) {
            return "a bit differs";
        }
    }
    return NULL;
}

const char *check_census_cost(const t3r_kernels *kernels, uint64_t *seed)
{
    const uint32_t count = 16 * (uint32_t)unit_between(seed, 1, 16), pitch = count + (uint32_t)unit_between(seed, 0, 5);
    uint8_t *own = guarded_take(3, 1), *others = guarded_take((size_t)2 * pitch + count, 1);
    uint8_t *least = guarded_take(count, 1), *cost = guarded_take(count, 1);
    for (int i = 0; i < 3; i++) {
        own[i] = (uint8_t)any_value(seed, 0, 255);
    }
    for (uint32_t i = 0; i < 2 * pitch + count; i++) {
        others[i] = (uint8_t)any_value(seed, 0, 255);
    }
    for (uint32_t k = 0; k < count; k++) {
        least[k] = (uint8_t)any_value(seed, 0, 24);
    }
    kernels->census_cost(own, others, pitch, least, count, cost);
    for (uint32_t k = 0; k < count; k++) {
        int bits = 0;
        for (uint32_t i = 0; i < 3; i++) {
            bits += __builtin_popcount((unsigned)(own[i] ^ others[i * pitch + k]));
        }
        if (cost[k] != (bits > least[k] ? bits : least[k])) {
            return "a cost differs";
        }
    }
    return NULL;
}

const char *check_path_step(const t3r_kernels *kernels, uint64_t *seed)
{
    const uint32_t count = 16 * (uint32_t)unit_between(seed, 1, 16), paths = (uint32_t)unit_between(seed, 1, 4);
    const uint32_t p1 = (uint32_t)any_value(seed, 0, 60), p2_most = (uint32_t)any_value(seed, p1, 231 - p1);
    const bool sum = paths % 2 == 0 && unit_random(seed) % 4 != 0, add = unit_random(seed) % 2;
    uint8_t *cost = guarded_take(count, 1);
    int16_t *sums = guarded_take(count * 2, 2);
    int want_sums[256];
    t3r_path_link links[T3R_PATH_LINKS];
    for (uint32_t k = 0; k < count; k++) {
        cost[k] = (uint8_t)any_value(seed, 0, 24);
        sums[k] = (int16_t)any_value(seed, 0, 2000);
        want_sums[k] = add ? sums[k] : 0;
    }
    for (uint32_t path = 0; path < paths; path++) {
        uint8_t *from = guarded_take(count + 2, 1), least = 255;
        from[0] = from[count + 1] = (uint8_t)(p2_most + 24);
        const uint32_t floor_cost = (uint32_t)any_value(seed, 0, 24);
        for (uint32_t k = 1; k <= count; k++) {
            from[k] = (uint8_t)any_value(seed, floor_cost, p2_most + 24 < floor_cost ? floor_cost : p2_most + 24);
            least = from[k] < least ? from[k] : least;
        }
        if (least > 24) { /* the least of a pixel is at most a cost */
            from[1 + unit_random(seed) % count] = least = 24;
        }
        links[path] = (t3r_path_link){.from = from,
                                      .to = guarded_take(count, 1),
                                      .from_least = least,
                                      .p2 = (uint8_t)any_value(seed, p1, p2_most)};
    }
    kernels->path_step(cost, links, paths, (uint8_t)p1, count, add, sum ? sums : NULL);
    for (uint32_t path = 0; path < paths; path++) {
        const t3r_path_link *l = &links[path];
        int least = 255;
        for (uint32_t k = 0; k < count; k++) {
            const int same = l->from[k + 1] - l->from_least, below = l->from[k] + (int)p1 - l->from_least;
            const int above = l->from[k + 2] + (int)p1 - l->from_least;
            int best = same < below ? same : below;
            best = best < above ? best : above;
            best = cost[k] + (best < l->p2 ? best : l->p2);
            if (l->to[k] != best) {
                return "a value differs";
            }
            least = best < least ? best : least;
            want_sums[k] += best;
        }
        if (l->least != least) {
            return "a least value differs";
        }
    }
    for (uint32_t k = 0; k < count && sum; k++) {
        if (sums[k] != want_sums[k]) {
            return "a sum differs";
        }
    }
    return NULL;
}
