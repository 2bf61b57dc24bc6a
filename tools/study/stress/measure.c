/* SPDX-License-Identifier: Apache-2.0 */
#include "study/stress/measure.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/cli.h"
#include "core/fixed.h"
#include "study/stress/invariant.h"
#include "study/stress/stability.h"

#define NO_MEMORY "out of memory"

/* Working data for measuring the rows of a cell. */
typedef struct cell {
    const stress_case *c;
    const stress_contest *contest;
    const perturbation *p;
    double strength;
    stress_row *rows;
    uint8_t *renders;    /* of the scored pictures, one per row */
    uint8_t *now, *last; /* for flicker: one per row, and one of all points, of this and the previous capture */
    double change;       /* of all points, summed over pairs of captures */
    uint32_t changes;
    double all[2]; /* PSNR and SSIM of all points; NaN until measured */
} cell;

static size_t picture_bytes(const cell *it)
{
    return (size_t)it->c->views.width * it->c->views.height * 3;
}

static void set_status(stress_row *row, stress_status status, const char *reason)
{
    if (row->status != STRESS_BROKEN) { /* the first broken invariant is reported */
        row->status = status;
        snprintf(row->reason, sizeof row->reason, "%s", reason);
    }
}

/* Counts a refusal as a broken invariant if the arena suffices only for the unperturbed frames. Returns an error if
 * the host is out of memory. */
static int refuse(const cell *it, stress_row *row, int code, const char *reason)
{
    if (strcmp(reason, NO_MEMORY) == 0) {
        return code;
    }
    set_status(row, code == CLI_BUDGET_TOO_SMALL && it->p != NULL ? STRESS_BROKEN : STRESS_REFUSED, reason);
    return CLI_OK;
}

/* Returns the mean over the mask and the channels. */
static double mean_change(const uint8_t *a, const uint8_t *b, const uint8_t *mask, size_t pixels)
{
    uint64_t sum = 0, count = 0;
    for (size_t i = 0; i < pixels * 3; i++) {
        if (mask[i / 3] != 0) {
            sum += (uint64_t)abs(a[i] - b[i]);
            count++;
        }
    }
    return count == 0 ? NAN : (double)sum / (double)count;
}

static void take_scores(stress_row *row, const evaluation_row *scores)
{
    row->value[STRESS_PSNR] = scores->value[EVALUATION_PSNR];
    row->value[STRESS_SSIM] = scores->value[EVALUATION_SSIM];
    row->value[STRESS_HOLES] = scores->value[EVALUATION_HOLES];
    row->value[STRESS_PERCEPTUAL] = scores->value[EVALUATION_PERCEPTUAL];
    if (!isfinite(row->value[STRESS_PSNR]) || !isfinite(row->value[STRESS_SSIM])) {
        set_status(row, STRESS_BROKEN, "the render has no finite score");
    }
}

/* Builds and checks a row; scores it in capture 0, otherwise only draws it. */
static int measure_row(const cell *it, stress_run *run, uint32_t keep, uint32_t index, uint32_t capture)
{
    stress_row *row = &it->rows[index];
    reconstruction_options options = stress_run_options(run, it->c, it->contest, keep);
    options.method = row->method;
    reconstruction built;
    reconstruction_account account;
    char reason[STRESS_REASON_BYTES] = "";
    cli_keep_errors(reason, sizeof reason);
    int code = stress_run_build(run, &options, &built, &account);
    cli_keep_errors(NULL, 0);
    if (code != CLI_OK) {
        return refuse(it, row, code, reason);
    }
    const bool stereo = options.config.depth == T3R_DEPTH_STEREO;
    uint32_t valid = stereo ? account.valid_points : stress_capture_valid(&run->capture);
    uint32_t expected = T3R_MIN(options.gaussians, valid);
    const char *broken = stress_broken_invariant(&built.scene, expected, reconstruction_chooses(&options));
    if (broken != NULL) {
        set_status(row, STRESS_BROKEN, broken);
    }
    double ms = account.seconds * 1000;
    row->value[STRESS_BUILD_MS] = capture == 0 ? ms : fmin(ms, row->value[STRESS_BUILD_MS]);
    cli_keep_errors(reason, sizeof reason);
    if (capture == 0) {
        row->value[STRESS_GAUSSIANS] = built.scene.count;
        row->value[STRESS_ARENA_BYTES] = (double)account.arena_bytes;
        evaluation_row scores = {0};
        code =
            evaluation_score(&scores, it->renders + index * picture_bytes(it), &run->views, &run->what, &built, NULL);
        if (code == CLI_OK) {
            take_scores(row, &scores);
        }
    } else {
        code =
            evaluation_draw(&built, &run->views.target.camera, &run->views, it->now + index * picture_bytes(it), NULL);
    }
    cli_keep_errors(NULL, 0);
    reconstruction_close(&built);
    return code == CLI_OK ? CLI_OK : refuse(it, row, code, reason);
}

/* Measures all points, the rivals' input; a refusal leaves the figures empty. */
static int measure_all_points(cell *it, stress_run *run, uint32_t capture)
{
    reconstruction_options options = stress_run_options(run, it->c, it->contest, it->contest->keep_count);
    options.method = RIVAL_METHOD(METHOD_RANDOM, METHOD_PLAIN);
    uint8_t *render = it->now + stress_row_count(it->contest) * picture_bytes(it);
    reconstruction built;
    reconstruction_account account;
    char reason[STRESS_REASON_BYTES] = "";
    cli_keep_errors(reason, sizeof reason);
    int code = stress_run_build(run, &options, &built, &account);
    if (code == CLI_OK) {
        evaluation_row scores = {0};
        code = capture == 0 ? evaluation_score(&scores, render, &run->views, &run->what, &built, NULL)
                            : evaluation_draw(&built, &run->views.target.camera, &run->views, render, NULL);
        it->all[0] = capture == 0 ? scores.value[EVALUATION_PSNR] : it->all[0];
        it->all[1] = capture == 0 ? scores.value[EVALUATION_SSIM] : it->all[1];
        reconstruction_close(&built);
    }
    cli_keep_errors(NULL, 0);
    return code != CLI_OK && strcmp(reason, NO_MEMORY) == 0 ? code : CLI_OK;
}

/* Adds the changes since the previous capture. */
static void add_changes(cell *it, uint32_t capture)
{
    uint32_t rows = stress_row_count(it->contest);
    size_t bytes = picture_bytes(it);
    const uint8_t *mask = it->c->views.target.mask;
    for (uint32_t i = 0; i <= rows && capture > 1; i++) {
        double change = mean_change(it->last + i * bytes, it->now + i * bytes, mask, bytes / 3);
        if (i == rows) {
            it->change += change;
            it->changes++;
        } else {
            double *flicker = &it->rows[i].value[STRESS_FLICKER];
            *flicker = (isnan(*flicker) ? 0 : *flicker) + change;
        }
    }
    memcpy(it->last, it->now, (rows + 1) * bytes);
}

static int measure_capture(cell *it, uint32_t capture)
{
    const stress_contest *contest = it->contest;
    uint32_t rows = stress_row_count(contest);
    stress_run run;
    char reason[STRESS_REASON_BYTES] = "";
    cli_keep_errors(reason, sizeof reason);
    int code = stress_run_open(&run, it->c, contest, it->p, it->strength, capture);
    cli_keep_errors(NULL, 0);
    if (code != CLI_OK) {
        int kept = CLI_OK;
        for (uint32_t i = 0; i < rows; i++) {
            kept = refuse(it, &it->rows[i], code, reason);
        }
        stress_run_close(&run);
        return kept;
    }
    code = measure_all_points(it, &run, capture);
    for (uint32_t i = 0; i < rows && code == CLI_OK; i++) {
        if (it->rows[i].status == STRESS_MEASURED) {
            code = measure_row(it, &run, i / contest->method_count, i, capture);
        }
    }
    stress_run_close(&run);
    return code;
}

static void name_rows(const cell *it, uint32_t grade)
{
    const stress_contest *contest = it->contest;
    for (uint32_t i = 0; i < stress_row_count(contest); i++) {
        stress_row *row = &it->rows[i];
        *row = (stress_row){.what = it->p == NULL ? STRESS_UNPERTURBED : it->p->name,
                            .unit = it->p == NULL ? "" : it->p->unit,
                            .strength = it->strength,
                            .grade = grade,
                            .method = contest->methods[i % contest->method_count],
                            .keep = contest->keep[i / contest->method_count]};
        snprintf(row->scene, sizeof row->scene, "%s", it->c->name);
        snprintf(row->context, sizeof row->context, "%s", it->c->context);
        snprintf(row->target, sizeof row->target, "%s", it->c->target);
        for (int v = 0; v < STRESS_VALUE_COUNT; v++) {
            row->value[v] = NAN;
        }
        row->value[STRESS_BUDGET] = it->c->budget[i / contest->method_count];
    }
}

/* Turns sums into means and computes losses against all points; unmeasured rows stay empty. */
static void finish_rows(const cell *it)
{
    for (uint32_t i = 0; i < stress_row_count(it->contest); i++) {
        double *value = it->rows[i].value;
        value[STRESS_FLICKER] /= it->changes == 0 ? 1 : it->changes;
        value[STRESS_FLICKER_UNPRUNED] = it->changes == 0 ? NAN : it->change / it->changes;
        value[STRESS_PSNR_UNPRUNED] = it->all[0];
        value[STRESS_PSNR_LOST] = it->all[0] - value[STRESS_PSNR];
        value[STRESS_SSIM_LOST] = it->all[1] - value[STRESS_SSIM];
        for (int v = 0; v < STRESS_VALUE_COUNT && it->rows[i].status == STRESS_REFUSED; v++) {
            value[v] = v == STRESS_BUDGET ? value[v] : NAN;
        }
    }
}

static int measure(cell *it)
{
    int code = CLI_OK;
    for (uint32_t capture = 0; capture <= it->contest->captures && code == CLI_OK; capture++) {
        code = measure_capture(it, capture);
        if (code == CLI_OK && capture > 0) {
            add_changes(it, capture);
        }
    }
    if (code == CLI_OK && it->p == NULL && it->contest->captures > 1) {
        code = stress_stability(it->rows, it->c, it->contest);
    }
    finish_rows(it);
    return code;
}

int stress_measure(stress_row *rows, uint8_t *renders, const stress_case *c, const stress_contest *contest,
                   const perturbation *p, uint32_t grade)
{
    cell it = {.c = c,
               .contest = contest,
               .p = p,
               .strength = p == NULL ? 0 : p->strength[grade - 1],
               .rows = rows,
               .renders = renders,
               .all = {NAN, NAN}};
    size_t bytes = (stress_row_count(contest) + 1) * picture_bytes(&it);
    name_rows(&it, grade);
    memset(renders, 0, bytes - picture_bytes(&it));
    it.now = calloc(bytes, 1);
    it.last = calloc(bytes, 1);
    int code = it.now == NULL || it.last == NULL ? cli_error(CLI_BAD_INPUT, NO_MEMORY) : measure(&it);
    free(it.now);
    free(it.last);
    return code;
}

void stress_relate(stress_row *rows, const stress_row *unperturbed, uint32_t count, bool automatic)
{
    for (uint32_t i = 0; i < count; i++) {
        double *value = rows[i].value;
        const double *base = unperturbed[i].value;
        value[STRESS_PSNR_LOST] = base[STRESS_PSNR] - value[STRESS_PSNR];
        value[STRESS_SSIM_LOST] = base[STRESS_SSIM] - value[STRESS_SSIM];
        value[STRESS_BUILD_RATIO] = value[STRESS_BUILD_MS] / base[STRESS_BUILD_MS];
        /* a rival's value covers all points, however many there are */
        bool ours = method_kind_of(rows[i].method) == METHOD_TRIM3R && !automatic;
        bool fewer = value[STRESS_GAUSSIANS] < base[STRESS_GAUSSIANS];
        if (ours && (value[STRESS_ARENA_BYTES] > base[STRESS_ARENA_BYTES] ||
                     (!fewer && value[STRESS_ARENA_BYTES] < base[STRESS_ARENA_BYTES]))) {
            set_status(&rows[i], STRESS_BROKEN, "the arena's size has changed");
        }
    }
}
