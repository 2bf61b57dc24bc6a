/* SPDX-License-Identifier: Apache-2.0 */
#include "seeding.h"

#include "core/fixed.h"
#include "core/memory.h"

#define PART 256u /* sample points per part; a draw skips whole parts by their summed distances */
#define PARTS (T3R_CLUSTER_SAMPLE / PART)
#define CENTRES_A_STEP                                                                                                 \
    8u /* centres between two steps of the host: about 7 million instructions of plain C with the                      \
        * whole sample */

/* Draws at most `most` valid points, spread evenly over the source. Returns their number. */
static uint32_t draw_sample(const t3r_point_source *source, uint32_t most, const t3r_sample *sample)
{
    uint32_t strata = T3R_MIN(source->points, most), count = 0;
    for (uint32_t s = 0; s < strata; s++) {
        uint32_t first = (uint32_t)((uint64_t)s * source->points / strata);
        uint32_t end = (uint32_t)((uint64_t)(s + 1) * source->points / strata);
        uint32_t jitter = t3r_mix32(s) % (end - first);
        int16_t feature[1][T3R_DIMENSIONS];
        uint8_t which;
        for (uint32_t i = 0; i < end - first; i++) {
            uint32_t index = first + (jitter + i) % (end - first);
            if (source->features(source->context, &index, 1, feature, &which) > 0) {
                for (uint32_t d = 0; d < T3R_DIMENSIONS; d++) {
                    sample->feature_q11[d][count] = feature[0][d];
                }
                sample->distance_q20[count] = INT32_MAX;
                count++;
                break;
            }
        }
    }
    return count;
}

static void sample_point(const t3r_sample *sample, uint32_t index, int16_t c[T3R_DIMENSIONS])
{
    for (uint32_t d = 0; d < T3R_DIMENSIONS; d++) {
        c[d] = sample->feature_q11[d][index];
    }
}

/* State of the seeding. Runs on one worker: a centre takes less time than passing parts of the sample to others. */
typedef struct seeding {
    const t3r_kernels *kernels;
    const t3r_sample *sample;
    uint32_t count, parts;     /* of the sample */
    uint64_t potential[PARTS]; /* sum of distances for each part */
} seeding;

static void add_centre(seeding *s, const int16_t centre[T3R_DIMENSIONS])
{
    for (uint32_t part = 0; part < s->parts; part++) {
        const uint32_t first = part * PART;
        s->potential[part] = s->kernels->sample_approach(s->sample, first, T3R_MIN(first + PART, s->count), centre);
    }
}

/* Draws a sample point with a probability proportional to its distance: first the part, then the point in the part. */
static uint32_t draw_far(const seeding *s, uint32_t random)
{
    uint64_t potential = 0;
    for (uint32_t part = 0; part < s->parts; part++) {
        potential += s->potential[part];
    }
    /* potential < 2^31 x 2^12; place = potential x (random >> 12) / 2^20 */
    uint64_t place = (potential >> 20) * (random >> 12) + (((potential & 0xfffff) * (random >> 12)) >> 20);
    uint64_t sum = 0;
    uint32_t part = 0;
    while (part + 1 < s->parts && sum + s->potential[part] <= place) {
        sum += s->potential[part++];
    }
    for (uint32_t i = part * PART; i + 1 < s->count; i++) {
        sum += (uint32_t)s->sample->distance_q20[i];
        if (sum > place) {
            return i;
        }
    }
    return s->count - 1;
}

/* Chooses the best of a few draws: the one with the least sum of all distances, the earlier one among equals. */
static void choose_centre(const seeding *s, uint32_t *random, int16_t centre[T3R_DIMENSIONS])
{
    uint64_t least = UINT64_MAX;
    for (uint32_t trial = 0; trial < T3R_CLUSTER_TRIALS; trial++) {
        int16_t candidate[T3R_DIMENSIONS];
        *random = t3r_mix32(*random + 0x9e3779b9u);
        sample_point(s->sample, draw_far(s, *random), candidate);
        const uint64_t with = s->kernels->sample_potential(s->sample, s->count, candidate);
        if (with < least) {
            least = with;
            memcpy(centre, candidate, sizeof candidate);
        }
    }
}

/* Adds the kept centres. Returns whether there is one. */
static bool add_staying(seeding *s, uint32_t count, const bool *stays, const t3r_cluster *clusters)
{
    bool any = false;
    for (uint32_t k = 0; k < count && stays != NULL; k++) {
        if (stays[k]) {
            int16_t centre[T3R_DIMENSIONS];
            for (uint32_t d = 0; d < T3R_DIMENSIONS; d++) {
                centre[d] = (int16_t)t3r_round_shift32(clusters[k].centre_q19[d], T3R_CENTRE_FRACTION);
            }
            add_centre(s, centre);
            any = true;
        }
    }
    return any;
}

bool t3r_seed_centres(const t3r_point_source *source, const t3r_cluster_settings *settings, const bool *stays,
                      t3r_cluster *clusters, const t3r_sample *sample, const t3r_cluster_host *host, uint32_t total)
{
    seeding s = {.kernels = settings->kernels,
                 .sample = sample,
                 .count = draw_sample(source, t3r_cluster_sample(settings->clusters), sample)};
    if (s.count == 0) {
        return true;
    }
    s.parts = (s.count + PART - 1) / PART;
    uint32_t random = t3r_mix32(settings->seed + 0x9e3779b9u);
    int16_t centre[T3R_DIMENSIONS];
    sample_point(sample, random % s.count, centre);
    bool any = add_staying(&s, settings->clusters, stays, clusters);
    for (uint32_t k = 0; k < settings->clusters; k++) {
        if (k % CENTRES_A_STEP == 0 && !t3r_cluster_step(host, 0, total)) {
            return false;
        }
        if (stays != NULL && stays[k]) {
            continue;
        }
        if (any) {
            choose_centre(&s, &random, centre);
        }
        any = true;
        add_centre(&s, centre);
        for (uint32_t d = 0; d < T3R_DIMENSIONS; d++) {
            clusters[k].centre_q19[d] = centre[d] * (1 << T3R_CENTRE_FRACTION);
        }
    }
    return true;
}
