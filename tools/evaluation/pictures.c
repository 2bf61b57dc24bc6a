/* SPDX-License-Identifier: Apache-2.0 */
#include "evaluation/pictures.h"

#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

#include "cli/cli.h"
#include "pictures/picture.h"

#define PATH_BYTES 4096

/* Makes every folder that the path names before its last slash. */
static int make_folders(char *path)
{
    for (char *slash = strchr(path + 1, '/'); slash != NULL; slash = strchr(slash + 1, '/')) {
        *slash = '\0';
        int failed = mkdir(path, 0777) != 0 && errno != EEXIST;
        if (failed) {
            return cli_error(CLI_BAD_INPUT, "%s: %s", path, strerror(errno));
        }
        *slash = '/';
    }
    return CLI_OK;
}

static int write_png(const char *folder, const char *name, const evaluation_views *views, uint32_t channels,
                     uint8_t *samples)
{
    char path[PATH_BYTES], error[PATH_BYTES + 256] = "";
    int length = snprintf(path, sizeof path, "%s/%s", folder, name);
    if (length < 0 || (size_t)length >= sizeof path) {
        return cli_error(CLI_BAD_INPUT, "%s: the path is too long", folder);
    }
    int code = make_folders(path);
    picture p = {.width = views->width, .height = views->height, .channels = channels, .bits = 8, .samples = samples};
    if (code == CLI_OK && picture_write_png(path, &p, error, sizeof error) != 0) {
        code = cli_error(CLI_BAD_INPUT, "%s", error);
    }
    return code;
}

int evaluation_write_views(const char *folder, const evaluation_views *views, const evaluation_case *what)
{
    int code = write_png(folder, "target.png", views, 3, views->target.rgb);
    if (what->planar) {
        return code;
    }
    if (code == CLI_OK) {
        code = write_png(folder, "mask.png", views, 1, views->target.mask);
    }
    if (code == CLI_OK && memchr(views->target.shown, 0, (size_t)views->width * views->height) != NULL) {
        code = write_png(folder, "shown.png", views, 1, views->target.shown);
    }
    for (uint32_t v = 0; v < views->context_count && code == CLI_OK; v++) {
        char name[] = "context_a.png";
        name[strlen("context_")] = (char)('a' + v); /* at most 16 */
        code = write_png(folder, name, views, 3, views->context[v].rgb);
    }
    return code;
}

int evaluation_write_render(const char *folder, const evaluation_views *views, const evaluation_row *row,
                            uint8_t *render)
{
    return write_png(folder, row->picture, views, 3, render);
}

void evaluation_page_views(html_page *page, const evaluation_views *views, const evaluation_case *what)
{
    char text[320];
    if (what->planar) {
        snprintf(text, sizeof text, "%s, on a plane", what->scene);
    } else {
        snprintf(text, sizeof text, "%s: frame %" PRIu32, what->scene, what->target);
    }
    html_page_section(page, text, views->width, views->height, views->target.rgb);
    html_page_strip(page, what->planar ? "Recorded" : "Recorded: the input, and the target view");
    for (uint32_t v = 0; v < views->context_count && !what->planar; v++) {
        snprintf(text, sizeof text, "context %c: frame %" PRIu32, (char)('a' + v), what->context[v]);
        html_page_picture(page, text, views->width, views->height, 3, views->context[v].rgb, 0);
    }
    html_page_picture(page, "target", views->width, views->height, 3, views->target.rgb, 0);
    if (!what->planar) {
        html_page_picture(page,
                          views->sensed ? "mask: what a context view saw" : "mask: all pixels, as depth is missing",
                          views->width, views->height, 1, views->target.mask, 0);
    }
}

void evaluation_page_render(html_page *page, const evaluation_views *views, const evaluation_row *row,
                            const uint8_t *render)
{
    char text[160], kept[32] = "", psnr[32] = "nothing to compare";
    double db =
        isnan(row->value[EVALUATION_PLANAR_PSNR]) ? row->value[EVALUATION_PSNR] : row->value[EVALUATION_PLANAR_PSNR];
    if (!isnan(db)) {
        snprintf(psnr, sizeof psnr, "%.2f dB", db);
    }
    if (!isnan(row->value[EVALUATION_KEEP])) {
        snprintf(kept, sizeof kept, "%.10g %% kept: ", row->value[EVALUATION_KEEP]);
    }
    snprintf(text, sizeof text, "%s%s, %.0f Gaussians", kept, psnr, row->value[EVALUATION_GAUSSIANS]);
    html_page_picture(page, text, views->width, views->height, 3, render, 1);
}
