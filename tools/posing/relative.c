/* SPDX-License-Identifier: Apache-2.0 */
#include "posing/relative.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "host/reason.h"
#include "posing/five_point.h"

#define MATCHES_LEAST 20u /* that agree with a motion */
#define TRIES_LEAST 100u
#define TRIES_MOST 4000u
#define TRIES_ALL 1000u /* after so many the samples come from all matches, before from the better ones */
#define RIVALS 6        /* distinct motions that are refined */
#define RIVAL_DEGREES 10.0
#define LEAD_LEAST 3.0        /* matches that the best motion explains and no other, where most agree with it, */
#define LEAD_CERTAIN 9.0      /* and where fewer do: an epipolar line lets one in thirty by chance */
#define PARALLAX_LEAST 1.0    /* pixels, of the median match */
#define DIRECTION_DEGREES 6.0 /* standard deviation of a direction that is refused */
#define TURN_DEGREES 2.0      /* of a rotation */
#define SEED UINT64_C(20110514)
#define DEGREE (3.14159265358979323846 / 180)

/* ---- chance ----------------------------------------------------------------------------------------------------- */

static uint32_t random_below(uint64_t *state, uint32_t limit)
{
    *state = *state * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return (uint32_t)((*state >> 32) * limit >> 32);
}

/* `wanted` different numbers below limit, which is more. */
static void choose(uint64_t *state, uint32_t limit, uint32_t wanted, uint32_t *chosen)
{
    for (uint32_t i = 0; i < wanted; i++) {
        bool taken;
        do {
            chosen[i] = random_below(state, limit);
            taken = false;
            for (uint32_t k = 0; k < i; k++) {
                taken = taken || chosen[k] == chosen[i];
            }
        } while (taken);
    }
}

/* How many of the matches, best first, the n-th sample is drawn from (PROSAC's idea). */
static uint32_t drawn_from(uint32_t n, uint32_t count)
{
    uint32_t least = MATCHES_LEAST / 2, some = (uint32_t)((uint64_t)count * (n + 1) / TRIES_ALL);
    return some > count ? count : some < least ? least : some;
}

/* Tries after which a sample without an outlier has been seen but for one chance in a thousand. */
static uint32_t tries_for(uint32_t inliers, uint32_t count, uint32_t sample)
{
    double good = pow((double)inliers / count, sample);
    double tries = good < 1 ? log(1e-3) / log1p(-good) : 1;
    return tries < TRIES_LEAST ? TRIES_LEAST : tries > TRIES_MOST ? TRIES_MOST : (uint32_t)tries;
}

/* ---- candidates ------------------------------------------------------------------------------------------------- */

typedef struct candidate {
    motion motion;
    double cost; /* square pixels; of matches along its own lines: minus how many it explains */
    uint32_t inliers;
    fit_account account;
} candidate;

typedef struct candidates {
    candidate best[RIVALS];
    uint32_t count;
} candidates;

static bool alike(const motion *m, const motion *other)
{
    return rotation_angle(m->r, other->r) < RIVAL_DEGREES / 2 * DEGREE &&
           direction_angle(m->t, other->t) < RIVAL_DEGREES * DEGREE;
}

/* Keeps the cheapest in order: of motions that are alike one, or one in all. */
static void keep(candidates *c, const candidate *one, bool distinct)
{
    uint32_t kept = 0, at = 0;
    for (uint32_t i = 0; i < c->count; i++) {
        if ((!distinct || alike(&c->best[i].motion, &one->motion)) && c->best[i].cost <= one->cost) {
            return;
        }
    }
    for (uint32_t i = 0; i < c->count; i++) {
        if (distinct && !alike(&c->best[i].motion, &one->motion)) {
            c->best[kept++] = c->best[i];
        }
    }
    while (at < kept && c->best[at].cost <= one->cost) {
        at++;
    }
    c->count = kept;
    if (at < RIVALS) {
        c->count = kept < RIVALS ? kept + 1 : RIVALS;
        memmove(&c->best[at + 1], &c->best[at], (c->count - 1 - at) * sizeof c->best[0]);
        c->best[at] = *one;
    }
}

/* ---- rays ------------------------------------------------------------------------------------------------------- */

bool relative_triangulate(const motion *m, const double ray_a[2], const double ray_b[2], double *depth_a,
                          double *depth_b)
{
    /* depth_a r u - depth_b v = -t in the second camera's axes, by least squares */
    const double first[3] = {ray_a[0], ray_a[1], 1}, v[3] = {ray_b[0], ray_b[1], 1};
    double u[3];
    apply3(m->r, first, u);
    double uu = dot3(u, u), uv = dot3(u, v), vv = dot3(v, v), ut = dot3(u, m->t), vt = dot3(v, m->t);
    double determinant = uu * vv - uv * uv;
    if (!(determinant > 1e-12 * uu * vv)) {
        return false;
    }
    *depth_a = (uv * vt - vv * ut) / determinant;
    *depth_b = (uu * vt - uv * ut) / determinant;
    return *depth_a > 0 && *depth_b > 0;
}

static uint32_t in_front(const fit_pair *pair, const motion *m)
{
    uint32_t count = 0;
    double a, b;
    for (uint32_t i = 0; i < pair->count; i++) {
        const pose_match *match = &pair->matches[i];
        count += fit_error(pair, i, m) < fit_pixels(pair) &&
                 relative_triangulate(m, pair->a->rays[match->a], pair->b->rays[match->b], &a, &b);
    }
    return count;
}

/* Of the four motions of an essential matrix the one with the most points before both cameras. */
static int motion_of(const fit_pair *pair, const double e[9], motion *m)
{
    motion four[4];
    uint32_t most = 0;
    if (essential_motions(e, four) != 0) {
        return -1;
    }
    *m = four[0];
    for (int i = 0; i < 4; i++) {
        uint32_t front = in_front(pair, &four[i]);
        if (front > most) {
            most = front;
            *m = four[i];
        }
    }
    return 0;
}

static int ascending(const void *a, const void *b)
{
    double p = *(const double *)a, q = *(const double *)b;
    return (p > q) - (p < q);
}

/* Inliers of the best motion into `out`, and their parallax. */
static int take_inliers(const fit_pair *pair, relative_pose *out)
{
    double *moved = malloc((pair->count + 1) * sizeof *moved);
    free(out->matches);
    out->matches = malloc((pair->count + 1) * sizeof *out->matches);
    out->count = 0;
    for (uint32_t i = 0; i < pair->count && moved != NULL && out->matches != NULL; i++) {
        if (fit_error(pair, i, &out->motion) < fit_pixels(pair)) {
            const double *a = pair->a->rays[pair->matches[i].a], *b = pair->b->rays[pair->matches[i].b];
            const double ray[3] = {a[0], a[1], 1}, seen[3] = {b[0], b[1], 1};
            double turned[3];
            apply3(out->motion.r, ray, turned);
            moved[out->count] = pair->b->focal * direction_angle(turned, seen);
            out->matches[out->count++] = pair->matches[i];
        }
    }
    int status = moved != NULL && out->matches != NULL ? 0 : -1;
    if (status == 0 && out->count > 0) {
        qsort(moved, out->count, sizeof *moved, ascending);
        out->parallax_pixels = moved[out->count / 2];
    }
    free(moved);
    return status;
}

static int too_few(const relative_pose *out, const char *what, char *error, size_t error_bytes)
{
    return t3r_reason(error, error_bytes, "only %u of %u matching corners %s, %u are needed", out->count, out->tried,
                      what, MATCHES_LEAST);
}

/* ---- colour ----------------------------------------------------------------------------------------------------- */

static void try_fives(const fit_pair *pair, candidates *c)
{
    uint64_t state = SEED;
    uint32_t tries = TRIES_MOST;
    for (uint32_t n = 0; n < tries; n++) {
        uint32_t chosen[5];
        double rays_a[5][2], rays_b[5][2], essentials[FIVE_POINT_MOST][9];
        choose(&state, drawn_from(n, pair->count), 5, chosen);
        for (int i = 0; i < 5; i++) {
            memcpy(rays_a[i], pair->a->rays[pair->matches[chosen[i]].a], sizeof rays_a[i]);
            memcpy(rays_b[i], pair->b->rays[pair->matches[chosen[i]].b], sizeof rays_b[i]);
        }
        int found = five_point(rays_a, rays_b, essentials);
        for (int i = 0; i < found; i++) {
            motion four[4];
            if (essential_motions(essentials[i], four) != 0) {
                continue;
            }
            candidate one = {.motion = four[0]}; /* all four have the same errors */
            one.cost = fit_cost(pair, &one.motion, &one.inliers);
            if ((c->count < RIVALS || one.cost < c->best[RIVALS - 1].cost) &&
                motion_of(pair, essentials[i], &one.motion) == 0) {
                keep(c, &one, true);
                tries = tries_for(c->best[0].inliers, pair->count, 5);
            }
        }
    }
}

/* Each refined, in the order of their costs then. */
static void refine_all(const fit_pair *pair, candidates *c)
{
    candidates refined = {.count = 0};
    for (uint32_t i = 0; i < c->count; i++) {
        candidate one = c->best[i];
        if (fit_refine(pair, &one.motion, &one.account) == 0) {
            double e[9];
            essential_of(&one.motion, e);
            if (motion_of(pair, e, &one.motion) == 0) {
                one.cost = fit_cost(pair, &one.motion, &one.inliers);
                keep(&refined, &one, true);
            }
        }
    }
    *c = refined;
}

/* The matches along the epipolar lines of the best motion so far; the old ones where they are more. */
static uint32_t more_matches(const fit_pair *pair, const motion *m, pose_match *found)
{
    double e[9];
    essential_of(m, e);
    uint32_t count = matches_along(pair->a, pair->b, e, 2 * fit_pixels(pair), found);
    if (count < pair->count * 3 / 4) {
        memcpy(found, pair->matches, pair->count * sizeof *found);
        count = pair->count;
    }
    return count;
}

/* What matches along a candidate's own epipolar lines say for it: nearly one for each that fits well. Lines of a wrong
 * motion have matches too, but fewer. */
static void weigh_by_lines(const fit_pair *pair, candidates *c, pose_match *found)
{
    candidates weighed = {.count = 0};
    for (uint32_t i = 0; i < c->count; i++) {
        candidate one = c->best[i];
        fit_pair lines = *pair;
        lines.count = more_matches(pair, &one.motion, found);
        lines.matches = found;
        if (fit_refine(&lines, &one.motion, &one.account) == 0) {
            one.cost =
                fit_cost(&lines, &one.motion, &one.inliers) / (fit_pixels(pair) * fit_pixels(pair)) - lines.count;
            keep(&weighed, &one, true);
        }
    }
    *c = weighed;
}

/* Whether the best motion stands out, judged on matches that were found without any. */
static int check_candidates(const candidates *c, const relative_pose *out, char *error, size_t error_bytes)
{
    if (out->count < MATCHES_LEAST) {
        return too_few(out, "agree on a motion", error, error_bytes);
    }
    if (out->parallax_pixels < PARALLAX_LEAST) {
        return t3r_reason(error, error_bytes,
                          "no parallax: without the cameras' turning, corners move by %.1f pixels; a direction cannot "
                          "be told from colour, move the camera or give depth",
                          out->parallax_pixels);
    }
    double lead = c->count > 1 ? c->best[1].cost - c->best[0].cost : HUGE_VAL;
    bool most = 2 * out->count >= out->tried;
    if (lead < (most ? LEAD_LEAST : LEAD_CERTAIN)) {
        double apart = fmax(direction_angle(c->best[0].motion.t, c->best[1].motion.t),
                            rotation_angle(c->best[0].motion.r, c->best[1].motion.r));
        return t3r_reason(error, error_bytes,
                          "two motions %.0f degrees apart explain the corners about equally (%u of %u agree with the "
                          "better one): they may lie on one plane, or too few are seen in both",
                          apart / DEGREE, out->count, out->tried);
    }
    return 0;
}

int relative_by_colour(const pose_view *a, const pose_view *b, const pose_match *matches, uint32_t count,
                       relative_pose *out, char *error, size_t error_bytes)
{
    fit_pair pair = {a, b, matches, count, false};
    candidates c = {.count = 0};
    *out = (relative_pose){.tried = count};
    if (count < MATCHES_LEAST) {
        return t3r_reason(error, error_bytes, "only %u corners match, %u are needed", count, MATCHES_LEAST);
    }
    pose_match *more = malloc(CORNERS_MOST * sizeof *more);
    if (more == NULL) {
        return t3r_reason(error, error_bytes, "out of memory");
    }
    try_fives(&pair, &c);
    refine_all(&pair, &c);
    weigh_by_lines(&pair, &c, more);
    int status = 0;
    if (c.count > 0) {
        out->motion = c.best[0].motion;
        out->account = c.best[0].account;
        status = take_inliers(&pair, out) == 0 ? 0 : t3r_reason(error, error_bytes, "out of memory");
    }
    status = status == 0 ? check_candidates(&c, out, error, error_bytes) : status;
    if (status == 0) {
        pair.count = more_matches(&pair, &out->motion, more);
        pair.matches = more;
        out->tried = pair.count;
        (void)fit_refine(&pair, &out->motion, &out->account); /* else as it was */
        status = take_inliers(&pair, out) == 0 ? 0 : t3r_reason(error, error_bytes, "out of memory");
    }
    free(more);
    if (status == 0 && !(out->account.direction_degree < DIRECTION_DEGREES)) {
        status = t3r_reason(error, error_bytes,
                            "the direction of motion is known to %.0f degrees only: too little parallax, or corners "
                            "too few or too close together",
                            out->account.direction_degree);
    }
    return status;
}

/* ---- depth ------------------------------------------------------------------------------------------------------ */

/* The rigid motion with the least squares between three pairs of points (Kabsch). 0, or -1 where they lie on a line. */
static int align(double from[3][3], double to[3][3], motion *m)
{
    double centre_from[3] = {0}, centre_to[3] = {0}, h[9] = {0}, u[9], s[3], vt[9];
    for (int i = 0; i < 9; i++) {
        centre_from[i % 3] += from[i / 3][i % 3] / 3;
        centre_to[i % 3] += to[i / 3][i % 3] / 3;
    }
    for (int p = 0; p < 3; p++) {
        for (int i = 0; i < 9; i++) {
            h[i] += (to[p][i / 3] - centre_to[i / 3]) * (from[p][i % 3] - centre_from[i % 3]);
        }
    }
    if (singular3(h, u, s, vt) != 0 || s[1] < 1e-3 * s[0]) {
        return -1;
    }
    /* three points span a plane: the third axis is free to make it a rotation */
    if (determinant3(u) * determinant3(vt) < 0) {
        for (int i = 0; i < 3; i++) {
            u[3 * i + 2] = -u[3 * i + 2];
        }
    }
    multiply3(u, vt, m->r);
    apply3(m->r, centre_from, m->t);
    for (int i = 0; i < 3; i++) {
        m->t[i] = centre_to[i] - m->t[i];
    }
    return 0;
}

static void point_of(const pose_view *view, uint32_t at, double point[3])
{
    double depth = view->depth[at];
    point[0] = view->rays[at][0] * depth;
    point[1] = view->rays[at][1] * depth;
    point[2] = depth;
}

static void try_threes(const fit_pair *pair, const uint32_t *deep, uint32_t deep_count, candidates *c)
{
    uint64_t state = SEED;
    uint32_t tries = TRIES_MOST;
    for (uint32_t n = 0; n < tries; n++) {
        uint32_t chosen[3];
        double from[3][3], to[3][3];
        choose(&state, drawn_from(n, deep_count), 3, chosen);
        for (int i = 0; i < 3; i++) {
            point_of(pair->a, pair->matches[deep[chosen[i]]].a, from[i]);
            point_of(pair->b, pair->matches[deep[chosen[i]]].b, to[i]);
        }
        candidate one;
        if (align(from, to, &one.motion) != 0) {
            continue;
        }
        one.cost = fit_cost(pair, &one.motion, &one.inliers);
        if (c->count < RIVALS || one.cost < c->best[RIVALS - 1].cost) {
            keep(c, &one, false);
            tries = tries_for(c->best[0].inliers, pair->count, 3);
        }
    }
}

/* -1 where there is none: *lack is what too few matches, out->count, do. */
static int best_by_depth(fit_pair *pair, relative_pose *out, pose_match *more, const char **lack)
{
    uint32_t *deep = malloc((pair->count + 1) * sizeof *deep), deep_count = 0;
    candidates c = {.count = 0};
    for (uint32_t i = 0; i < pair->count && deep != NULL; i++) {
        if (pair->a->depth[pair->matches[i].a] > 0 && pair->b->depth[pair->matches[i].b] > 0) {
            deep[deep_count++] = i;
        }
    }
    *lack = "have depth in both views";
    out->count = deep_count;
    if (deep_count >= MATCHES_LEAST / 2) {
        try_threes(pair, deep, deep_count, &c);
        *lack = "agree on a motion";
        out->count = c.count > 0 ? c.best[0].inliers : 0;
    }
    free(deep);
    if (c.count == 0 || fit_refine(pair, &c.best[0].motion, &c.best[0].account) != 0) {
        return -1;
    }
    pair->count = more_matches(pair, &c.best[0].motion, more);
    pair->matches = more;
    out->tried = pair->count;
    if (fit_refine(pair, &c.best[0].motion, &c.best[0].account) != 0) {
        return -1;
    }
    out->motion = c.best[0].motion;
    out->account = c.best[0].account;
    return take_inliers(pair, out);
}

int relative_by_depth(const pose_view *a, const pose_view *b, const pose_match *matches, uint32_t count,
                      relative_pose *out, char *error, size_t error_bytes)
{
    fit_pair pair = {a, b, matches, count, true};
    *out = (relative_pose){.tried = count, .metric = true};
    if (count < MATCHES_LEAST) {
        return t3r_reason(error, error_bytes, "only %u corners match, %u are needed", count, MATCHES_LEAST);
    }
    pose_match *more = malloc(CORNERS_MOST * sizeof *more);
    if (more == NULL) {
        return t3r_reason(error, error_bytes, "out of memory");
    }
    const char *lack;
    int status = best_by_depth(&pair, out, more, &lack);
    free(more);
    if (status != 0) {
        return out->count < MATCHES_LEAST
                   ? too_few(out, lack, error, error_bytes)
                   : t3r_reason(error, error_bytes, "the %u matching corners that agree do not determine a motion",
                                out->count);
    }
    if (out->count < MATCHES_LEAST) {
        return too_few(out, "agree on a motion", error, error_bytes);
    }
    if (!(out->account.turn_degrees < TURN_DEGREES)) {
        return t3r_reason(error, error_bytes, "the rotation is known to %.1f degrees only: corners too close together",
                          out->account.turn_degrees);
    }
    return 0;
}

void relative_free(relative_pose *pose)
{
    free(pose->matches);
    *pose = (relative_pose){0};
}
