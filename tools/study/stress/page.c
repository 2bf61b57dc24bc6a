/* SPDX-License-Identifier: Apache-2.0 */
#include "study/stress/page.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "pictures/html_page.h"
#include "study/stress/table.h"

static void drop(stress_picture *picture)
{
    free(picture->rows);
    free(picture->renders);
    free(picture->plain);
    free(picture->target);
    for (uint32_t v = 0; v < T3R_MAX_VIEWS; v++) {
        free(picture->context[v]);
        free(picture->depth[v]);
    }
    *picture = (stress_picture){0};
}

void stress_album_free(stress_album *album)
{
    for (uint32_t i = 0; i < album->count; i++) {
        drop(&album->pictures[i]);
    }
    *album = (stress_album){0};
}

/* Returns the loss of the first method at the first budget; the lowest value if it was not measured. */
static double badness(const stress_row *rows)
{
    return isnan(rows[0].value[STRESS_PSNR_LOST]) ? -INFINITY : rows[0].value[STRESS_PSNR_LOST];
}

static void *copy_of(const void *bytes, size_t count)
{
    void *copy = malloc(count);
    return copy == NULL ? NULL : memcpy(copy, bytes, count);
}

/* Makes a grey picture of depth: 255 at the nearest measurement, falling in inverse proportion; 0 without measurement.
 */
static uint8_t *depth_picture(const stress_capture *capture, uint32_t view)
{
    size_t pixels = (size_t)capture->width * capture->height;
    const uint16_t *depth = capture->view[view].depth;
    uint8_t *grey = malloc(pixels);
    uint32_t nearest = UINT16_MAX;
    for (size_t i = 0; i < pixels; i++) {
        nearest = depth[i] != 0 && depth[i] < nearest ? depth[i] : nearest;
    }
    for (size_t i = 0; i < pixels && grey != NULL; i++) {
        grey[i] = (uint8_t)(depth[i] == 0 ? 0 : 255 * nearest / depth[i]);
    }
    return grey;
}

bool stress_album_offer(stress_album *album, const stress_row *rows, const uint8_t *renders, const uint8_t *plain,
                        const stress_case *c, const stress_contest *contest, const perturbation *p)
{
    uint32_t at = 0, count = stress_row_count(contest);
    while (at < album->count && strcmp(album->pictures[at].rows[0].what, rows[0].what) != 0) {
        at++;
    }
    if (at == STRESS_WORST_MOST || !isfinite(badness(rows)) ||
        (at < album->count && badness(album->pictures[at].rows) >= badness(rows))) {
        return true;
    }
    stress_picture *picture = &album->pictures[at];
    size_t bytes = (size_t)c->views.width * c->views.height * 3;
    if (at == album->count) {
        album->count++;
    }
    drop(picture);
    stress_run run;
    bool done = stress_run_open(&run, c, contest, p, rows[0].strength, 0) == 0;
    picture->width = c->views.width;
    picture->height = c->views.height;
    picture->rows = copy_of(rows, count * sizeof *rows);
    picture->renders = copy_of(renders, count * bytes);
    picture->plain = plain == NULL ? NULL : copy_of(plain, count * bytes);
    picture->target = copy_of(c->views.target.rgb, bytes);
    done = done && picture->rows != NULL && picture->renders != NULL && picture->target != NULL &&
           (picture->plain != NULL) == (plain != NULL);
    for (picture->views = 0; picture->views < c->base.views && done; picture->views++) {
        picture->context[picture->views] = copy_of(run.capture.view[picture->views].rgb, bytes);
        picture->depth[picture->views] = depth_picture(&run.capture, picture->views);
        done = picture->context[picture->views] != NULL && picture->depth[picture->views] != NULL;
    }
    stress_run_close(&run);
    if (!done) {
        drop(picture);
        album->count -= at + 1 == album->count;
    }
    return done;
}

static int by_badness(const void *a, const void *b)
{
    double x = badness(((const stress_picture *)a)->rows), y = badness(((const stress_picture *)b)->rows);
    return (x < y) - (x > y);
}

static void caption(char *text, size_t bytes, const stress_row *row)
{
    if (row->status != STRESS_MEASURED) {
        snprintf(text, bytes, "%s, %.10g %% kept: %s", row->method->name, row->keep, row->reason);
    } else {
        snprintf(text, bytes, "%s, %.10g %% kept: %.2f dB, %.2f lost, %.1f %% holes", row->method->name, row->keep,
                 row->value[STRESS_PSNR], row->value[STRESS_PSNR_LOST], row->value[STRESS_HOLES] * 100);
    }
}

static void add_renders(html_page *page, const stress_picture *picture, const uint8_t *renders, bool plain,
                        uint32_t count)
{
    size_t bytes = (size_t)picture->width * picture->height * 3;
    for (uint32_t i = 0; i < count; i++) {
        char text[320];
        caption(text, sizeof text, &picture->rows[i]);
        html_page_picture(page, plain ? picture->rows[i].method->name : text, picture->width, picture->height, 3,
                          renders + i * bytes, 1);
    }
}

static void add_section(html_page *page, const stress_picture *picture, uint32_t count)
{
    char heading[400], strength[32];
    const stress_row *row = picture->rows;
    stress_strength(row, strength, sizeof strength);
    snprintf(heading, sizeof heading, "%s %s (%s%s%s)", row->what, strength, row->scene,
             row->target[0] == '\0' ? "" : ": frame ", row->target);
    html_page_section(page, heading, picture->width, picture->height, picture->target);
    html_page_strip(page, "The input, and the target view");
    for (uint32_t v = 0; v < picture->views; v++) {
        snprintf(heading, sizeof heading, "context %c", (char)('a' + v));
        html_page_picture(page, heading, picture->width, picture->height, 3, picture->context[v], 0);
        snprintf(heading, sizeof heading, "its depth, near is bright");
        html_page_picture(page, heading, picture->width, picture->height, 1, picture->depth[v], 0);
    }
    html_page_picture(page, "target", picture->width, picture->height, 3, picture->target, 0);
    html_page_strip(page, "Rendered");
    add_renders(page, picture, picture->renders, false, count);
    if (picture->plain != NULL) {
        html_page_strip(page, "Rendered from unperturbed frames");
        add_renders(page, picture, picture->plain, true, count);
    }
}

static void add_cells(html_page *page, const char *const *texts, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        html_page_table_cell(page, texts[i]);
    }
    html_page_table_end_row(page);
}

/* Writes why the `count` rows of a cell have no score or are wrong; one line if the reason is the same for all. */
static void add_why(html_page *page, const stress_row *rows, uint32_t count)
{
    char strength[32], who[64];
    bool alike = true;
    for (uint32_t i = 1; i < count; i++) {
        alike = alike && rows[i].status == rows[0].status && strcmp(rows[i].reason, rows[0].reason) == 0;
    }
    stress_strength(rows, strength, sizeof strength);
    for (uint32_t i = 0; i < (alike ? 1 : count); i++) {
        const stress_row *row = &rows[i];
        if (row->status == STRESS_MEASURED) {
            continue;
        }
        snprintf(who, sizeof who, "%s, %.10g %%", row->method->name, row->keep);
        add_cells(page,
                  (const char *const[]){row->scene, row->target, row->what, strength,
                                        alike && count > 1 ? "every method and budget" : who,
                                        row->status == STRESS_BROKEN ? "an invariant is broken" : "refused",
                                        row->reason},
                  7);
    }
}

/* Writes the cells without a picture: refused ones and broken invariants. */
static void add_unscored(html_page *page, const stress_row *rows, uint32_t count, uint32_t cell)
{
    bool any = false;
    for (uint32_t i = 0; i < count; i++) {
        any = any || rows[i].status != STRESS_MEASURED;
    }
    if (!any) {
        return;
    }
    html_page_table(page, "Refused, or an invariant broken", "", 0);
    add_cells(page, (const char *const[]){"scene", "target", "perturbation", "strength", "method", "", "reason"}, 7);
    for (uint32_t at = 0; at + cell <= count; at += cell) {
        add_why(page, rows + at, cell);
    }
}

/* Writes the table above the pictures. */
static void add_table(html_page *page, const stress_row *rows, uint32_t count)
{
    static const struct {
        const char *name;
        stress_value value;
        int decimals;
    } columns[] = {{"PSNR", STRESS_PSNR, 2},
                   {"lost", STRESS_PSNR_LOST, 2},
                   {"SSIM", STRESS_SSIM, 3},
                   {"lost", STRESS_SSIM_LOST, 3},
                   {"holes", STRESS_HOLES, 3},
                   {"flicker", STRESS_FLICKER, 2},
                   {"unpruned", STRESS_FLICKER_UNPRUNED, 2},
                   {"Gaussians", STRESS_GAUSSIANS, 0}};
    static const char *const names[] = {"scene", "target", "perturbation", "strength", "method", "kept"};
    char text[64];
    html_page_table(page, "Rows", "", 1);
    for (uint32_t i = 0; i < sizeof names / sizeof *names; i++) {
        html_page_table_cell(page, names[i]);
    }
    for (uint32_t i = 0; i < sizeof columns / sizeof *columns; i++) {
        html_page_table_cell(page, columns[i].name);
    }
    html_page_table_cell(page, "");
    html_page_table_end_row(page);
    for (const stress_row *row = rows; row < rows + count; row++) {
        html_page_table_cell(page, row->scene);
        html_page_table_cell(page, row->target);
        html_page_table_cell(page, row->what);
        stress_strength(row, text, sizeof text);
        html_page_table_cell(page, text);
        html_page_table_cell(page, row->method->name);
        snprintf(text, sizeof text, "%.10g %%", row->keep);
        html_page_table_cell(page, text);
        for (uint32_t i = 0; i < sizeof columns / sizeof *columns; i++) {
            double value = row->value[columns[i].value];
            snprintf(text, sizeof text, "%.*f", columns[i].decimals, value);
            html_page_table_cell(page, isnan(value) ? "" : text);
        }
        html_page_table_cell(page, row->reason);
        html_page_table_end_row(page);
    }
}

int stress_album_write(stress_album *album, uint32_t worst, const stress_row *rows, uint32_t count,
                       const stress_contest *contest, FILE *out)
{
    char introduction[400];
    snprintf(introduction, sizeof introduction,
             "Of each perturbation the cell in which %s at %.10g %% loses most PSNR against unperturbed frames (of the "
             "scene-* rows: against all points), the greatest loss first: the frames it was given and what each method "
             "made of them.",
             contest->methods[0]->name, contest->keep[0]);
    html_page *page = html_page_new("trim3r: where it fails", introduction);
    if (page == NULL) {
        return -1;
    }
    qsort(album->pictures, album->count, sizeof *album->pictures, by_badness);
    add_unscored(page, rows, count, stress_row_count(contest));
    add_table(page, rows, count);
    for (uint32_t i = 0; i < album->count && i < worst; i++) {
        add_section(page, &album->pictures[i], stress_row_count(contest));
    }
    int status = html_page_write(page, out);
    html_page_free(page);
    return status;
}
