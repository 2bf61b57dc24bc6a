/* SPDX-License-Identifier: Apache-2.0 */
/* The table of `trim3r eval --ablate`. */
#include "study/ablation/ablation.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "evaluation/table.h"

typedef enum part { SCENE, ABLATION, BUDGET } part;

static bool alike(const evaluation_row *a, const evaluation_row *b, part p)
{
    return p == SCENE      ? strcmp(a->scene, b->scene) == 0
           : p == ABLATION ? strcmp(a->ablation, b->ablation) == 0
                           : evaluation_same_budget(a, b);
}

/* Whether this row is the first with its scene, ablation or budget. */
static bool is_first(const evaluation_row *rows, uint32_t index, part p)
{
    for (uint32_t i = 0; i < index; i++) {
        if (alike(&rows[i], &rows[index], p)) {
            return false;
        }
    }
    return true;
}

static void print_cell(FILE *out, const evaluation_row *rows, uint32_t count, const evaluation_row *line,
                       const evaluation_row *column, bool planar)
{
    for (uint32_t i = 0; i < count; i++) {
        if (alike(&rows[i], line, SCENE) && alike(&rows[i], line, ABLATION) && alike(&rows[i], column, BUDGET)) {
            double psnr = rows[i].value[planar ? EVALUATION_PLANAR_PSNR : EVALUATION_PSNR];
            fprintf(out, " %.2f / %.3f |", psnr, rows[i].value[EVALUATION_SSIM]);
            return;
        }
    }
    fprintf(out, " %13s |", "");
}

/* Prints the lines of one scene; its name is in the first. */
static void print_scene(FILE *out, const evaluation_row *rows, uint32_t count, const evaluation_row *scene, bool planar)
{
    const char *name = scene->scene;
    for (uint32_t i = 0; i < count; i++) {
        if (!is_first(rows, i, ABLATION)) {
            continue;
        }
        evaluation_row line = rows[i];
        memcpy(line.scene, scene->scene, sizeof line.scene);
        fprintf(out, "| %-26s | %-21s |", name, line.ablation);
        name = "";
        for (uint32_t k = 0; k < count; k++) {
            if (is_first(rows, k, BUDGET)) {
                print_cell(out, rows, count, &line, &rows[k], planar);
            }
        }
        fputc('\n', out);
    }
}

static uint32_t print_scenes(FILE *out, const evaluation_row *rows, uint32_t count, bool planar)
{
    uint32_t scenes = 0;
    for (uint32_t i = 0; i < count; i++) {
        if (is_first(rows, i, SCENE)) {
            print_scene(out, rows, count, &rows[i], planar);
            scenes++;
        }
    }
    return scenes;
}

bool ablation_table(FILE *out, const evaluation_row *means, uint32_t count, bool planar)
{
    evaluation_row *over_scenes = calloc(count, sizeof *over_scenes);
    if (over_scenes == NULL) {
        return false;
    }
    fprintf(out, "| %-26s | %-21s |", "scene", "ablation");
    for (uint32_t i = 0; i < count; i++) {
        if (is_first(means, i, BUDGET)) {
            const double requested = means[i].value[EVALUATION_REQUESTED];
            fprintf(out, isnan(requested) ? " %11.10g %% |" : " %13.10g |",
                    isnan(requested) ? means[i].value[EVALUATION_KEEP] : requested);
        }
    }
    fprintf(out, "\n|---|---|");
    for (uint32_t i = 0; i < count; i++) {
        fputs(is_first(means, i, BUDGET) ? "---|" : "", out);
    }
    fputc('\n', out);
    if (print_scenes(out, means, count, planar) > 1) {
        uint32_t mean_count = evaluation_means(means, count, false, over_scenes);
        (void)print_scenes(out, over_scenes, mean_count, planar);
    }
    free(over_scenes);
    return true;
}
