/* SPDX-License-Identifier: Apache-2.0 */
#include "scene/summary/scene_info.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/cli.h"
#include "cli/files/recorded_frame.h"
#include "cli/files/whole_file.h"
#include "cli/tables/json_output.h"
#include "core/camera.h"
#include "recording/recording.h"
#include "scene/scene_file.h"
#include "scene/scene_turn.h"
#include "scene/summary/scale_picture.h"

#define ERROR_BYTES 512
#define QUANTILES 5
#define UP_UNKNOWN "not stated; -y in most scenes: y points down"
#define PANEL_NAME_BYTES 80 /* as wide as a panel */

static const double quantile_share[QUANTILES] = {0.05, 0.25, 0.5, 0.75, 0.95};
static const char *const quantile_name[QUANTILES] = {"p5", "p25", "median", "p75", "p95"};

typedef struct scene_summary {
    uint32_t count;
    double low[3], high[3]; /* bounds of the means, world units */
    double opacity;         /* mean */
    scene_up up;            /* as the file states it */
} scene_summary;

typedef struct scene_summaries {
    scene_summary scene[SCENE_INFO_MOST];
    splat_scales scales[SCENE_INFO_MOST];
    double depth;  /* median depth of the first scene's means from the camera, world units; 0 = unknown */
    double pixels; /* size of a world unit at that depth; 0 = unknown */
    scale_bins bins;
} scene_summaries;

/* ---- numbers ---------------------------------------------------------------------------------------------------- */

static scene_summary summarise(const scene_file *scene)
{
    scene_summary summary = {.count = scene->count, .up = scene->up};
    for (uint32_t i = 0; i < scene->count; i++) {
        const t3r_gaussian *g = &scene->gaussians[i];
        for (int axis = 0; axis < 3; axis++) {
            double x = ldexp((double)scene->frame.origin_q32[axis], -32) +
                       ldexp(g->position_q20[axis], scene->frame.exponent - 20);
            summary.low[axis] = i == 0 ? x : fmin(summary.low[axis], x);
            summary.high[axis] = i == 0 ? x : fmax(summary.high[axis], x);
        }
        summary.opacity += g->opacity_q15 / 32768.0 / scene->count;
    }
    return summary;
}

static int ascending(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Computes the depth of each mean that lies within the picture; returns their number. */
static uint32_t depths_seen(const scene_file *scene, const t3r_capture_frame *frame, double *depths)
{
    const t3r_camera *camera = &frame->camera;
    int32_t rotation[9];
    t3r_camera_rotation(camera->rotation_q30, rotation);
    uint32_t seen = 0;
    for (uint32_t i = 0; i < scene->count; i++) {
        double from[3], in[3];
        for (int axis = 0; axis < 3; axis++) {
            from[axis] = ldexp((double)scene->frame.origin_q32[axis], -32) -
                         ldexp((double)camera->position_q32[axis], -32) +
                         ldexp(scene->gaussians[i].position_q20[axis], scene->frame.exponent - 20);
        }
        for (int axis = 0; axis < 3;
             axis++) { /* the rotation is camera to world, so its columns are the camera's axes */
            in[axis] =
                ldexp(from[0] * rotation[axis] + from[1] * rotation[3 + axis] + from[2] * rotation[6 + axis], -30);
        }
        double x = ldexp(camera->fx_q16 * (in[0] / in[2]) + camera->cx_q16, -16);
        double y = ldexp(camera->fy_q16 * (in[1] / in[2]) + camera->cy_q16, -16);
        if (in[2] > 0 && x >= -0.5 && y >= -0.5 && x < frame->frame.width - 0.5 && y < frame->frame.height - 0.5) {
            depths[seen++] = in[2];
        }
    }
    return seen;
}

static int measure_pixels(const scene_info_request *request, const scene_file *scene, scene_summaries *summary)
{
    t3r_capture_frame frame;
    double *depths = malloc(((size_t)scene->count + 1) * sizeof *depths);
    int code = depths == NULL ? cli_error(CLI_BAD_INPUT, "out of memory")
                              : recorded_frame_read(request->recording, request->recording_path, request->view, &frame);
    if (code == CLI_OK) {
        uint32_t seen = depths_seen(scene, &frame, depths);
        qsort(depths, seen, sizeof *depths, ascending);
        if (seen == 0) {
            code = cli_error(CLI_BAD_INPUT, "%s: frame %" PRIu32 " shows no Gaussian of %s", request->recording_path,
                             request->view, request->scenes[0]);
        } else {
            summary->depth = depths[seen / 2];
            summary->pixels = ldexp(frame.camera.fx_q16, -16) / summary->depth;
        }
    }
    free(depths);
    return code;
}

static int summarise_all(const scene_info_request *request, scene_summaries *summary)
{
    char error[ERROR_BYTES] = "";
    int code = CLI_OK;
    for (uint32_t i = 0; i < request->scene_count && code == CLI_OK; i++) {
        scene_file scene;
        if (scene_file_read(request->scenes[i], request->flags, &scene, error, sizeof error) != 0) {
            return cli_error(CLI_BAD_INPUT, "%s", error);
        }
        summary->scene[i] = summarise(&scene);
        if (!splat_scales_of(&summary->scales[i], &scene)) {
            code = cli_error(CLI_BAD_INPUT, "out of memory");
        } else if (i == 0 && request->recording != NULL) {
            code = measure_pixels(request, &scene, summary);
        }
        scene_file_free(&scene);
    }
    if (code == CLI_OK) {
        summary->bins = scale_bins_of(summary->scales, request->scene_count);
    }
    return code;
}

/* ---- output ------------------------------------------------------------------------------------------------------ */

static void add_numbers(cJSON *object, const char *key, const double *values, uint32_t count)
{
    cJSON *list = cJSON_AddArrayToObject(object, key);
    for (uint32_t i = 0; i < count; i++) {
        cJSON_AddItemToArray(list, cJSON_CreateNumber(values[i]));
    }
}

static void add_quantiles(cJSON *object, const char *key, const splat_scales *scales, double unit)
{
    cJSON *item = cJSON_AddObjectToObject(object, key);
    for (int q = 0; q < QUANTILES; q++) {
        double value = splat_scales_quantile(scales, quantile_share[q]) * unit;
        cJSON_AddNumberToObject(item, quantile_name[q], value);
    }
}

static void print_json(const scene_info_request *request, const scene_summaries *summary)
{
    cJSON *root = cJSON_CreateObject();
    if (summary->pixels > 0) {
        cJSON_AddNumberToObject(root, "median_depth", summary->depth);
        cJSON_AddNumberToObject(root, "pixels_per_unit", summary->pixels);
    }
    double edges[SCALE_BINS_MOST + 1];
    for (uint32_t b = 0; b <= summary->bins.count; b++) {
        edges[b] = scale_bins_edge(&summary->bins, b);
    }
    add_numbers(root, "scale_edges", edges, summary->bins.count + 1);
    cJSON *list = cJSON_AddArrayToObject(root, "scenes");
    for (uint32_t i = 0; i < request->scene_count; i++) {
        const scene_summary *scene = &summary->scene[i];
        uint32_t counts[SCALE_BINS_MOST];
        scale_bins_fill(&summary->bins, &summary->scales[i], counts);
        cJSON *item = cJSON_CreateObject();
        cJSON_AddStringToObject(item, "scene", request->scenes[i]);
        json_add_integer(item, "gaussians", scene->count);
        add_numbers(item, "low", scene->low, 3);
        add_numbers(item, "high", scene->high, 3);
        cJSON_AddNumberToObject(item, "mean_opacity", scene->opacity);
        add_quantiles(item, "scale", &summary->scales[i], 1);
        if (summary->pixels > 0) {
            add_quantiles(item, "scale_pixels", &summary->scales[i], summary->pixels);
        }
        json_add_integers(item, "scale_counts", counts, summary->bins.count);
        cJSON_AddItemToArray(list, item);
    }
    json_print(root);
}

static void print_quantiles(const char *title, const splat_scales *scales, double unit)
{
    printf("  %-9s", title);
    for (int q = 0; q < QUANTILES; q++) {
        printf("%s%s %.4g", q == 0 ? "" : ", ", quantile_name[q],
               splat_scales_quantile(scales, quantile_share[q]) * unit);
    }
    putchar('\n');
}

static void print_text(const scene_info_request *request, const scene_summaries *summary)
{
    for (uint32_t i = 0; i < request->scene_count; i++) {
        const scene_summary *s = &summary->scene[i];
        printf("%s: %" PRIu32 " Gaussians\n", request->scenes[i], s->count);
        printf("  %-9s%.4g..%.4g, %.4g..%.4g, %.4g..%.4g\n", "x, y, z:", s->low[0], s->high[0], s->low[1], s->high[1],
               s->low[2], s->high[2]);
        printf("  %-9s%s\n", "up:", s->up != T3R_UP_UNKNOWN ? scene_up_name(s->up) : UP_UNKNOWN);
        printf("  %-9s%.3f in the mean\n", "opacity:", s->opacity);
        print_quantiles("scale:", &summary->scales[i], 1);
        if (summary->pixels > 0) {
            print_quantiles("pixels:", &summary->scales[i], summary->pixels);
        }
    }
    if (summary->pixels > 0) {
        printf("pixels of frame %" PRIu32 " of %s at the median depth, %.4g\n", request->view, request->recording_path,
               summary->depth);
    }
}

static int write_svg(const scene_info_request *request, const scene_summaries *summary)
{
    t3r_whole_file file;
    char error[ERROR_BYTES] = "";
    scale_panel panels[SCENE_INFO_MOST];
    char names[SCENE_INFO_MOST][PANEL_NAME_BYTES];
    for (uint32_t i = 0; i < request->scene_count; i++) {
        const char *slash = strrchr(request->scenes[i], '/'), *name = slash != NULL ? slash + 1 : request->scenes[i];
        snprintf(names[i], sizeof names[i], "%.*s", (int)(strrchr(name, '.') - name), name);
        panels[i] = (scale_panel){names[i], &summary->scales[i]};
    }
    if (whole_file_begin(&file, request->svg, error, sizeof error) != 0) {
        return cli_error(CLI_BAD_INPUT, "%s", error);
    }
    scale_picture_write(file.stream, panels, request->scene_count, &summary->bins, summary->pixels);
    return t3r_whole_file_commit(&file, NULL, error, sizeof error) == 0 ? CLI_OK
                                                                        : cli_error(CLI_BAD_INPUT, "%s", error);
}

int scene_info(const scene_info_request *request)
{
    scene_summaries summary = {0};
    int code = summarise_all(request, &summary);
    if (code == CLI_OK && request->svg != NULL) {
        code = write_svg(request, &summary);
    }
    if (code == CLI_OK && request->json) {
        print_json(request, &summary);
    } else if (code == CLI_OK) {
        print_text(request, &summary);
    }
    for (uint32_t i = 0; i < request->scene_count; i++) {
        splat_scales_free(&summary.scales[i]);
    }
    return code;
}
