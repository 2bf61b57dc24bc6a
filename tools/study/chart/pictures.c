/* SPDX-License-Identifier: Apache-2.0 */
#include "study/chart/pictures.h"

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "host/grow.h"
#include "host/reason.h"
#include "pictures/picture.h"
#include "pictures/png_bytes.h"

#define PATH_BYTES 4096

typedef struct gathering {
    chart_pictures *to;
    const chart_points *points;
    const chart_view *view;
    char *const *folders;
    uint32_t folder_count;
    size_t most;
    char *error;
    size_t error_bytes;
} gathering;

static int fail(const gathering *g, const char *path, const char *why)
{
    return t3r_reason(g->error, g->error_bytes, "%s: %s", path, why);
}

static int encode(const gathering *g, const char *path, const picture *in, uint32_t *number)
{
    chart_pictures *to = g->to;
    chart_picture *grown = t3r_grow(to->pictures, to->count, &to->room, sizeof *grown);
    if (grown == NULL) {
        return fail(g, path, "out of memory");
    }
    to->pictures = grown;
    chart_picture *it = &to->pictures[to->count];
    *it = (chart_picture){.width = in->width, .height = in->height};
    it->png = png_bytes(in->width, in->height, in->channels, in->samples, &it->bytes);
    if (it->png == NULL) {
        return fail(g, path, "out of memory");
    }
    to->bytes += it->bytes;
    *number = to->count++;
    return 0;
}

/* Gets the picture of a file, or CHART_NO_PICTURE. Each path is looked up once. */
static int look_up(const gathering *g, const char *path, uint32_t *number)
{
    chart_pictures *to = g->to;
    uint32_t known = to->paths.count, at;
    if (chart_texts_number(&to->paths, path, &at) != 0) {
        return fail(g, path, "out of memory");
    }
    if (at < known) {
        *number = to->of_path[at];
        return 0;
    }
    uint32_t *grown = t3r_grow(to->of_path, at, &to->path_room, sizeof *grown);
    if (grown == NULL) {
        return fail(g, path, "out of memory");
    }
    to->of_path = grown;
    to->of_path[at] = *number = CHART_NO_PICTURE;
    if (access(path, R_OK) != 0) {
        return 0;
    }
    picture p = {0};
    int failed = picture_read(path, &p, g->error, g->error_bytes);
    if (failed == 0) {
        failed = p.bits == 8 ? encode(g, path, &p, number) : fail(g, path, "not a picture of 8 bits");
        picture_free(&p);
    }
    to->of_path[at] = *number;
    return failed;
}

/* Writes the path of a cell's render; false if no folder has it. */
static bool find(const gathering *g, const chart_cell *cell, char path[PATH_BYTES])
{
    const chart_table *table = g->points->table;
    const char *folder = g->folders[g->folder_count == 1 ? 0 : cell->file];
    const char *name = table->texts.text[cell->picture];
    const char *scene = table->scenes.text[table->cases[cell->scene_case].scene];
    int length = snprintf(path, PATH_BYTES, "%s/%s", folder, name);
    if (length >= 0 && length < PATH_BYTES && access(path, R_OK) == 0) {
        return true;
    }
    length = snprintf(path, PATH_BYTES, "%s/%s/%s", folder, scene, name);
    return length >= 0 && length < PATH_BYTES && access(path, R_OK) == 0;
}

/* Gets the picture `name` in the folder of the file `path`. */
static int beside(const gathering *g, const char *path, const char *name, uint32_t *number)
{
    char other[PATH_BYTES];
    const char *slash = strrchr(path, '/');
    int length = snprintf(other, sizeof other, "%.*s/%s", (int)(slash - path), path, name);
    *number = CHART_NO_PICTURE;
    return length < 0 || length >= PATH_BYTES ? 0 : look_up(g, other, number);
}

static int check_size(const gathering *g, const char *path, uint32_t number, uint32_t of)
{
    const chart_picture *pictures = g->to->pictures;
    if (number == CHART_NO_PICTURE || of == CHART_NO_PICTURE ||
        (pictures[number].width == pictures[of].width && pictures[number].height == pictures[of].height)) {
        return 0;
    }
    return fail(g, path, "the pictures beside it have another size");
}

static int gather_cell(const gathering *g, uint32_t index)
{
    const chart_cell *cell = &g->points->cells[index];
    chart_shots *shots = &g->to->of_cell[index];
    char path[PATH_BYTES];
    if (g->points->table->texts.text[cell->picture][0] == '\0') {
        return 0;
    }
    if (!find(g, cell, path)) {
        g->to->missing++;
        return 0;
    }
    if (g->to->bytes >= g->most) {
        g->to->left_out++;
        return 0;
    }
    int failed = look_up(g, path, &shots->render);
    if (failed == 0) {
        failed = beside(g, path, "target.png", &shots->target);
    }
    if (failed == 0) {
        failed = beside(g, path, "mask.png", &shots->mask);
    }
    if (failed == 0) {
        failed = check_size(g, path, shots->render, shots->target);
    }
    return failed == 0 ? check_size(g, path, shots->render, shots->mask) : failed;
}

/* Gathers one case of every point on the front, or of every other point. */
static int gather_round(const gathering *g, uint32_t round, bool front)
{
    for (uint32_t p = 0; p < g->points->count; p++) {
        const chart_point *point = &g->points->points[p];
        if (round < point->cell_count && g->view->spots[p].front == front &&
            gather_cell(g, point->first_cell + round) != 0) {
            return -1;
        }
    }
    return 0;
}

static int gather(const gathering *g)
{
    const chart_points *points = g->points;
    uint32_t rounds = 0;
    for (uint32_t p = 0; p < points->count; p++) {
        rounds = points->points[p].cell_count > rounds ? points->points[p].cell_count : rounds;
    }
    for (uint32_t round = 0; round < rounds; round++) {
        if (gather_round(g, round, true) != 0 || gather_round(g, round, false) != 0) {
            return -1;
        }
    }
    return 0;
}

int chart_pictures_gather(chart_pictures *pictures, const chart_points *points, const chart_view *view,
                          char *const *folders, uint32_t folder_count, size_t most, char *error, size_t error_bytes)
{
    *pictures = (chart_pictures){.of_cell = calloc(points->cell_count, sizeof *pictures->of_cell)};
    if (pictures->of_cell == NULL) {
        return t3r_reason(error, error_bytes, "out of memory");
    }
    for (uint32_t i = 0; i < points->cell_count; i++) {
        pictures->of_cell[i] = (chart_shots){CHART_NO_PICTURE, CHART_NO_PICTURE, CHART_NO_PICTURE};
    }
    gathering g = {pictures, points, view, folders, folder_count, most, error, error_bytes};
    int failed = folder_count > 0 ? gather(&g) : 0;
    if (failed != 0) {
        chart_pictures_free(pictures);
    }
    return failed;
}

void chart_pictures_free(chart_pictures *pictures)
{
    for (uint32_t i = 0; i < pictures->count; i++) {
        free(pictures->pictures[i].png);
    }
    free(pictures->pictures);
    free(pictures->of_cell);
    free(pictures->of_path);
    chart_texts_free(&pictures->paths);
    *pictures = (chart_pictures){0};
}
