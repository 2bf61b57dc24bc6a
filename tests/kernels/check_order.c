/* SPDX-License-Identifier: Apache-2.0 */
/* The sample of k-means++, the nearest centre, and the radix sort. */
#include "checks.h"
#include "guarded.h"

enum { POINTS = 70, KEYS = 600 };

/* The points first..end - 1 of a sample, and the effect of an added centre. The other points are arbitrary. */
typedef struct sample_case {
    t3r_sample sample;
    uint32_t first, end, room;
    int16_t *centre;
    int32_t want[T3R_CLUSTER_SAMPLE]; /* the distances after adding the centre */
    uint64_t sum;
} sample_case;

static void *anything(uint32_t count, size_t bytes)
{
    return memset(guarded_take(count * bytes, bytes), 0x7f, count * bytes);
}

static void make_sample(sample_case *c, uint64_t *seed, bool from_the_first)
{
    const uint32_t count = any_length(seed, T3R_CLUSTER_SAMPLE);
    c->first = from_the_first ? 0 : (uint32_t)any_value(seed, 0, T3R_CLUSTER_SAMPLE - count);
    c->end = c->first + count;
    const uint32_t room = (uint32_t)any_value(seed, c->end, T3R_CLUSTER_SAMPLE);
    for (uint32_t d = 0; d < T3R_DIMENSIONS; d++) {
        c->sample.feature_q11[d] = anything(room, sizeof(int16_t));
    }
    c->sample.distance_q20 = anything(room, sizeof(int32_t));
    c->room = room;
    c->centre = guarded_take(T3R_DIMENSIONS * sizeof *c->centre, 2);
    for (uint32_t d = 0; d < T3R_DIMENSIONS; d++) {
        c->centre[d] = (int16_t)any_value(seed, -T3R_FEATURE_MOST, T3R_FEATURE_MOST);
    }
    memcpy(c->want, c->sample.distance_q20, room * sizeof *c->want);
    c->sum = 0;
    for (uint32_t i = c->first; i < c->end; i++) {
        int64_t distance = 0;
        for (uint32_t d = 0; d < T3R_DIMENSIONS; d++) {
            const int64_t p = any_value(seed, -T3R_FEATURE_MOST, T3R_FEATURE_MOST);
            c->sample.feature_q11[d][i] = (int16_t)p;
            distance += (p - c->centre[d]) * (p - c->centre[d]) / 4;
        }
        const int64_t before = any_value(seed, 0, INT32_MAX);
        c->sample.distance_q20[i] = (int32_t)before;
        c->want[i] = (int32_t)(distance < before ? distance : before);
        c->sum += (uint64_t)c->want[i];
    }
}

const char *check_sample_potential(const t3r_kernels *kernels, uint64_t *seed)
{
    static sample_case c;
    make_sample(&c, seed, true);
    return kernels->sample_potential(&c.sample, c.end, c.centre) == c.sum ? NULL : "the sum differs";
}

const char *check_sample_approach(const t3r_kernels *kernels, uint64_t *seed)
{
    static sample_case c;
    make_sample(&c, seed, false);
    if (kernels->sample_approach(&c.sample, c.first, c.end, c.centre) != c.sum) {
        return "the sum differs";
    }
    return SAME(c.sample.distance_q20, c.want, c.room) ? NULL : "a distance differs";
}

const char *check_nearest(const t3r_kernels *kernels, uint64_t *seed)
{
    const uint32_t count = (uint32_t)unit_between(seed, 1, unit_random(seed) % 4 ? 40 : T3R_MAX_CLUSTERS);
    const uint32_t room = (count + T3R_CENTRE_GROUP - 1) / T3R_CENTRE_GROUP * T3R_CENTRE_GROUP;
    t3r_centres centres = {.half_norm = anything(count, sizeof(int32_t)), .count = count};
    for (uint32_t d = 0; d < T3R_DIMENSIONS; d++) {
        centres.feature_q11[d] = anything(count, sizeof(int16_t));
    }
    const t3r_neighbours neighbours = {guarded_take(room * sizeof *neighbours.index, 4)};
    const uint32_t points = (uint32_t)unit_between(seed, 0, POINTS);
    const int64_t most = unit_random(seed) % 3 == 0 ? 2 : T3R_FEATURE_MOST; /* close together: many are equally far */
    int16_t(*feature)[T3R_DIMENSIONS] = guarded_take(points * sizeof *feature, 2);
    uint16_t *nearest = guarded_take(points * sizeof *nearest, 2);
    for (uint32_t k = 0; k < count; k++) {
        int64_t norm = 0;
        for (uint32_t d = 0; d < T3R_DIMENSIONS; d++) {
            int64_t c = any_value(seed, -most, most);
            centres.feature_q11[d][k] = (int16_t)c;
            norm += c * c;
        }
        centres.half_norm[k] = (int32_t)(norm / 2);
    }
    for (uint32_t i = 0; i < points; i++) {
        for (uint32_t d = 0; d < T3R_DIMENSIONS; d++) {
            feature[i][d] = (int16_t)any_value(seed, -most, most);
        }
    }
    const uint32_t half = count / 2 / T3R_CENTRE_GROUP * T3R_CENTRE_GROUP; /* split as between two workers */
    kernels->nearest_begin(&centres, half, count, &neighbours);
    kernels->nearest_begin(&centres, 0, half, &neighbours);
    kernels->nearest(&centres, &neighbours, points, (const int16_t(*)[T3R_DIMENSIONS])feature,
                     (uint16_t)unit_between(seed, 0, count - 1), nearest);
    for (uint32_t i = 0; i < points; i++) {
        int64_t least = INT64_MAX;
        uint32_t first = 0;
        for (uint32_t k = 0; k < count; k++) {
            int64_t score = centres.half_norm[k];
            for (uint32_t d = 0; d < T3R_DIMENSIONS; d++) {
                score -= (int64_t)feature[i][d] * centres.feature_q11[d][k];
            }
            if (score < least) {
                least = score;
                first = k;
            }
        }
        if (nearest[i] != first) {
            return "a label differs";
        }
    }
    return NULL;
}

static uint32_t *random_keys(uint64_t *seed, uint32_t count)
{
    uint32_t *keys = guarded_take(count * sizeof *keys, 4);
    const uint32_t few = unit_random(seed) % 2 ? UINT32_MAX : 0x01030107u;
    for (uint32_t i = 0; i < count; i++) {
        keys[i] = (uint32_t)unit_random(seed) & few;
    }
    return keys;
}

const char *check_radix_count(const t3r_kernels *kernels, uint64_t *seed)
{
    const uint32_t count = any_length(seed, KEYS);
    const uint32_t *keys = random_keys(seed, count);
    uint32_t *histogram = guarded_take(T3R_RADIX_DIGITS * T3R_RADIX * sizeof *histogram, 4);
    static uint32_t want[T3R_RADIX_DIGITS * T3R_RADIX];
    for (uint32_t i = 0; i < T3R_RADIX_DIGITS * T3R_RADIX; i++) {
        want[i] = histogram[i] = (uint32_t)unit_between(seed, 0, 9);
    }
    for (uint32_t i = 0; i < count; i++) {
        for (uint32_t digit = 0; digit < T3R_RADIX_DIGITS; digit++) {
            want[digit * T3R_RADIX + (keys[i] >> (8 * digit)) % 256]++;
        }
    }
    kernels->radix_count(keys, count, histogram);
    return SAME(histogram, want, T3R_RADIX_DIGITS * T3R_RADIX) ? NULL : "a count differs";
}

const char *check_radix_pass(const t3r_kernels *kernels, uint64_t *seed)
{
    const uint32_t count = any_length(seed, KEYS), digit = unit_random(seed) % T3R_RADIX_DIGITS;
    const uint32_t *keys = random_keys(seed, count), *indices = random_keys(seed, count);
    uint32_t *start = guarded_take(T3R_RADIX * sizeof *start, 4);
    uint32_t *to_keys = guarded_take(count * 4, 4), *to_indices = guarded_take(count * 4, 4);
    uint32_t made = 0;
    for (uint32_t value = 0, sum = 0; value < T3R_RADIX; value++) {
        start[value] = sum;
        for (uint32_t i = 0; i < count; i++) {
            sum += (keys[i] >> (8 * digit)) % 256 == value;
        }
    }
    kernels->radix_pass(keys, indices, count, digit, start, to_keys, to_indices);
    for (uint32_t value = 0; value < T3R_RADIX; value++) {
        for (uint32_t i = 0; i < count; i++) {
            if ((keys[i] >> (8 * digit)) % 256 == value) {
                if (to_keys[made] != keys[i] || to_indices[made] != indices[i]) {
                    return "a pair is at another place";
                }
                made++;
            }
        }
        if (start[value] != made) {
            return "a start does not end behind its last pair";
        }
    }
    return NULL;
}
