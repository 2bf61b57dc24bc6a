/* SPDX-License-Identifier: Apache-2.0 */
/* Which settings fit, and which of them are expected to lose least. */
#include "arena.h"
#include "core/config.h"
#include "core/fixed.h"
#include "head/weights.h"
#include "quality.h"
#include "state/state.h"

_Static_assert(T3R_QUALITY_PASSES *T3R_QUALITY_SHARES <= T3R_MAX_CHOICES, "choices are at most those of the table");

/* Rows of T3R_QUALITY_HEADS; a network counts as the shipped one of about its size. */
enum { ROW_ANALYTIC, ROW_TINY, ROW_SMALL };
#define TINY_MOST_MACS 1400u /* a pixel */

static uint32_t quality_row(t3r_head head, const void *weights)
{
    if (head != T3R_HEAD_LEARNED) {
        return ROW_ANALYTIC;
    }
    return t3r_weights_header_of(weights).macs_q8 >> 8 <= TINY_MOST_MACS ? ROW_TINY : ROW_SMALL;
}

/* Of the last row whose passes are no more, and of the first share that is no more once it is rounded, or the last. */
static uint32_t loss_of(uint32_t row, uint32_t passes, uint32_t gaussians, uint64_t points)
{
    uint32_t p = T3R_QUALITY_PASSES - 1, s = 0;
    while (p > 0 && t3r_quality_passes[p] > passes) {
        p--;
    }
    while (s + 1 < T3R_QUALITY_SHARES && points * t3r_quality_percent[s] > (uint64_t)gaussians * 100 + 50) {
        s++;
    }
    return t3r_quality_loss_q4[row][p][s];
}

/* Rounded half up, at least 1; below 2^29. */
static uint32_t share_of(uint64_t points, uint32_t percent)
{
    const uint64_t share = (points * percent + 50) / 100;
    return (uint32_t)T3R_MAX(share, 1);
}

typedef struct search {
    t3r_config config; /* tried */
    const void *weights;
    size_t weight_bytes;
    const t3r_limits *limits;
    uint32_t row;
    uint64_t points;
} search;

/* Whether the configuration fits, which fills the choice. */
static bool try_one(const search *s, t3r_choice *choice)
{
    const t3r_config *c = &s->config;
    t3r_layout layout;
    if (t3r_config_check(c) != T3R_OK) {
        return false; /* a share of very many points is more than T3R_MAX_GAUSSIANS */
    }
    (void)t3r_lay_out(c, 0, &layout); /* for the two sums */
    *choice = (t3r_choice){
        .gaussians = c->gaussians,
        .refine = c->refine,
        .head = c->head,
        .weights = s->weights,
        .min_bytes = layout.min_bytes,
        .full_bytes = layout.bytes,
        .loss_q4 = loss_of(s->row, c->refine, c->gaussians, s->points),
    };
    const size_t bytes = s->limits->bytes == 0 ? layout.bytes : s->limits->bytes;
    t3r_work_counts counts;
    if (t3r_count_work(c, bytes, s->weights, s->weight_bytes, &counts) != T3R_OK) {
        return false;
    }
    choice->price = s->limits->prices != NULL ? t3r_price_of_build(&counts, s->limits->prices) : 0;
    return s->limits->most == 0 || choice->price <= s->limits->most;
}

/* Whether a is as good as b in every respect. */
static bool is_as_good(const t3r_choice *a, const t3r_choice *b)
{
    return a->loss_q4 <= b->loss_q4 && a->full_bytes <= b->full_bytes && a->price <= b->price;
}

static bool precedes(const t3r_choice *a, const t3r_choice *b)
{
    return a->loss_q4 != b->loss_q4 ? a->loss_q4 < b->loss_q4 : a->price < b->price;
}

/* Adds it, unless one that is there is as good, without those that it is as good as. */
static uint32_t add(t3r_choice *choices, uint32_t count, const t3r_choice *found)
{
    uint32_t kept = 0;
    for (uint32_t i = 0; i < count; i++) {
        if (is_as_good(&choices[i], found)) {
            return count; /* then `found` is as good as none that stands before it */
        }
        if (!is_as_good(found, &choices[i])) {
            choices[kept++] = choices[i];
        }
    }
    uint32_t at = kept;
    for (; at > 0 && precedes(found, &choices[at - 1]); at--) {
        choices[at] = choices[at - 1];
    }
    choices[at] = *found;
    return kept + 1;
}

static bool are_limits(const t3r_limits *limits)
{
    return limits != NULL && (limits->most == 0 || limits->prices != NULL) && limits->gaussians <= T3R_MAX_GAUSSIANS &&
           (limits->refine <= T3R_MAX_REFINE || limits->refine == T3R_ANY_REFINE);
}

t3r_status t3r_plan_choices(const t3r_config *config, const void *weights, size_t weight_bytes,
                            const t3r_limits *limits, t3r_choice *choices, uint32_t *count)
{
    T3R_REFUSE_UNLESS(config != NULL && are_limits(limits) && choices != NULL && count != NULL, T3R_ERR_ARGUMENT);
    search s = {.config = *config, .weights = weights, .weight_bytes = weight_bytes, .limits = limits};
    s.config.gaussians = s.config.max_gaussians = 1;
    s.config.refine = 0;
    const t3r_status status = t3r_config_check(&s.config);
    if (status != T3R_OK || config->stream != 0) {
        return status != T3R_OK ? status : T3R_ERR_CONFIG;
    }
    if (config->head == T3R_HEAD_LEARNED && t3r_weights_check(weights, weight_bytes) != T3R_OK) {
        return T3R_ERR_WEIGHTS;
    }
    s.row = quality_row(config->head, weights);
    s.points = (uint64_t)config->width * config->height * config->views;
    for (uint32_t p = 0; p < T3R_QUALITY_PASSES; p++) {
        for (uint32_t share = 0; share < T3R_QUALITY_SHARES; share++) {
            t3r_choice found;
            const bool any = limits->refine == T3R_ANY_REFINE;
            s.config.refine = any ? t3r_quality_passes[p] : limits->refine;
            s.config.gaussians =
                limits->gaussians != 0 ? limits->gaussians : share_of(s.points, t3r_quality_percent[share]);
            s.config.max_gaussians = s.config.gaussians;
            if (try_one(&s, &found)) {
                *count = add(choices, *count, &found);
            }
        }
    }
    return T3R_OK;
}
