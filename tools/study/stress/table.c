/* SPDX-License-Identifier: Apache-2.0 */
#include "study/stress/table.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const struct {
    const char *name;
    int decimals;
} values[STRESS_VALUE_COUNT] = {
    [STRESS_BUDGET] = {"budget", 0},
    [STRESS_GAUSSIANS] = {"gaussians", 0},
    [STRESS_PSNR] = {"psnr", 4},
    [STRESS_SSIM] = {"ssim", 5},
    [STRESS_HOLES] = {"holes", 5},
    [STRESS_PERCEPTUAL] = {"perceptual", 5},
    [STRESS_PSNR_UNPRUNED] = {"psnr_unpruned", 4},
    [STRESS_PSNR_LOST] = {"psnr_lost", 4},
    [STRESS_SSIM_LOST] = {"ssim_lost", 5},
    [STRESS_FLICKER] = {"flicker", 4},
    [STRESS_FLICKER_UNPRUNED] = {"flicker_unpruned", 4},
    [STRESS_MASK_CHANGED] = {"mask_changed", 5},
    [STRESS_MOTION] = {"motion", 5},
    [STRESS_BUILD_MS] = {"build_ms", 2},
    [STRESS_BUILD_RATIO] = {"build_ratio", 3},
    [STRESS_ARENA_BYTES] = {"arena_bytes", 0},
};

static const char *const statuses[] = {
    [STRESS_MEASURED] = "measured", [STRESS_REFUSED] = "refused", [STRESS_BROKEN] = "broken"};
static const char *const names[] = {"scene", "context", "target", "perturbation", "strength",
                                    "unit",  "method",  "keep",   "status",       "reason"};
enum { NAMES = sizeof names / sizeof *names };

/* Writes the cells that are not values, in the order of `names`. */
static void describe(const stress_row *row, uint32_t column, char *text, size_t bytes)
{
    char strength[32], keep[32];
    snprintf(strength, sizeof strength, row->grade == 0 ? "0" : "%.10g", row->strength);
    snprintf(keep, sizeof keep, "%.10g", row->keep);
    const char *const cells[NAMES] = {
        row->scene,        row->context, row->target,           row->what,  strength, row->unit,
        row->method->name, keep,         statuses[row->status], row->reason};
    snprintf(text, bytes, "%s", cells[column]);
}

void stress_csv_header(csv_table *table)
{
    for (uint32_t i = 0; i < NAMES; i++) {
        csv_cell(table, names[i]);
    }
    for (int v = 0; v < STRESS_VALUE_COUNT; v++) {
        csv_cell(table, values[v].name);
    }
    csv_end_row(table);
}

void stress_csv_row(csv_table *table, const stress_row *row)
{
    char text[256];
    for (uint32_t i = 0; i < NAMES; i++) {
        describe(row, i, text, sizeof text);
        csv_cell(table, text);
    }
    for (int v = 0; v < STRESS_VALUE_COUNT; v++) {
        snprintf(text, sizeof text, "%.*f", values[v].decimals, row->value[v]);
        csv_cell(table, isnan(row->value[v]) ? "" : text);
    }
    csv_end_row(table);
}

cJSON *stress_json(const stress_row *row)
{
    cJSON *object = cJSON_CreateObject();
    char text[256];
    for (uint32_t i = 0; i < NAMES && object != NULL; i++) {
        describe(row, i, text, sizeof text);
        if (strcmp(names[i], "strength") == 0 || strcmp(names[i], "keep") == 0) {
            cJSON_AddNumberToObject(object, names[i], names[i][0] == 'k' ? row->keep : row->strength);
        } else {
            cJSON_AddStringToObject(object, names[i], text);
        }
    }
    for (int v = 0; v < STRESS_VALUE_COUNT && object != NULL; v++) {
        if (isnan(row->value[v])) {
            cJSON_AddNullToObject(object, values[v].name);
        } else {
            double scale = pow(10, values[v].decimals);
            cJSON_AddNumberToObject(object, values[v].name, round(row->value[v] * scale) / scale);
        }
    }
    return object;
}

static bool same_cell(const stress_row *a, const stress_row *b)
{
    return strcmp(a->what, b->what) == 0 && a->grade == b->grade;
}

double stress_mean(const stress_row *rows, uint32_t count, const stress_row *like, stress_value value,
                   uint32_t *refused)
{
    double sum = 0;
    uint32_t summed = 0;
    if (refused != NULL) {
        *refused = 0;
    }
    for (uint32_t i = 0; i < count; i++) {
        if (!same_cell(&rows[i], like) || rows[i].method != like->method || rows[i].keep != like->keep) {
            continue;
        }
        if (refused != NULL) {
            *refused += rows[i].status == STRESS_REFUSED;
        }
        if (!isnan(rows[i].value[value])) {
            sum += rows[i].value[value];
            summed++;
        }
    }
    return summed == 0 ? NAN : sum / summed;
}

/* Columns of a line; the unperturbed line of a loss shows the reference value. */
static const struct {
    const char *heading;
    stress_value value, unperturbed;
    double scale;
    int decimals;
} measures[] = {
    {"PSNR lost, dB; unperturbed: PSNR", STRESS_PSNR_LOST, STRESS_PSNR, 1, 2},
    {"SSIM lost; unperturbed: SSIM", STRESS_SSIM_LOST, STRESS_SSIM, 1, 3},
    {"holes, % of the mask", STRESS_HOLES, STRESS_HOLES, 100, 1},
    {"flicker of a still scene, 8-bit levels", STRESS_FLICKER, STRESS_FLICKER, 1, 2},
};
enum { MEASURES = sizeof measures / sizeof *measures };

void stress_strength(const stress_row *row, char *text, size_t bytes)
{
    if (row->grade == 0) {
        text[0] = '\0';
    } else if (strcmp(row->unit, "10^") == 0) {
        snprintf(text, bytes, "10^%.10g", row->strength);
    } else {
        snprintf(text, bytes, "%.10g %s", row->strength, row->unit);
    }
}

static int column_width(const method *m)
{
    int length = (int)strlen(m->name) + 2;
    return length < 10 ? 10 : length;
}

static void print_cell(FILE *out, const stress_row *rows, uint32_t count, const stress_row *like, uint32_t measure)
{
    stress_value value = like->grade == 0 ? measures[measure].unperturbed : measures[measure].value;
    uint32_t refused;
    double mean = stress_mean(rows, count, like, value, &refused);
    char text[32] = "-";
    if (!isnan(mean)) {
        snprintf(text, sizeof text, "%.*f%s", measures[measure].decimals, mean * measures[measure].scale,
                 refused > 0 ? "*" : "");
    } else if (refused > 0) {
        snprintf(text, sizeof text, "refused");
    }
    fprintf(out, "%*s", column_width(like->method), text);
}

static void print_table(FILE *out, const stress_row *rows, uint32_t count, const stress_contest *contest, uint32_t keep,
                        uint32_t measure)
{
    char strength[32];
    fprintf(out, "%.10g %% kept: %s\n%-18s%-12s", contest->keep[keep], measures[measure].heading, "perturbation",
            "strength");
    for (uint32_t m = 0; m < contest->method_count; m++) {
        fprintf(out, "%*s", column_width(contest->methods[m]), contest->methods[m]->name);
    }
    fputc('\n', out);
    for (uint32_t i = 0; i < count; i++) {
        bool seen = false;
        for (uint32_t earlier = 0; earlier < i && !seen; earlier++) {
            seen = same_cell(&rows[earlier], &rows[i]);
        }
        if (seen) {
            continue;
        }
        stress_row like = rows[i];
        like.keep = contest->keep[keep];
        stress_strength(&like, strength, sizeof strength);
        fprintf(out, "%-18s%-12s", like.what, strength);
        for (uint32_t m = 0; m < contest->method_count; m++) {
            like.method = contest->methods[m];
            print_cell(out, rows, count, &like, measure);
        }
        fputc('\n', out);
    }
    fputc('\n', out);
}

void stress_print_tables(FILE *out, const stress_row *rows, uint32_t count, const stress_contest *contest)
{
    for (uint32_t k = 0; k < contest->keep_count; k++) {
        for (uint32_t m = 0; m < MEASURES; m++) {
            if (m != MEASURES - 1 || contest->captures > 1) {
                print_table(out, rows, count, contest, k, m);
            }
        }
    }
}
