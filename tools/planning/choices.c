/* SPDX-License-Identifier: Apache-2.0 */
#include "planning/choices.h"

#include "head/weights.h"
#include "planning/quality.h"

_Static_assert(QUALITY_PASSES *QUALITY_SHARES <= CHOICES_MOST, "choices are at most those of the table");

/* Rows of quality_loss_q4; a network counts as the shipped one of about its size. */
enum { ROW_ANALYTIC, ROW_TINY, ROW_SMALL };
#define TINY_MOST_MACS 1400u /* a pixel */

static uint32_t quality_row(const void *weights)
{
    if (weights == NULL) {
        return ROW_ANALYTIC;
    }
    return t3r_weights_header_of(weights).macs_q8 >> 8 <= TINY_MOST_MACS ? ROW_TINY : ROW_SMALL;
}

/* Returns the loss of the last row whose passes are no more, and of the first share that is no more once it is rounded,
 * or the last. */
static double loss_of(uint32_t row, uint32_t passes, uint32_t gaussians, uint64_t points)
{
    uint32_t p = QUALITY_PASSES - 1, s = 0;
    while (p > 0 && quality_passes[p] > passes) {
        p--;
    }
    while (s + 1 < QUALITY_SHARES && points * quality_percent[s] > (uint64_t)gaussians * 100 + 50) {
        s++;
    }
    return quality_loss_q4[row][p][s] / 16.0;
}

/* Returns the share rounded half up: at least 1, as a view has at least 64 points, and below 2^29. */
static uint32_t share_of(uint64_t points, uint32_t percent)
{
    return (uint32_t)((points * percent + 50) / 100);
}

/* Whether the configuration fits, which fills the choice. */
static bool try_one(const t3r_config *config, const chosen_head *head, const choice_limits *limits, choice *found)
{
    work_counts work;
    const uint64_t points = (uint64_t)config->width * config->height * config->views;
    *found = (choice){
        .head = head,
        .gaussians = config->gaussians,
        .refine = config->refine,
        .loss = loss_of(quality_row(head->weights), config->refine, config->gaussians, points),
    };
    if (t3r_plan_bytes(config, &found->min_bytes, &found->full_bytes) != T3R_OK) {
        return false; /* a share of very many points is more than T3R_MAX_GAUSSIANS */
    }
    const size_t bytes = limits->bytes == 0 ? found->full_bytes : limits->bytes;
    if (work_count(config, bytes, head->weights, &work) != T3R_OK) {
        return false;
    }
    found->price = limits->prices != NULL ? work_price_of_build(&work, limits->prices) : 0;
    return limits->most <= 0 || found->price <= limits->most;
}

/* Whether a is as good as b in every respect. */
static bool is_as_good(const choice *a, const choice *b)
{
    return a->loss <= b->loss && a->full_bytes <= b->full_bytes && a->price <= b->price;
}

static bool precedes(const choice *a, const choice *b)
{
    return a->loss != b->loss ? a->loss < b->loss : a->price < b->price;
}

/* Inserts the choice and drops those that it matches or beats. Does nothing if one in the list is as good. */
static uint32_t add(choice *choices, uint32_t count, const choice *found)
{
    uint32_t kept = 0;
    for (uint32_t i = 0; i < count; i++) {
        if (is_as_good(&choices[i], found)) {
            return count; /* `found` is as good as none before it */
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

t3r_status choices_add(const t3r_config *config, const chosen_head *head, const choice_limits *limits, choice *choices,
                       uint32_t *count)
{
    const uint64_t points = (uint64_t)config->width * config->height * config->views;
    t3r_config tried = *config;
    chosen_head_configure(head, &tried);
    tried.gaussians = tried.max_gaussians = 1;
    tried.refine = 0;
    size_t least, most;
    const t3r_status status = t3r_plan_bytes(&tried, &least, &most);
    for (uint32_t p = 0; p < QUALITY_PASSES && status == T3R_OK; p++) {
        tried.refine = limits->refine == CHOICES_ANY_REFINE ? quality_passes[p] : limits->refine;
        for (uint32_t s = 0; s < QUALITY_SHARES; s++) {
            choice found;
            tried.gaussians = limits->gaussians != 0 ? limits->gaussians : share_of(points, quality_percent[s]);
            tried.max_gaussians = tried.gaussians;
            if (try_one(&tried, head, limits, &found)) {
                *count = add(choices, *count, &found);
            }
        }
    }
    return status;
}
