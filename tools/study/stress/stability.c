/* SPDX-License-Identifier: Apache-2.0 */
#include "study/stress/stability.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "budget/budget.h"
#include "cli/cli.h"
#include "scene/scene_file.h"
#include "state/state.h"
#include "state/views.h"
#include "study/rivals/source.h"

#define NOBODY UINT32_MAX
/* Median of the absolute difference of two normal numbers, in their deviation: 0.6745 sqrt(2) */
#define MEDIAN_DIFFERENCE 0.9539

/* A scene indexed by the pixels of its Gaussians. */
typedef struct snapshot {
    uint32_t *owner; /* views x pixels: the Gaussian, or NOBODY */
    double (*at)[3]; /* per Gaussian, world units from the frame's origin */
    double *spacing; /* between retained pixels around the Gaussian, world units */
    uint32_t count;
} snapshot;

static void snapshot_free(snapshot *s)
{
    free(s->owner);
    free(s->at);
    free(s->spacing);
    *s = (snapshot){0};
}

/* Assigns pixels to Gaussians, which are in the order of views and rows. kept: ascending indices of the retained
 * Gaussians to assign; NULL: all. */
static void fill_owners(snapshot *s, const t3r_runtime *rt, const uint32_t *kept)
{
    t3r_view views[T3R_MAX_VIEWS];
    t3r_views_of(rt, views);
    size_t pixels = (size_t)rt->config.width * rt->config.height;
    uint32_t retained = 0, next = 0;
    for (uint32_t v = 0; v < rt->views; v++) {
        for (size_t i = 0; i < pixels; i++) {
            uint32_t *owner = &s->owner[v * pixels + i];
            *owner = NOBODY;
            if (!t3r_retained(&views[v], i)) {
                continue;
            }
            if (next < s->count && (kept == NULL || kept[next] == retained)) {
                *owner = next++;
            }
            retained++;
        }
    }
}

/* Returns the mean distance between retained pixels, in pixels. */
static double spacing_of(const stress_capture *capture, double gaussians)
{
    return sqrt((double)capture->width * capture->height * capture->views / fmax(gaussians, 1));
}

static bool fill_places(snapshot *s, const t3r_scene *scene, const stress_run *run)
{
    s->at = malloc(((size_t)s->count + 1) * sizeof *s->at);
    s->spacing = malloc(((size_t)s->count + 1) * sizeof *s->spacing);
    double spacing = spacing_of(&run->capture, s->count);
    for (uint32_t g = 0; g < s->count && s->at != NULL && s->spacing != NULL; g++) {
        double squared = 0;
        for (int i = 0; i < 3; i++) {
            s->at[g][i] = ldexp(scene->gaussians[g].position_q20[i], scene->frame.exponent - 20);
            double camera = run->capture.view[scene->gaussians[g].view].camera.position[i] -
                            ldexp((double)scene->frame.origin_q32[i], -32);
            squared += (s->at[g][i] - camera) * (s->at[g][i] - camera);
        }
        s->spacing[g] = sqrt(squared) * spacing / run->capture.view[scene->gaussians[g].view].camera.fx;
    }
    return s->at != NULL && s->spacing != NULL;
}

/* Fills in trim3r's scene before fine-tuning. */
static int fill_untuned(snapshot *s, const stress_run *run, const reconstruction_options *options)
{
    reconstruction plain;
    int code = reconstruction_build(&plain, run->recording, run->what.path, options);
    if (code == CLI_OK) {
        fill_owners(s, plain.runtime, NULL);
        reconstruction_close(&plain);
    }
    return code;
}

static int take(snapshot *s, const stress_row *row, const stress_case *c, stress_run *run,
                const reconstruction_options *options)
{
    reconstruction built;
    reconstruction_account account;
    int code = stress_run_build(run, options, &built, &account);
    if (code != CLI_OK) {
        return code;
    }
    s->count = scene_surfaces(built.scene.gaussians, built.scene.count);
    s->owner = malloc((size_t)c->base.views * c->base.width * c->base.height * sizeof *s->owner);
    bool done = s->owner != NULL && fill_places(s, &built.scene, run);
    if (done && method_kind_of(row->method) != METHOD_TRIM3R) {
        const rival_source *source = run->views.source.made;
        fill_owners(s, source->whole.runtime, source->kept);
    } else if (done && row->method == &method_trim3r) {
        fill_owners(s, built.runtime, NULL);
    } else if (done) {
        code = fill_untuned(s, run, options);
    }
    reconstruction_close(&built);
    return done ? code : cli_error(CLI_BAD_INPUT, "out of memory");
}

static int by_value(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Adds the share of a's pixels that b does not retain, and the median motion of the others. False if out of memory. */
static bool compare(stress_row *row, const snapshot *a, const snapshot *b, size_t pixels)
{
    uint32_t stay = 0;
    double *way = malloc(((size_t)a->count + 1) * sizeof *way);
    if (way == NULL) {
        return false;
    }
    for (size_t i = 0; i < pixels; i++) {
        uint32_t from = a->owner[i], to = b->owner[i];
        if (from == NOBODY || to == NOBODY) {
            continue;
        }
        double squared = 0;
        for (int k = 0; k < 3; k++) {
            squared += (a->at[from][k] - b->at[to][k]) * (a->at[from][k] - b->at[to][k]);
        }
        way[stay++] = a->spacing[from] > 0 ? sqrt(squared) / a->spacing[from] : 0;
    }
    row->value[STRESS_MASK_CHANGED] += 1 - (double)stay / (a->count == 0 ? 1 : a->count);
    qsort(way, stay, sizeof *way, by_value);
    row->value[STRESS_MOTION] += stay == 0 ? 0 : way[stay / 2];
    free(way);
    return true;
}

double stress_mask_changed_most(double gaussians, uint32_t clusters)
{
    return fmin(STRESS_MASK_CHANGED_MOST, STRESS_MASK_CHANGED_ONE / sqrt(gaussians / clusters));
}

double stress_motion_most(double noise)
{
    return STRESS_MOTION_MOST + noise;
}

double stress_still_motion(const stress_capture *capture, double gaussians)
{
    double focal = 0;
    for (uint32_t v = 0; v < capture->views; v++) {
        focal += capture->view[v].camera.fx / capture->views;
    }
    return MEDIAN_DIFFERENCE * STRESS_STILL_DEPTH / 100 * focal / spacing_of(capture, gaussians);
}

void stress_judge_still(stress_row *row, uint32_t clusters, double noise)
{
    double gaussians = row->value[STRESS_GAUSSIANS];
    double changed = stress_mask_changed_most(gaussians, clusters), motion = stress_motion_most(noise);
    if (gaussians >= fmax(clusters, STRESS_JUDGED_LEAST) && row->method == &method_trim3r &&
        !(row->value[STRESS_MASK_CHANGED] <= changed && row->value[STRESS_MOTION] <= motion)) {
        row->status = STRESS_BROKEN;
        snprintf(row->reason, sizeof row->reason,
                 "a still scene does not stay the same: %.1f %% of the mask changes, of at most %.1f; half of the "
                 "Gaussians move by %.0f %% of their spacing and more, of at most %.0f",
                 row->value[STRESS_MASK_CHANGED] * 100, changed * 100, row->value[STRESS_MOTION] * 100, motion * 100);
    }
}

/* Adds capture `capture` of every row, compared with the previous capture. */
static int add_capture(stress_row *rows, snapshot *last, const stress_case *c, const stress_contest *contest,
                       uint32_t capture)
{
    size_t pixels = (size_t)c->base.views * c->base.width * c->base.height;
    stress_run run;
    int code = stress_run_open(&run, c, contest, NULL, 0, capture);
    for (uint32_t i = 0; i < stress_row_count(contest) && code == CLI_OK; i++) {
        if (rows[i].status != STRESS_MEASURED) {
            continue;
        }
        reconstruction_options options = stress_run_options(&run, c, contest, i / contest->method_count);
        options.config.keep_analysis = true; /* the masks must outlive the build */
        options.method = rows[i].method;
        snapshot now = {0};
        code = take(&now, &rows[i], c, &run, &options);
        if (code == CLI_OK && capture > 1 && !compare(&rows[i], &last[i], &now, pixels)) {
            code = cli_error(CLI_BAD_INPUT, "out of memory");
        }
        snapshot_free(&last[i]);
        last[i] = now;
    }
    stress_run_close(&run);
    return code;
}

static uint32_t clusters_judged(const stress_contest *contest)
{
    uint32_t asked = contest->settings.config.clusters;
    return asked > 0 ? asked : STRESS_JUDGED_CLUSTERS;
}

int stress_stability(stress_row *rows, const stress_case *c, const stress_contest *contest)
{
    uint32_t count = stress_row_count(contest);
    snapshot *last = calloc(count, sizeof *last);
    int code = last == NULL ? cli_error(CLI_BAD_INPUT, "out of memory") : CLI_OK;
    for (uint32_t i = 0; i < count; i++) {
        rows[i].value[STRESS_MASK_CHANGED] = rows[i].value[STRESS_MOTION] = rows[i].status == STRESS_MEASURED ? 0 : NAN;
    }
    for (uint32_t capture = 1; capture <= contest->captures && code == CLI_OK; capture++) {
        code = add_capture(rows, last, c, contest, capture);
    }
    for (uint32_t i = 0; i < count && last != NULL; i++) {
        snapshot_free(&last[i]);
        rows[i].value[STRESS_MASK_CHANGED] /= contest->captures - 1;
        rows[i].value[STRESS_MOTION] /= contest->captures - 1;
        if (code == CLI_OK && rows[i].status == STRESS_MEASURED) {
            stress_judge_still(&rows[i], clusters_judged(contest),
                               stress_still_motion(&c->base, rows[i].value[STRESS_GAUSSIANS]));
        }
    }
    free(last);
    return code;
}
