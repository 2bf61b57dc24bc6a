/* SPDX-License-Identifier: Apache-2.0 */
#include "evaluation/table.h"

#include <math.h>
#include <string.h>

#include "cli/tables/csv_read.h"
#include "cli/text/style.h"
#include "host/text.h"

typedef enum shown { NEVER, ALWAYS, RECORDING, PLANAR, GIVEN } shown; /* GIVEN: shown if there is a text */

/* Texts of a row count down from -1. */
enum {
    SCENE = -1,
    CONTEXT = -2,
    TARGET = -3,
    METHOD = -4,
    HEAD = -5,
    BITS = -6,
    REFINE = -7,
    ALLOCATE = -8,
    DEPTH = -9,
    ABLATION = -10,
    WAVELET = -11,
    LEVELS = -12,
    CLUSTERS = -13,
    SETTINGS = -14,
    PICTURE = -15
};

typedef struct column {
    const char *name;
    int value;    /* evaluation_value, or one of the texts */
    int decimals; /* of a number; -1: as many as needed */
    int narrow;   /* width on a terminal of 80 columns; 0: not shown there */
    int width;    /* with all columns */
    shown shown;  /* at a glance */
} column;

static const column columns[EVALUATION_COLUMNS] = {
    {"scene", SCENE, 0, 14, 20, ALWAYS},
    {"context", CONTEXT, 0, 8, 8, RECORDING},
    {"target", TARGET, 0, 7, 7, RECORDING},
    {"method", METHOD, 0, 0, 23, ALWAYS},
    {"head", HEAD, 0, 0, 10, ALWAYS},
    {"bits", BITS, 0, 0, 6, ALWAYS},
    {"refine", REFINE, 0, 0, 0, NEVER},
    {"allocate", ALLOCATE, 0, 0, 9, ALWAYS},
    {"depth", DEPTH, 0, 0, 0, NEVER},
    {"ablation", ABLATION, 0, 0, 22, GIVEN},
    {"wavelet", WAVELET, 0, 0, 0, NEVER},
    {"levels", LEVELS, 0, 0, 0, NEVER},
    {"clusters", CLUSTERS, 0, 0, 0, NEVER},
    {"settings", SETTINGS, 0, 0, 0, NEVER},
    {"keep", EVALUATION_KEEP, -1, 5, 5, ALWAYS},
    {"requested", EVALUATION_REQUESTED, 0, 0, 0, NEVER},
    {"gaussians", EVALUATION_GAUSSIANS, 0, 10, 10, ALWAYS},
    {"psnr_all", EVALUATION_PSNR_ALL, 4, 9, 9, RECORDING},
    {"ssim_all", EVALUATION_SSIM_ALL, 5, 0, 9, RECORDING},
    {"perceptual_all", EVALUATION_PERCEPTUAL_ALL, 5, 0, 15, RECORDING},
    {"psnr", EVALUATION_PSNR, 4, 7, 7, RECORDING},
    {"ssim", EVALUATION_SSIM, 5, 7, 7, ALWAYS},
    {"sharp", EVALUATION_SHARP, 5, 0, 7, ALWAYS},
    {"holes", EVALUATION_HOLES, 5, 0, 7, ALWAYS},
    {"psnr_seen", EVALUATION_PSNR_SEEN, 4, 0, 10, RECORDING},
    {"context_psnr", EVALUATION_CONTEXT_PSNR, 4, 0, 13, RECORDING},
    {"perceptual", EVALUATION_PERCEPTUAL, 5, 0, 11, ALWAYS},
    {"build_ms", EVALUATION_BUILD_MS, 2, 10, 9, ALWAYS},
    {"render_ms", EVALUATION_RENDER_MS, 2, 0, 10, ALWAYS},
    {"arena_bytes", EVALUATION_ARENA_BYTES, 0, 0, 12, ALWAYS},
    {"scene_bytes", EVALUATION_SCENE_BYTES, 0, 0, 0, NEVER},
    {"planar_psnr", EVALUATION_PLANAR_PSNR, 4, 12, 12, PLANAR},
    {"loss", EVALUATION_LOSS, 4, 0, 0, NEVER},
    {"picture", PICTURE, 0, 0, 0, NEVER},
    {"bits_epoch", EVALUATION_BITS_EPOCH, 0, 0, 0, NEVER},
};

const char *evaluation_column_name(uint32_t index)
{
    return index < EVALUATION_COLUMNS ? columns[index].name : NULL;
}

static const char *text_of(const evaluation_row *row, int text)
{
    const char *const texts[] = {row->scene,   row->context, row->target,   row->method,   row->head,
                                 row->bits,    row->refine,  row->allocate, row->depth,    row->ablation,
                                 row->wavelet, row->levels,  row->clusters, row->settings, row->picture};
    return texts[-1 - text];
}

void evaluation_cell(const evaluation_row *row, uint32_t index, char *text, size_t bytes)
{
    const column *c = &columns[index];
    if (c->value < 0) {
        snprintf(text, bytes, "%s", text_of(row, c->value));
    } else if (isnan(row->value[c->value])) {
        snprintf(text, bytes, "%s", "");
    } else if (c->decimals < 0) {
        snprintf(text, bytes, "%.10g", row->value[c->value]);
    } else {
        snprintf(text, bytes, "%.*f", c->decimals, row->value[c->value]);
    }
}

void evaluation_csv_header(csv_table *table)
{
    for (uint32_t i = 0; i < EVALUATION_COLUMNS; i++) {
        csv_cell(table, columns[i].name);
    }
    csv_end_row(table);
}

void evaluation_csv_row(csv_table *table, const evaluation_row *row)
{
    char text[EVALUATION_CELL_BYTES];
    for (uint32_t i = 0; i < EVALUATION_COLUMNS; i++) {
        evaluation_cell(row, i, text, sizeof text);
        csv_cell(table, text);
    }
    csv_end_row(table);
}

/* Returns the text's buffer in the row and its size *bytes; NULL if the row only points to the text, by *pointer. */
static char *room_of(evaluation_row *row, int text, size_t *bytes, const char ***pointer)
{
    struct {
        char *own;
        size_t bytes;
        const char **pointer;
    } const rooms[] = {
        {row->scene, sizeof row->scene, NULL},
        {row->context, sizeof row->context, NULL},
        {row->target, sizeof row->target, NULL},
        {NULL, 0, &row->method},
        {row->head, sizeof row->head, NULL},
        {row->bits, sizeof row->bits, NULL},
        {row->refine, sizeof row->refine, NULL},
        {NULL, 0, &row->allocate},
        {NULL, 0, &row->depth},
        {NULL, 0, &row->ablation},
        {NULL, 0, &row->wavelet},
        {row->levels, sizeof row->levels, NULL},
        {row->clusters, sizeof row->clusters, NULL},
        {row->settings, sizeof row->settings, NULL},
        {row->picture, sizeof row->picture, NULL},
    };
    *bytes = rooms[-1 - text].bytes;
    *pointer = rooms[-1 - text].pointer;
    return rooms[-1 - text].own;
}

static bool read_text(evaluation_row *row, int text, const char *cell)
{
    const char **pointer;
    size_t bytes;
    char *own = room_of(row, text, &bytes, &pointer);
    if (own == NULL) {
        *pointer = cell;
        return true;
    }
    return snprintf(own, bytes, "%s", cell) < (int)bytes;
}

bool evaluation_row_read(evaluation_row *row, const char *const cells[EVALUATION_COLUMNS])
{
    bool good = true;
    *row = (evaluation_row){0};
    for (uint32_t i = 0; i < EVALUATION_COLUMNS && good; i++) {
        bool given = false;
        if (columns[i].value < 0) {
            good = read_text(row, columns[i].value, cells[i]);
        } else {
            double *value = &row->value[columns[i].value];
            good = csv_number(cells[i], value, &given) == 0;
            *value = given ? *value : NAN;
        }
    }
    return good;
}

cJSON *evaluation_json(const evaluation_row *row)
{
    cJSON *object = cJSON_CreateObject();
    for (uint32_t i = 0; i < EVALUATION_COLUMNS && object != NULL; i++) {
        char text[EVALUATION_CELL_BYTES];
        evaluation_cell(row, i, text, sizeof text);
        cJSON *added = text[0] == '\0'         ? cJSON_AddNullToObject(object, columns[i].name)
                       : columns[i].value >= 0 ? cJSON_AddRawToObject(object, columns[i].name, text)
                                               : cJSON_AddStringToObject(object, columns[i].name, text);
        if (added == NULL) {
            cJSON_Delete(object);
            object = NULL;
        }
    }
    return object;
}

/* Whether two cells are equal; two cells that do not apply are. */
static bool same_value(const evaluation_row *a, const evaluation_row *b, evaluation_value value)
{
    return a->value[value] == b->value[value] || (isnan(a->value[value]) && isnan(b->value[value]));
}

bool evaluation_same_budget(const evaluation_row *a, const evaluation_row *b)
{
    return same_value(a, b, EVALUATION_KEEP) && same_value(a, b, EVALUATION_REQUESTED);
}

static bool belong_together(const evaluation_row *a, const evaluation_row *b, bool by_scene)
{
    return (!by_scene || strcmp(a->scene, b->scene) == 0) && strcmp(a->method, b->method) == 0 &&
           strcmp(a->head, b->head) == 0 && strcmp(a->bits, b->bits) == 0 && strcmp(a->refine, b->refine) == 0 &&
           strcmp(a->allocate, b->allocate) == 0 && strcmp(a->depth, b->depth) == 0 &&
           strcmp(a->ablation, b->ablation) == 0 && strcmp(a->wavelet, b->wavelet) == 0 &&
           strcmp(a->levels, b->levels) == 0 && strcmp(a->clusters, b->clusters) == 0 &&
           strcmp(a->settings, b->settings) == 0 && evaluation_same_budget(a, b);
}

bool evaluation_same(const evaluation_row *a, const evaluation_row *b)
{
    return strcmp(a->context, b->context) == 0 && strcmp(a->target, b->target) == 0 && belong_together(a, b, true);
}

static evaluation_row mean_of(const evaluation_row *first, const evaluation_row *rows, uint32_t count, bool by_scene)
{
    evaluation_row mean = *first;
    for (int value = 0; value < EVALUATION_VALUE_COUNT; value++) {
        double sum = 0;
        uint32_t summed = 0;
        for (uint32_t i = 0; i < count; i++) {
            if (belong_together(&rows[i], first, by_scene) && !isnan(rows[i].value[value])) {
                sum += rows[i].value[value];
                summed++;
            }
        }
        mean.value[value] = summed == 0 ? NAN : sum / summed;
    }
    mean.value[EVALUATION_KEEP] = first->value[EVALUATION_KEEP]; /* exactly */
    snprintf(mean.context, sizeof mean.context, "mean");
    mean.target[0] = '\0';
    mean.picture[0] = '\0';
    if (!by_scene) {
        snprintf(mean.scene, sizeof mean.scene, "mean");
        mean.context[0] = '\0';
    }
    return mean;
}

uint32_t evaluation_means(const evaluation_row *rows, uint32_t count, bool by_scene, evaluation_row *means)
{
    uint32_t found = 0;
    for (uint32_t i = 0; i < count; i++) {
        bool seen = false;
        for (uint32_t earlier = 0; earlier < i && !seen; earlier++) {
            seen = belong_together(&rows[earlier], &rows[i], by_scene);
        }
        if (!seen) {
            means[found++] = mean_of(&rows[i], rows, count, by_scene);
        }
    }
    return found;
}

static bool at_a_glance(const column *c, bool planar, bool given)
{
    return c->shown == ALWAYS || c->shown == (planar ? PLANAR : RECORDING) || (c->shown == GIVEN && given);
}

bool evaluation_glance(const evaluation_row *row, uint32_t index, bool planar, char *text, size_t bytes)
{
    const column *c = &columns[index];
    evaluation_cell(row, index, text, bytes);
    if (c->value >= 0 && c->decimals > 2 && !isnan(row->value[c->value])) {
        snprintf(text, bytes, "%.*f", c->decimals - 2, row->value[c->value]);
    }
    return at_a_glance(c, planar, text[0] != '\0');
}

/* Texts to the left, numbers to the right. */
static void print_cell(FILE *out, const column *c, bool wide, const char *text)
{
    const int width = wide ? c->width : c->narrow;
    if (width > 0) {
        char cut[64];
        const size_t room = (size_t)width < sizeof cut ? (size_t)width : sizeof cut;
        t3r_text_copy(cut, room, t3r_text_of(text)); /* between characters */
        fprintf(out, "%*s", c->value < 0 ? -width : width, cut);
    }
}

void evaluation_print_header(FILE *out, bool planar, bool wide)
{
    fputs(style_begin(out, STYLE_HEADING), out);
    for (uint32_t i = 0; i < EVALUATION_COLUMNS; i++) {
        if (at_a_glance(&columns[i], planar, false)) {
            print_cell(out, &columns[i], wide, columns[i].name);
        }
    }
    fprintf(out, "%s\n", style_end(out));
}

void evaluation_print_row(FILE *out, const evaluation_row *row, bool planar, bool wide)
{
    for (uint32_t i = 0; i < EVALUATION_COLUMNS; i++) {
        char text[EVALUATION_CELL_BYTES];
        if (evaluation_glance(row, i, planar, text, sizeof text)) {
            print_cell(out, &columns[i], wide, text);
        }
    }
    fputc('\n', out);
}
