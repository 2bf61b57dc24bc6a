/* SPDX-License-Identifier: Apache-2.0 */
#include "study/stress/verdict.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "study/stress/stability.h"
#include "study/stress/table.h"

#define MIDDLE_GRADE 2u
#define FLICKER_MOST 1.2 /* relative to all points: a goal, not a guarantee */
#define LEVEL 0.01       /* dB: below this, no difference */
#define SLOWER_THAN 1.5  /* times the unperturbed build: slower ones get a line */

uint32_t stress_broken(const stress_row *rows, uint32_t count)
{
    uint32_t broken = 0;
    for (uint32_t i = 0; i < count; i++) {
        broken += rows[i].status == STRESS_BROKEN;
    }
    return broken;
}

static void name_cell(FILE *out, const stress_row *row)
{
    char strength[32];
    stress_strength(row, strength, sizeof strength);
    fprintf(out, "%s: %s%s%s, %s at %.10g %%", row->scene, row->what, row->grade == 0 ? "" : " ", strength,
            row->method->name, row->keep);
}

static void print_invariants(FILE *out, const stress_row *rows, uint32_t count)
{
    uint32_t broken = stress_broken(rows, count), refused = 0;
    for (uint32_t i = 0; i < count; i++) {
        refused += rows[i].status == STRESS_REFUSED;
        if (rows[i].status == STRESS_BROKEN) {
            fputs("BROKEN  ", out);
            name_cell(out, &rows[i]);
            fprintf(out, ": %s\n", rows[i].reason);
        }
    }
    fprintf(
        out, "%u rows: %u measured, %u refused with a reason, %u with a broken invariant (budget, arena, range%s)\n",
        (unsigned)count, (unsigned)(count - refused - broken), (unsigned)refused, (unsigned)broken, ", still scene");
    /* prints each reason once per perturbation and strength */
    for (uint32_t i = 0; i < count; i++) {
        bool reported = rows[i].status != STRESS_REFUSED;
        for (uint32_t earlier = 0; earlier < i && !reported; earlier++) {
            reported = rows[earlier].status == STRESS_REFUSED && strcmp(rows[earlier].what, rows[i].what) == 0 &&
                       rows[earlier].grade == rows[i].grade && strcmp(rows[earlier].reason, rows[i].reason) == 0;
        }
        if (!reported) {
            char strength[32];
            stress_strength(&rows[i], strength, sizeof strength);
            fprintf(out, "refused  %s %s: %s\n", rows[i].what, strength, rows[i].reason);
        }
    }
}

static void print_slowest(FILE *out, const stress_row *rows, uint32_t count)
{
    const stress_row *slowest = NULL;
    for (uint32_t i = 0; i < count; i++) {
        if (!isnan(rows[i].value[STRESS_BUILD_RATIO]) &&
            (slowest == NULL || rows[i].value[STRESS_BUILD_RATIO] > slowest->value[STRESS_BUILD_RATIO])) {
            slowest = &rows[i];
        }
    }
    if (slowest != NULL) {
        fprintf(out, "slowest build against the unperturbed one: x %.2f%s (", slowest->value[STRESS_BUILD_RATIO],
                slowest->value[STRESS_BUILD_RATIO] > SLOWER_THAN ? ", on a machine that may be busy" : "");
        name_cell(out, slowest);
        fputs(")\n", out);
    }
}

static void print_stability(FILE *out, const stress_row *rows, uint32_t count, const stress_contest *contest)
{
    for (uint32_t i = 0; i < stress_row_count(contest) && count > 0 && contest->captures > 1; i++) {
        stress_row like = {.what = STRESS_UNPERTURBED,
                           .method = contest->methods[i % contest->method_count],
                           .keep = contest->keep[i / contest->method_count]};
        double changed = stress_mean(rows, count, &like, STRESS_MASK_CHANGED, NULL);
        double flicker = stress_mean(rows, count, &like, STRESS_FLICKER, NULL);
        double all = stress_mean(rows, count, &like, STRESS_FLICKER_UNPRUNED, NULL);
        if (isnan(changed)) {
            continue;
        }
        fprintf(out,
                "still scene, %s at %.10g %%: flicker %.2f levels, x %.2f that of all points; %.1f %% of the mask "
                "changes; half of the Gaussians move by at most %.1f %% of their spacing",
                like.method->name, like.keep, flicker, flicker / all, changed * 100,
                stress_mean(rows, count, &like, STRESS_MOTION, NULL) * 100);
        fputc('\n', out);
    }
}

/* Prints our flicker relative to all points of the same frames. */
static void print_flicker(FILE *out, const stress_row *rows, uint32_t count, double keep)
{
    const stress_row *worst = NULL;
    double most = 0;
    uint32_t measured = 0, within = 0;
    for (uint32_t i = 0; i < count; i++) {
        double ratio = rows[i].value[STRESS_FLICKER] / rows[i].value[STRESS_FLICKER_UNPRUNED];
        if (rows[i].method != &method_trim3r || rows[i].keep != keep || !isfinite(ratio)) {
            continue;
        }
        measured++;
        within += ratio <= FLICKER_MOST;
        if (worst == NULL || ratio > most) {
            worst = &rows[i];
            most = ratio;
        }
    }
    if (worst != NULL) {
        fprintf(out,
                "flicker at most x %.1f that of all points in %u of %u cells of trim3r at %.10g %%; worst x %.2f (",
                FLICKER_MOST, (unsigned)within, (unsigned)measured, keep, most);
        name_cell(out, worst);
        fputs(")\n", out);
    }
}

/* ---- ours against the best rival --------------------------------------------------------------------------------- */

static const char *const judged[] = {"noise", "exposure", "depth-lattice", "depth-blobs", "depth-all", "pose"};

/* Returns the rival that loses least, and its loss; NULL if there is none. */
static const method *least_loss(const stress_row *rows, uint32_t count, const stress_contest *contest, stress_row like,
                                double *least)
{
    const method *best = NULL;
    for (uint32_t m = 0; m < contest->method_count; m++) {
        like.method = contest->methods[m];
        double lost = stress_mean(rows, count, &like, STRESS_PSNR_LOST, NULL);
        if (method_kind_of(like.method) != METHOD_TRIM3R && !isnan(lost) && (best == NULL || lost < *least)) {
            *least = lost;
            best = like.method;
        }
    }
    return best;
}

static void print_against(FILE *out, const stress_row *rows, uint32_t count, const stress_contest *contest,
                          const char *what, double keep)
{
    stress_row like = {.what = what, .grade = MIDDLE_GRADE, .method = &method_trim3r, .keep = keep};
    stress_row plain = {.what = STRESS_UNPERTURBED, .method = &method_trim3r, .keep = keep};
    double ours = stress_mean(rows, count, &like, STRESS_PSNR_LOST, NULL), least = 0;
    double psnr = stress_mean(rows, count, &like, STRESS_PSNR, NULL);
    double all = stress_mean(rows, count, &plain, STRESS_PSNR_UNPRUNED, NULL) -
                 stress_mean(rows, count, &like, STRESS_PSNR_UNPRUNED, NULL);
    if (isnan(ours)) {
        return;
    }
    fprintf(out, "%s at its middle strength, %.10g %%: trim3r loses %.2f dB to %.2f (all points lose %.2f)", what, keep,
            ours, psnr, all);
    const method *best = least_loss(rows, count, contest, like, &least);
    if (best != NULL) {
        like.method = best;
        double rival = stress_mean(rows, count, &like, STRESS_PSNR, NULL);
        fprintf(out, ", %s %.2f dB to %.2f: %s", best->name, least, rival,
                ours <= least / 2            ? "at most half"
                : fabs(psnr - rival) < LEVEL ? "more than half, and level with it"
                : psnr > rival               ? "more than half, but ahead: what has less to lose loses less"
                                             : "more than half, and behind");
    }
    fputc('\n', out);
}

void stress_print_verdict(FILE *out, const stress_row *rows, uint32_t count, const stress_contest *contest)
{
    print_invariants(out, rows, count);
    print_slowest(out, rows, count);
    print_stability(out, rows, count, contest);
    for (uint32_t k = 0; k < contest->keep_count; k++) {
        print_flicker(out, rows, count, contest->keep[k]);
        for (uint32_t i = 0; i < sizeof judged / sizeof *judged; i++) {
            print_against(out, rows, count, contest, judged[i], contest->keep[k]);
        }
    }
}
