/* SPDX-License-Identifier: Apache-2.0 */
#include "study/rivals/scores/choose.h"

#include <stdlib.h>

#include "budget/budget.h"
#include "core/fixed.h"
#include "state/views.h"

typedef struct ranked {
    double score;
    uint32_t index;
} ranked;

static int by_score(const void *a, const void *b)
{
    const ranked *x = a, *y = b;
    if (x->score != y->score) {
        return x->score > y->score ? -1 : 1;
    }
    return (x->index > y->index) - (x->index < y->index);
}

/* A whole rim has 24 Gaussians a view, and needs a budget of 384 a view (runtime/SPEC.md, "Rim"). */
#define BUDGET_PER_BEYOND 16u

/* Returns how many of the Gaussians that are not of surfaces are kept. */
static uint32_t beyond_kept(uint32_t surfaces, uint32_t of, uint32_t count)
{
    const uint32_t beyond = of - surfaces;
    return count / BUDGET_PER_BEYOND >= beyond ? beyond : count - T3R_MIN(count, surfaces);
}

bool rival_choose(const double *score, uint32_t surfaces, uint32_t of, uint32_t count, uint32_t *kept)
{
    const uint32_t beyond = beyond_kept(surfaces, of, count);
    ranked *all = malloc(((size_t)of + 1) * sizeof *all);
    bool *stays = calloc((size_t)of + 1, sizeof *stays);
    bool done = all != NULL && stays != NULL;
    for (uint32_t i = 0; i < surfaces && done; i++) {
        all[i] = (ranked){score[i], i};
    }
    if (done) {
        qsort(all, surfaces, sizeof *all, by_score);
    }
    for (uint32_t n = 0; n < count - beyond && done; n++) {
        stays[all[n].index] = true;
    }
    for (uint32_t n = 0; n < beyond && done; n++) {
        stays[surfaces + n] = true;
    }
    for (uint32_t i = 0, n = 0; i < of && done; i++) {
        if (stays[i]) {
            kept[n++] = i;
        }
    }
    free(all);
    free(stays);
    return done;
}

bool rival_planes(const t3r_runtime *rt, const t3r_scene *scene, uint32_t views, const uint32_t *kept, uint32_t count,
                  uint16_t *const planes[])
{
    t3r_view view[T3R_MAX_VIEWS];
    t3r_views_of(rt, view);
    uint32_t gaussian = 0, next = 0;
    for (uint32_t v = 0; v < views; v++) {
        const size_t pixels = (size_t)view[v].width * view[v].height;
        for (size_t i = 0; i < pixels; i++) {
            planes[v][i] = 0;
            if (!t3r_retained(&view[v], i)) {
                continue;
            }
            if (gaussian >= scene->count || scene->gaussians[gaussian].view != v) {
                return false;
            }
            if (kept == NULL || (next < count && kept[next] == gaussian)) {
                planes[v][i] = UINT16_MAX;
                next++;
            }
            gaussian++;
        }
    }
    return true;
}
