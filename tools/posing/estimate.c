/* SPDX-License-Identifier: Apache-2.0 */
#include "posing/estimate.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cli/cli.h"
#include "geometry/quaternion.h"
#include "host/reason.h"

#define DEEP_LEAST 20u  /* matches with depth in both views, or colour decides */
#define SHARED_LEAST 8u /* depths that must agree on a scale */
#define PARALLAX 0.01   /* radians between rays whose meeting place is kept as a depth */

/* ---- pairs ------------------------------------------------------------------------------------------------------ */

/* Two views, the first with the smaller number. */
typedef struct edge {
    uint32_t a, b, count;
    pose_match *matches;
    bool refused;
    char why[POSES_WHY_BYTES];
    bool unscaled; /* refused for want of a scale, which another view may bring */
} edge;

typedef struct graph {
    edge *edges;
    uint32_t count;
} graph;

static void graph_free(graph *g)
{
    for (uint32_t i = 0; i < g->count; i++) {
        free(g->edges[i].matches);
    }
    free(g->edges);
}

static int graph_make(const pose_view *views, uint32_t count, graph *g, char *error, size_t error_bytes)
{
    pose_match *found = malloc(FEATURES_MOST * sizeof *found);
    g->edges = calloc((size_t)count * POSES_WINDOW + 1, sizeof *g->edges);
    int status = found != NULL && g->edges != NULL ? 0 : t3r_reason(error, error_bytes, "out of memory");
    for (uint32_t a = 0; a < count && status == 0; a++) {
        cli_progress("matching", a, count);
        for (uint32_t b = a + 1; b < count && b <= a + POSES_WINDOW && status == 0; b++) {
            edge *e = &g->edges[g->count++];
            e->a = a;
            e->b = b;
            status =
                views[a].module->match(&views[a].features, &views[b].features, found, &e->count, error, error_bytes);
            e->matches = malloc((e->count + 1) * sizeof *e->matches);
            if (e->matches == NULL) {
                status = t3r_reason(error, error_bytes, "out of memory");
            } else {
                memcpy(e->matches, found, e->count * sizeof *found);
            }
        }
    }
    free(found);
    return status;
}

/* The pair with most matches of which one view has its pose; NULL when none is left. */
static edge *best_edge(const graph *g, const bool *posed)
{
    edge *best = NULL;
    for (uint32_t i = 0; i < g->count; i++) {
        edge *e = &g->edges[i];
        if (!e->refused && posed[e->a] != posed[e->b] && (best == NULL || e->count > best->count)) {
            best = e;
        }
    }
    return best;
}

/* ---- scale ------------------------------------------------------------------------------------------------------ */

static int ascending(const void *a, const void *b)
{
    double p = *(const double *)a, q = *(const double *)b;
    return (p > q) - (p < q);
}

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* Depths of a match in both cameras by the midpoint of its rays; false where they meet behind one, or at less than
 * `parallax` radians. */
static bool triangulate(const rigid *there, const double ray_a[2], const double ray_b[2], double parallax,
                        double *depth_a, double *depth_b)
{
    /* depth_a u - depth_b v = -t in the second camera's axes, by least squares */
    const double first[3] = {ray_a[0], ray_a[1], 1}, v[3] = {ray_b[0], ray_b[1], 1}, *t = there->position;
    double u[3];
    quaternion_rotate(there->rotation, first, u);
    double uu = dot(u, u), uv = dot(u, v), vv = dot(v, v), ut = dot(u, t), vt = dot(v, t);
    double determinant = uu * vv - uv * uv;
    if (!(determinant > parallax * parallax * uu * vv)) {
        return false;
    }
    *depth_a = (uv * vt - vv * ut) / determinant;
    *depth_b = (uu * vt - uv * ut) / determinant;
    return *depth_a > 0 && *depth_b > 0;
}

/* The median of known depths over those that rays meet at for |t| = 1; 0 where too few are known. */
static double scale_by_depth(const pose_features *a, const pose_features *b, const relative_pose *r)
{
    double *ratios = malloc((2 * (size_t)r->count + 1) * sizeof *ratios), scale = 0;
    uint32_t count = 0;
    for (uint32_t i = 0; i < r->count && ratios != NULL; i++) {
        const pose_match *m = &r->matches[i];
        double depth_a, depth_b;
        if (triangulate(&r->there, a->rays[m->a], b->rays[m->b], 1e-6, &depth_a, &depth_b)) {
            if (a->depth[m->a] > 0) {
                ratios[count++] = a->depth[m->a] / depth_a;
            }
            if (b->depth[m->b] > 0) {
                ratios[count++] = b->depth[m->b] / depth_b;
            }
        }
    }
    if (count >= SHARED_LEAST) {
        qsort(ratios, count, sizeof *ratios, ascending);
        scale = ratios[count / 2];
    }
    free(ratios);
    return scale;
}

static void keep_depth(pose_view *view, uint32_t feature, double depth)
{
    if (!view->measured && view->features.depth[feature] == 0) {
        view->features.depth[feature] = depth;
    }
}

/* Keeps the depths where rays meet well, for views that came without: a third view gets its scale from them. */
static void keep_depths(pose_view *a, pose_view *b, const relative_pose *r)
{
    for (uint32_t i = 0; i < r->count; i++) {
        const pose_match *m = &r->matches[i];
        double depth_a, depth_b;
        if (triangulate(&r->there, a->features.rays[m->a], b->features.rays[m->b], PARALLAX, &depth_a, &depth_b)) {
            keep_depth(a, m->a, depth_a);
            keep_depth(b, m->b, depth_b);
        }
    }
}

/* ---- joining ---------------------------------------------------------------------------------------------------- */

/* By depth where enough matches have it in both views. */
static int relate(const pose_view *views, const edge *e, poses_source source, relative_pose *out, char *error)
{
    const pose_view *a = &views[e->a], *b = &views[e->b];
    uint32_t deep = 0;
    for (uint32_t i = 0; i < e->count && a->measured && b->measured; i++) {
        deep += a->features.depth[e->matches[i].a] > 0 && b->features.depth[e->matches[i].b] > 0;
    }
    *out = (relative_pose){.matches = malloc((e->count + 1) * sizeof *out->matches)};
    if (out->matches == NULL) {
        return t3r_reason(error, POSES_WHY_BYTES, "out of memory");
    }
    return a->module->relate(&a->features, &b->features, e->matches, e->count,
                             source != POSES_ESTIMATE_COLOUR && deep >= DEEP_LEAST, out, error, POSES_WHY_BYTES);
}

/* Gives the pair's unposed view its pose. *scaled: whether lengths have a unit already. */
static int join(pose_view *views, edge *e, poses_source source, bool *scaled, bool *posed, rigid *poses,
                pose_account *accounts)
{
    relative_pose r;
    int status = relate(views, e, source, &r, e->why);
    double scale = 1;
    if (status == 0 && !r.metric) {
        scale = scale_by_depth(&views[e->a].features, &views[e->b].features, &r);
        if (scale == 0 && *scaled) {
            e->unscaled = true;
            status =
                t3r_reason(e->why, POSES_WHY_BYTES, "too few features in common with a third view to tell the scale");
        }
        scale = scale == 0 ? 1 : scale;
    }
    if (status == 0) {
        *scaled = true;
        for (int i = 0; i < 3; i++) {
            r.there.position[i] *= scale;
        }
        keep_depths(&views[e->a], &views[e->b], &r);
        uint32_t known = posed[e->a] ? e->a : e->b, next = posed[e->a] ? e->b : e->a;
        rigid back = posed[e->a] ? rigid_inverse(&r.there) : r.there; /* next camera to the known one */
        poses[next] = rigid_compose(&poses[known], &back);
        posed[next] = true;
        accounts[next] = (pose_account){.from = known,
                                        .matches = r.count,
                                        .tried = e->count,
                                        .metric = r.metric,
                                        .pixels = r.pixels,
                                        .turn_degrees = r.turn_degrees,
                                        .direction_degrees = r.direction_degrees};
    }
    free(r.matches);
    return status;
}

/* All views that can be joined to `start`. How many have their pose, itself among them. */
static uint32_t join_to(uint32_t start, pose_view *views, uint32_t count, poses_source source, graph *g, bool *posed,
                        rigid *poses, pose_account *accounts)
{
    bool scaled = false;
    uint32_t done = 1;
    posed[start] = true;
    poses[start] = rigid_identity;
    accounts[start] = (pose_account){.from = start};
    edge *e;
    while (done < count && (e = best_edge(g, posed)) != NULL) {
        cli_progress("estimating poses", done, count);
        if (join(views, e, source, &scaled, posed, poses, accounts) == 0) {
            done++;
            for (uint32_t i = 0; i < g->count; i++) {
                g->edges[i].refused = g->edges[i].refused && !g->edges[i].unscaled;
                g->edges[i].unscaled = false;
            }
        } else {
            e->refused = true;
        }
    }
    cli_progress_end();
    return done;
}

/* Why the most promising pair of a view without a pose gave none. */
static pose_account account_for(const graph *g, uint32_t left)
{
    const edge *best = NULL;
    pose_account out = {.from = left, .why = "no frame near it in order has a pose"};
    for (uint32_t i = 0; i < g->count; i++) {
        const edge *e = &g->edges[i];
        if ((e->a == left || e->b == left) && e->why[0] != '\0' && (best == NULL || e->count > best->count)) {
            best = e;
        }
    }
    if (best != NULL) {
        out.from = best->a == left ? best->b : best->a;
        memcpy(out.why, best->why, sizeof out.why);
    }
    return out;
}

/* A view to which none can be joined has no pose, either, and the next one is tried. Each pair is refused once at the
 * most, so this takes no longer than a graph whose views are all joined. */
static int join_all(pose_view *views, uint32_t count, poses_source source, const uint32_t *names, graph *g, bool *posed,
                    rigid *poses, pose_account *accounts, char *error, size_t error_bytes)
{
    uint32_t done = 0;
    for (uint32_t start = 0; start < count && done < 2; start++) {
        done = join_to(start, views, count, source, g, posed, poses, accounts);
        posed[start] = done > 1 || count == 1;
    }
    for (uint32_t i = 0; i < count; i++) {
        if (!posed[i]) {
            poses[i] = rigid_identity;
            accounts[i] = account_for(g, i);
        }
    }
    return done > 1 || count == 1 ? 0 : pose_refusal(accounts, 1, names, error, error_bytes);
}

int pose_refusal(const pose_account *accounts, uint32_t index, const uint32_t *names, char *text, size_t bytes)
{
    const pose_account *a = &accounts[index];
    const uint32_t name = names != NULL ? names[index] : index, other = names != NULL ? names[a->from] : a->from;
    return a->from == index
               ? t3r_reason(text, bytes, "frame %u cannot be posed: %s", name, a->why)
               : t3r_reason(text, bytes, "frame %u cannot be posed from frame %u: %s", name, other, a->why);
}

uint32_t poses_find(const pose_account *accounts, uint32_t from, uint32_t count, bool posed)
{
    while (from < count && (accounts[from].why[0] == '\0') != posed) {
        from++;
    }
    return from;
}

int poses_check_count(uint32_t count, char *error, size_t error_bytes)
{
    if (count > POSES_MOST) {
        return t3r_reason(error, error_bytes, "poses of %u frames: more than %u are not estimated at once", count,
                          POSES_MOST);
    }
    return 0;
}

int poses_estimate(pose_view *views, uint32_t count, poses_source source, const uint32_t *names, rigid *poses,
                   pose_account *accounts, char *error, size_t error_bytes)
{
    if (poses_check_count(count, error, error_bytes) != 0) {
        return -1;
    }
    graph g = {0};
    bool *posed = calloc(count, sizeof *posed);
    int status = posed != NULL ? graph_make(views, count, &g, error, error_bytes)
                               : t3r_reason(error, error_bytes, "out of memory");
    if (status == 0) {
        status = join_all(views, count, source, names, &g, posed, poses, accounts, error, error_bytes);
    }
    graph_free(&g);
    free(posed);
    return status;
}

/* ---- quantizing ------------------------------------------------------------------------------------------------- */

int pose_store(const rigid *pose, const t3r_camera *first, t3r_camera *camera)
{
    rigid axes = rigid_identity;
    for (int i = 0; i < 4; i++) {
        axes.rotation[i] = ldexp(first->rotation_q30[i], -30);
    }
    quaternion_normalise(axes.rotation);
    const rigid world = rigid_compose(&axes, pose);
    for (int i = 0; i < 3; i++) {
        double moved = ldexp(world.position[i], 32), limit = ldexp(1, 61);
        if (!(fabs(moved) < limit && llabs(first->position_q32[i]) < (INT64_C(1) << 61))) {
            return -1;
        }
        camera->position_q32[i] = first->position_q32[i] + llrint(moved);
    }
    for (int i = 0; i < 4; i++) {
        camera->rotation_q30[i] = (int32_t)lrint(ldexp(world.rotation[i], 30));
    }
    return 0;
}
