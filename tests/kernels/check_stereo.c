/* SPDX-License-Identifier: Apache-2.0 */
/* Places of rays, census, its costs, the paths' rows, and the choice of disparities. */
#include "checks.h"
#include "core/fixed.h"
#include "guarded.h"

enum { MOST = 500 };

/* Makes a map of rays whose coordinates stay below 2^27 for all a and b below their own `most`. */
static t3r_ray_map any_map(uint64_t *seed, int64_t most_a, int64_t most_b)
{
    t3r_ray_map map = {.steepest = unit_random(seed) % 2 ? 16 : 4};
    for (int i = 0; i < 2; i++) {
        const int64_t most = (INT64_C(1) << unit_between(seed, 3, 30)) - 1;
        map.scale_q16[i] = (int32_t)any_value(seed, 0, most);
        map.offset_q16[i] = (int32_t)any_value(seed, -most, most);
    }
    for (int i = 0; i < 3; i++) {
        /* a third of 2^57 for each of the three products; usually z, or x and y, is much smaller */
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

const char *check_luma_at(const t3r_kernels *kernels, uint64_t *seed)
{
    const int32_t width = (int32_t)unit_between(seed, 2, 40), height = (int32_t)unit_between(seed, 2, 40);
    const uint32_t count = 1 + any_length(seed, T3R_RAYS - 1);
    uint8_t *luma = guarded_take((size_t)width * (size_t)height, 1), *out = guarded_take(count, 1);
    t3r_ray_places *places = guarded_take(sizeof *places, 4);
    for (int32_t i = 0; i < width * height; i++) {
        luma[i] = (uint8_t)(unit_random(seed) % 4 == 0 ? 0 : any_value(seed, 0, 255));
    }
    for (uint32_t i = 0; i < T3R_RAYS; i++) {
        const bool far = unit_random(seed) % 8 == 0;
        places->x_q16[i] =
            (int32_t)any_value(seed, far ? INT32_MIN : -2 * 65536, far ? INT32_MAX : (width + 2) * 65536);
        places->y_q16[i] =
            (int32_t)any_value(seed, far ? INT32_MIN : -2 * 65536, far ? INT32_MAX : (height + 2) * 65536);
        places->z_q24[i] = (int32_t)(unit_random(seed) % 8 == 0 ? 0 : any_value(seed, 1 << 18, 1 << 27));
    }
    const t3r_luma_picture picture = {luma, (uint32_t)width, (uint32_t)height};
    kernels->luma_at(&picture, places, count, out);
    for (uint32_t i = 0; i < count; i++) {
        const int64_t u = places->x_q16[i], v = places->y_q16[i], x = (u + 32768) >> 16, y = (v + 32768) >> 16;
        int64_t want = 0;
        if (places->z_q24[i] != 0 && x >= 0 && y >= 0 && x < width && y < height && luma[y * width + x] != 0) {
            const int64_t u8 = T3R_MIN(T3R_MAX((u + 128) >> 8, 0), (width - 1) * 256);
            const int64_t v8 = T3R_MIN(T3R_MAX((v + 128) >> 8, 0), (height - 1) * 256);
            int64_t sum = 32768;
            for (int k = 0; k < 4; k++) {
                const int64_t column = T3R_MIN((u8 >> 8) + k % 2, width - 1);
                const int64_t row = T3R_MIN((v8 >> 8) + k / 2, height - 1);
                const int64_t weight_x = k % 2 == 0 ? 256 - u8 % 256 : u8 % 256;
                sum += luma[row * width + column] * weight_x * (k / 2 == 0 ? 256 - v8 % 256 : v8 % 256);
            }
            want = T3R_MAX(sum >> 16, 1);
        }
        if (out[i] != want) {
            return "a luma differs";
        }
    }
    return NULL;
}

/* Makes disparities around some values, and some invalid ones. */
static t3r_disparity_plane any_plane(uint64_t *seed)
{
    const uint32_t width = (uint32_t)unit_between(seed, 2, 40), height = (uint32_t)unit_between(seed, 2, 40);
    uint16_t *disparity = guarded_take((size_t)2 * width * height, 2);
    uint8_t *confidence = guarded_take((size_t)width * height, 1);
    const int64_t base = any_value(seed, 0, (1 << 15) - 1);
    const int spread = 1 << unit_between(seed, 0, 10), sparse = unit_random(seed) % 2 ? 64 : 3;
    for (uint32_t i = 0; i < width * height; i++) {
        const int64_t k = base + unit_between(seed, -spread, spread);
        const bool none = unit_random(seed) % 32 == 0;
        disparity[i] = (uint16_t)(none ? T3R_NO_DISPARITY : T3R_MIN(T3R_MAX(k, 0), (1 << 15) - 1));
        confidence[i] = (uint8_t)(unit_random(seed) % (uint32_t)sparse == 0 ? 0 : any_value(seed, 1, 255));
    }
    return (t3r_disparity_plane){.disparity = disparity,
                                 .confidence = confidence,
                                 .width = width,
                                 .height = height,
                                 .begin_q16 = (int32_t)any_value(seed, -(1 << 29), 1 << 29),
                                 .first = (int32_t)any_value(seed, -(1 << 13), 1 << 13),
                                 .right = unit_random(seed) % 2 != 0,
                                 .filled = unit_random(seed) % 2 != 0,
                                 .scale = t3r_divisor_of((uint32_t)any_value(seed, 1 << 16, 1 << 29))};
}

/* Returns the disparity at `at`: the nearest pixel's, or interpolated between four. */
static int64_t disparity_of(const t3r_disparity_plane *plane, int64_t x_q8, int64_t y_q8, int64_t nearest)
{
    const int64_t own = plane->disparity[nearest], left = x_q8 >> 8, top = y_q8 >> 8;
    int64_t sum = 32768;
    if (left < 0 || top < 0 || left + 1 >= plane->width || top + 1 >= plane->height) {
        return own;
    }
    for (int k = 0; k < 4; k++) {
        const int64_t at = (top + k / 2) * plane->width + left + k % 2, x = x_q8 & 255, y = y_q8 & 255;
        if ((plane->confidence[at] != 0) != (plane->confidence[nearest] != 0) ||
            t3r_abs64(plane->disparity[at] - own) > 128) {
            return own;
        }
        sum += plane->disparity[at] * (k % 2 == 0 ? 256 - x : x) * (k / 2 == 0 ? 256 - y : y);
    }
    return sum >> 16;
}

static int64_t column_of(const t3r_disparity_plane *plane, int64_t x_q16)
{
    const int64_t most = 4 << 24;
    return T3R_MIN(T3R_MAX(t3r_round_div64(x_q16 * (1 << 24), plane->scale.d), -most), most);
}

const char *check_disparity_at(const t3r_kernels *kernels, uint64_t *seed)
{
    const t3r_disparity_plane plane = any_plane(seed);
    const uint32_t count = 1 + any_length(seed, T3R_RAYS - 1);
    t3r_ray_places *places = guarded_take(sizeof *places, 4);
    t3r_disparities *out = guarded_take(sizeof *out, 4);
    for (uint32_t i = 0; i < T3R_RAYS; i++) {
        const bool far = unit_random(seed) % 8 == 0;
        const int64_t end = plane.begin_q16 + (int64_t)(plane.width + 2) * 65536;
        places->x_q16[i] =
            (int32_t)any_value(seed, far ? INT32_MIN : plane.begin_q16 - 2 * 65536, far ? INT32_MAX : end);
        places->y_q16[i] = (int32_t)any_value(seed, far ? INT32_MIN : -2 * 65536,
                                              far ? INT32_MAX : (plane.height + 2) * INT64_C(65536));
        places->z_q24[i] = (int32_t)(unit_random(seed) % 8 == 0 ? 0 : any_value(seed, 1 << 18, 1 << 27));
    }
    kernels->disparity_at(&plane, places, count, out);
    for (uint32_t i = 0; i < count; i++) {
        const int64_t x = (places->x_q16[i] - (int64_t)plane.begin_q16 + 128) >> 8;
        const int64_t y = ((int64_t)places->y_q16[i] + 128) >> 8, column = (x + 128) >> 8, row = (y + 128) >> 8;
        const bool inside = column >= 0 && row >= 0 && column < plane.width && row < plane.height;
        const int64_t nearest = inside ? row * plane.width + column : 0;
        const int32_t confidence = plane.confidence[nearest];
        int64_t want[4] = {0};
        if (places->z_q24[i] != 0 && inside && plane.disparity[nearest] != T3R_NO_DISPARITY &&
            (confidence != 0 || plane.filled)) {
            want[0] = confidence == 0 ? 1 : T3R_MAX(confidence, 2);
            want[1] = plane.first * 65536 + disparity_of(&plane, x, y, nearest) * 512;
            want[2] = column_of(&plane, places->x_q16[i]);
            want[3] = column_of(&plane, places->x_q16[i] + (plane.right ? want[1] : -want[1]));
        }
        if (out->confidence[i] != want[0] || out->disparity_q16[i] != want[1]) {
            return "a disparity differs";
        }
        if (out->own_q24[i] != want[2] || out->other_q24[i] != want[3]) {
            return "a column differs";
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

const char *check_census_costs(const t3r_kernels *kernels, uint64_t *seed)
{
    const uint32_t width = 1 + any_length(seed, 60), count = 16 * (uint32_t)unit_between(seed, 1, 16);
    const uint32_t right = (uint32_t)T3R_MATCH_RIGHT(width, count);
    uint8_t *luma = guarded_take(width, 1), *luma_right = guarded_take(right, 1);
    uint8_t *bits = guarded_take((size_t)3 * width, 1), *bits_right = guarded_take((size_t)3 * right, 1);
    uint8_t *cost = guarded_take((size_t)width * count, 1);
    const t3r_census_costs row = {
        width, count, luma, luma_right, bits, bits_right, guarded_take((size_t)3 * right, 1), guarded_take(right, 1),
        cost};
    for (uint32_t x = 0; x < 3 * width; x++) {
        luma[x % width] = (uint8_t)any_value(seed, 0, 255);
        bits[x] = (uint8_t)any_value(seed, 0, 255);
    }
    for (uint32_t j = 0; j < 3 * right; j++) {
        luma_right[j % right] = (uint8_t)any_value(seed, 0, 255);
        bits_right[j] = (uint8_t)any_value(seed, 0, 255);
    }
    kernels->census_costs(&row);
    for (uint32_t x = 0; x < width; x++) {
        for (uint32_t k = 0; k < count; k++) {
            const uint32_t j = x + count - 1 - k;
            int want = 0;
            for (uint32_t i = 0; i < 3; i++) {
                want += __builtin_popcount((unsigned)(bits[i * width + x] ^ bits_right[i * right + j]));
            }
            want = luma_right[j] == 0 && want < T3R_CENSUS_NOTHING ? T3R_CENSUS_NOTHING : want;
            if (cost[x * count + k] != (luma[x] == 0 ? 0 : want)) {
                return "a cost differs";
            }
        }
    }
    return NULL;
}

/* Returns one path's value at a pixel, by the formula. */
static int path_value(const uint8_t *from, int least, uint32_t k, int cost, int p1, int p2)
{
    const int same = from[k + 1] - least, below = from[k] + p1 - least, above = from[k + 2] + p1 - least;
    int best = same < below ? same : below;
    best = best < above ? best : above;
    return cost + (best < p2 ? best : p2);
}

const char *check_path_row(const t3r_kernels *kernels, uint64_t *seed)
{
    const uint32_t width = 1 + any_length(seed, 40), count = 16 * (uint32_t)unit_between(seed, 1, 16);
    const uint32_t paths = unit_random(seed) % 2 ? 3 : 1;
    const uint32_t p1 = (uint32_t)any_value(seed, 0, 60), p2_most = (uint32_t)any_value(seed, p1, 231 - p1);
    const size_t pitch = count + 1, state = T3R_PATH_STATE_BYTES(width, count), leasts = t3r_path_leasts(width, count);
    t3r_path_costs costs = {.p1 = (uint8_t)p1, .guard = (uint8_t)(p2_most + 24)};
    for (int i = 0; i < T3R_PATH_PENALTIES; i++) {
        costs.p2[i] = (uint8_t)any_value(seed, p1, p2_most);
    }
    uint8_t *luma = guarded_take(width, 1), *before = guarded_take(width, 1);
    uint8_t *cost = guarded_take((size_t)width * count, 1);
    uint8_t *from = guarded_take(paths * state, 1), *to = guarded_take(paths * state, 1);
    int16_t *sums = guarded_take((size_t)width * count * 2, 2), want_sums[41 * 256];
    for (uint32_t i = 0; i < width * count; i++) {
        luma[i % width] = (uint8_t)any_value(seed, 0, 255);
        before[i % width] = (uint8_t)any_value(seed, 0, 255);
        cost[i] = (uint8_t)any_value(seed, 0, 24);
        want_sums[i] = sums[i] = (int16_t)any_value(seed, 0, 2000);
    }
    for (uint32_t path = 0; path < paths; path++) {
        uint8_t *own = from + path * state;
        for (uint32_t slot = 0; slot < width + 2; slot++) {
            uint8_t *values = own + slot * pitch + 1, least = 255;
            const uint32_t floor_cost = (uint32_t)any_value(seed, 0, 24);
            for (uint32_t k = 0; k < count; k++) {
                values[k] = (uint8_t)any_value(seed, floor_cost, p2_most + 24);
                least = values[k] < least ? values[k] : least;
            }
            if (least > 24) { /* the least of a pixel is at most a cost */
                values[unit_random(seed) % count] = least = 24;
            }
            own[slot * pitch] = own[(slot + 1) * pitch] = costs.guard;
            own[leasts + slot] = least;
        }
    }
    for (size_t i = 0; i < paths * state; i++) {
        to[i] = 77;
    }
    const t3r_path_row row = {.width = width,
                              .disparities = count,
                              .diagonals = paths == 3,
                              .reverse = unit_random(seed) % 2,
                              .costs = &costs,
                              .luma = luma,
                              .luma_before = before,
                              .cost = cost,
                              .from = from,
                              .to = to,
                              .sums = unit_random(seed) % 4 == 0 ? NULL : sums};
    kernels->path_row(&row);
    uint8_t beside[2][258];
    memset(beside, 0, sizeof beside);
    for (int i = 0; i < 2; i++) {
        beside[i][0] = beside[i][count + 1] = costs.guard;
    }
    int beside_least = 0;
    for (uint32_t i = 0; i < width; i++) {
        const uint32_t x = row.reverse ? width - 1 - i : i;
        const uint32_t columns[3] = {x, x == 0 ? 0 : x - 1, x + 1 == width ? x : x + 1};
        const uint32_t slots[3] = {x + 1, x, x + 2};
        const int last = i == 0 ? luma[x] : luma[row.reverse ? x + 1 : x - 1];
        int least[4] = {255, 255, 255, 255};
        for (uint32_t k = 0; k < count; k++) {
            int sum = row.reverse ? want_sums[x * count + k] : 0;
            for (uint32_t path = 0; path < paths; path++) {
                const uint8_t *own = from + path * state;
                const int value =
                    path_value(own + slots[path] * pitch, own[leasts + slots[path]], k, cost[x * count + k], (int)p1,
                               costs.p2[abs(luma[x] - before[columns[path]])]);
                if (to[path * state + (x + 1) * pitch + 1 + k] != value) {
                    return "a value differs";
                }
                least[path] = value < least[path] ? value : least[path];
                sum += value;
            }
            const int value =
                path_value(beside[i & 1], beside_least, k, cost[x * count + k], (int)p1, costs.p2[abs(luma[x] - last)]);
            beside[~i & 1][k + 1] = (uint8_t)value;
            least[3] = value < least[3] ? value : least[3];
            want_sums[x * count + k] = (int16_t)(row.sums == NULL ? want_sums[x * count + k] : sum + value);
        }
        beside_least = least[3];
        for (uint32_t path = 0; path < paths; path++) {
            if (to[path * state + leasts + x + 1] != least[path]) {
                return "a least value differs";
            }
        }
    }
    if (!SAME(sums, want_sums, (size_t)width * count)) {
        return "a sum differs";
    }
    for (uint32_t path = 0; path < paths; path++) {
        const uint8_t *own = to + path * state;
        for (uint32_t k = 0; k < pitch; k++) {
            if (own[k] != 77 || own[(width + 1) * pitch + k] != 77) {
                return "an end was written";
            }
        }
        for (uint32_t slot = 0; slot < width + 2; slot++) {
            if (own[slot * pitch] != 77) {
                return "a guard was written";
            }
        }
    }
    return NULL;
}

const char *check_winner_row(const t3r_kernels *kernels, uint64_t *seed)
{
    const uint32_t width = 1 + any_length(seed, 60), count = 16 * (uint32_t)unit_between(seed, 1, 16);
    const uint32_t right = (uint32_t)T3R_MATCH_RIGHT(width, count);
    const int64_t most = unit_random(seed) % 2 ? 3 : 2000; /* many equal values, or few */
    uint8_t *luma = guarded_take(width, 1);
    int16_t *sums = guarded_take((size_t)width * count * 2, 2);
    const t3r_winner_row row = {width,
                                count,
                                luma,
                                sums,
                                guarded_take(width * 2, 2),
                                guarded_take(width * 2, 2),
                                guarded_take(right * 2, 2),
                                guarded_take(right * 2, 2)};
    int16_t best[61 + 256], at[61 + 256];
    for (uint32_t n = 0; n < right; n++) {
        best[n] = INT16_MAX;
        at[n] = 0;
    }
    for (uint32_t i = 0; i < width * count; i++) {
        luma[i % width] = (uint8_t)any_value(seed, 0, 3);
        sums[i] = (int16_t)any_value(seed, 0, most);
    }
    kernels->winner_row(&row);
    for (uint32_t x = 0; x < width; x++) {
        const int16_t *s = sums + x * count;
        uint32_t first = 0;
        int second = luma[x] == 0 ? 0 : INT16_MAX;
        for (uint32_t k = 0; k < count && luma[x] != 0; k++) {
            const uint32_t n = width - 1 - x + k;
            first = s[k] < s[first] ? k : first;
            if (s[k] < best[n] || (s[k] == best[n] && (int16_t)k < at[n])) {
                best[n] = s[k];
                at[n] = (int16_t)k;
            }
        }
        for (uint32_t k = 0; k < count && luma[x] != 0; k++) {
            second = (k + 1 < first || k > first + 1) && s[k] < second ? s[k] : second;
        }
        if (row.first[x] != first || row.second[x] != second) {
            return "a left winner differs";
        }
    }
    if (!SAME(row.best, best, right) || !SAME(row.at, at, right)) {
        return "a right winner differs";
    }
    return NULL;
}
