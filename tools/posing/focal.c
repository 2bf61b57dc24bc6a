/* SPDX-License-Identifier: Apache-2.0 */
#include "posing/focal.h"

#include <math.h>
#include <stdlib.h>

#include "cli/cli.h"

#define PAIRS_MOST 8u
#define MATCHES_LEAST 60u
#define MATCHES_MOST 400u /* of a pair, evenly spread, or it takes long */
#define BAND 1.2          /* pixels, of a match that agrees */
#define STEP 0.16         /* between the logarithms of two candidates */
#define CANDIDATES 9      /* around the usual one: 0.42 to 1.52 of the longer side */
#define DOUBT 0.02        /* share of matches that a length must explain more if its logarithm is 1 off the usual one */

/* Two views and what they have in common. */
typedef struct focal_pair {
    pose_features a, b; /* share all but their rays with the views */
    uint32_t count;
    pose_match *matches;
} focal_pair;

/* Copies a view's features for a focal length that is `factor` times the assumed one. */
static void scale(const pose_features *from, double factor, pose_features *to)
{
    to->focal = from->focal * factor;
    for (uint32_t i = 0; i < from->count; i++) {
        to->rays[i][0] = from->rays[i][0] / factor;
        to->rays[i][1] = from->rays[i][1] / factor;
    }
}

/* Returns the matches that the motion of a pair leaves unexplained, those that agree by the square of their error. */
static double unexplained(const pose_view *views, uint32_t a, uint32_t b, double factor, focal_pair *pair,
                          relative_pose *motion)
{
    char why[256];
    scale(&views[a].features, factor, &pair->a);
    scale(&views[b].features, factor, &pair->b);
    if (views[a].module->relate(&pair->a, &pair->b, pair->matches, pair->count, false, motion, why, sizeof why) != 0) {
        return pair->count;
    }
    const double error = motion->pixels / BAND;
    return pair->count - motion->count * (1 - fmin(1, error * error));
}

/* Keeps MATCHES_MOST of more matches, evenly spread. */
static void thin(focal_pair *pair)
{
    for (uint32_t i = 0; i < MATCHES_MOST && pair->count > MATCHES_MOST; i++) {
        pair->matches[i] = pair->matches[(size_t)i * pair->count / MATCHES_MOST];
    }
    pair->count = pair->count < MATCHES_MOST ? pair->count : MATCHES_MOST;
}

/* Adds to costs[] the share of a pair's matches that each candidate leaves unexplained. Returns whether it has enough.
 */
static bool add_costs(const pose_view *views, uint32_t a, uint32_t b, double costs[CANDIDATES])
{
    focal_pair pair = {.a = views[a].features, .b = views[b].features};
    relative_pose motion = {0};
    char why[256];
    pair.a.rays = malloc(FEATURES_MOST * sizeof *pair.a.rays);
    pair.b.rays = malloc(FEATURES_MOST * sizeof *pair.b.rays);
    pair.matches = malloc(FEATURES_MOST * sizeof *pair.matches);
    motion.matches = malloc(FEATURES_MOST * sizeof *motion.matches);
    const bool room = pair.a.rays != NULL && pair.b.rays != NULL && pair.matches != NULL && motion.matches != NULL;
    const bool enough = room &&
                        views[a].module->match(&views[a].features, &views[b].features, pair.matches, &pair.count, why,
                                               sizeof why) == 0 &&
                        pair.count >= MATCHES_LEAST;
    thin(&pair);
    for (int i = 0; i < CANDIDATES && enough; i++) {
        costs[i] += unexplained(views, a, b, exp((i - CANDIDATES / 2) * STEP), &pair, &motion) / pair.count;
    }
    free(motion.matches);
    free(pair.matches);
    free(pair.b.rays);
    free(pair.a.rays);
    return enough;
}

/* Returns the place of the least cost, by the parabola through it and its neighbours. */
static double lowest(const double costs[CANDIDATES])
{
    int at = 0;
    for (int i = 1; i < CANDIDATES; i++) {
        at = costs[i] < costs[at] ? i : at;
    }
    if (at == 0 || at == CANDIDATES - 1) {
        return at;
    }
    const double left = costs[at - 1] - costs[at], right = costs[at + 1] - costs[at];
    return left + right > 0 ? at + (left - right) / (2 * (left + right)) : at;
}

double focal_estimate(pose_view *views, uint32_t count)
{
    double costs[CANDIDATES] = {0};
    uint32_t pairs = 0;
    for (uint32_t apart = 2; apart >= 1; apart--) {
        const uint32_t step = 1 + count / PAIRS_MOST;
        for (uint32_t a = 0; a + apart < count && pairs < PAIRS_MOST; a += step) {
            cli_progress("estimating the focal length", pairs, PAIRS_MOST);
            pairs += add_costs(views, a, a + apart, costs);
        }
    }
    if (pairs == 0) {
        return 1;
    }
    for (int i = 0; i < CANDIDATES; i++) {
        const double off = (i - CANDIDATES / 2) * STEP;
        costs[i] += pairs * DOUBT * off * off;
    }
    const double factor = exp((lowest(costs) - CANDIDATES / 2) * STEP);
    for (uint32_t i = 0; i < count; i++) {
        scale(&views[i].features, factor, &views[i].features);
    }
    return factor;
}
