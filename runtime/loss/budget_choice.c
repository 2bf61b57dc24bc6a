/* SPDX-License-Identifier: Apache-2.0 */
#include "budget_choice.h"

#include "core/fixed.h"
#include "pipeline.h"
#include "pointmap/align.h"
#include "pointmap/disagreement.h"
#include "refine/refine.h"
#include "state/state.h"

#define TRIAL_PART 100u     /* the first trial takes 1 / TRIAL_PART of the points, the second twice as many */
#define LEAST_PART 400u     /* at least 1 / LEAST_PART of the points is kept */
#define PAIRS_LEAST 256u    /* with fewer compared pairs, the disagreement is unknown */
#define UNSEEN_Q8 (2u << 8) /* levels^2, 45 dB: a smaller error is invisible */

/* Each dB of allowed loss lets the error grow by 1/17 of the disagreement; a quarter of that is always allowed.
 * Measured on the training scenes, where a refined scene of few Gaussians is at first better than one of all points. */
#define SHARE_DIVISOR 17u
#define LOSS_OFFSET_Q8 64u

static uint64_t ceil_div(uint64_t a, uint64_t b)
{
    return (a + b - 1) / b;
}

uint32_t t3r_predict_budget(const t3r_budget_evidence *e, uint32_t most, uint32_t max_loss_q8)
{
    /* error(Z) = floor + slope / Z, from Z = trial and 2 trial */
    uint64_t fall_q8 = e->error_q8[0] > e->error_q8[1] ? e->error_q8[0] - e->error_q8[1] : 0;
    uint64_t slope_q8 = fall_q8 * 2 * e->trial; /* 2^24 x 2^24 */
    uint64_t floor_q8 = e->error_q8[1] > fall_q8 ? e->error_q8[1] - fall_q8 : 0;
    uint64_t yardstick_q8 = T3R_MAX(e->disagreement_q8 != 0 ? e->disagreement_q8 : floor_q8, UNSEEN_Q8);

    uint64_t allowed = yardstick_q8 * (max_loss_q8 + LOSS_OFFSET_Q8);     /* x 256 x SHARE_DIVISOR */
    uint64_t wanted = ceil_div(slope_q8 * (SHARE_DIVISOR << 8), allowed); /* 2^48 x 2^12 */
    if (e->error_q8[1] < UNSEEN_Q8) { /* the second trial already meets it, so its floor is below it */
        wanted = T3R_MIN(wanted, ceil_div(slope_q8, UNSEEN_Q8 - floor_q8));
    }
    uint64_t least = T3R_MAX(e->points / LEAST_PART, 1u);
    return (uint32_t)T3R_MIN(T3R_MAX(wanted, least), (uint64_t)most);
}

/* Sets the views' poses from their cameras: aligned, or as given. */
static void stand(const t3r_runtime *rt, t3r_view *views, bool as_given)
{
    for (uint32_t v = 0; v < rt->views; v++) {
        t3r_camera camera = rt->camera[v];
        if (as_given) {
            t3r_place_camera(&camera, &rt->given[v]);
        }
        (void)t3r_pose_in_scene(&camera, &rt->frame, &views[v].pose); /* both were in range before */
    }
}

uint32_t t3r_disagreement_as_given_q8(t3r_runtime *rt, t3r_view *views)
{
    const bool aligned = t3r_aligns(&rt->config);
    uint32_t pairs;
    if (aligned) {
        stand(rt, views, true);
    }
    const uint32_t found_q8 = t3r_disagreement_q8(views, rt->views, rt->frame.exponent, rt->gain_q14, 1, &pairs, NULL);
    if (aligned) {
        stand(rt, views, false);
    }
    return pairs < PAIRS_LEAST ? 0 : found_q8;
}

/* Builds a trial scene and measures its error. */
static t3r_status try_build(t3r_runtime *rt, const t3r_view *views, const t3r_build *trial,
                            const t3r_importance *importance, uint32_t *error_q8)
{
    t3r_status status = t3r_build_scene(rt, views, trial, importance);
    return status == T3R_OK ? t3r_refine_error(rt, views, error_q8) : status;
}

t3r_status t3r_choose_budget(t3r_runtime *rt, t3r_view *views, uint32_t max_loss_q8, t3r_build *build,
                             const t3r_importance *importance)
{
    const uint32_t most = T3R_MIN(build->gaussians, rt->valid_points);
    t3r_budget_evidence evidence = {
        .points = rt->valid_points,
        .trial = T3R_MIN(T3R_MAX(rt->valid_points / TRIAL_PART, 1u), most / 2),
    };
    if (evidence.trial == 0) {
        build->gaussians = most;
        return T3R_OK;
    }
    evidence.disagreement_q8 = t3r_disagreement_as_given_q8(rt, views);
    for (uint32_t i = 0; i < 2; i++) {
        t3r_build trial = *build;
        trial.gaussians = evidence.trial << i;
        t3r_status status = try_build(rt, views, &trial, importance, &evidence.error_q8[i]);
        if (status != T3R_OK) {
            return status;
        }
    }
    build->gaussians = t3r_predict_budget(&evidence, most, max_loss_q8);
    return T3R_OK;
}
