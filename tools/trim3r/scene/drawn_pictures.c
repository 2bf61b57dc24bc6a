/* SPDX-License-Identifier: Apache-2.0 */
#include "trim3r/scene/drawn_pictures.h"

#include <math.h>
#include <stdlib.h>

#include "cli/cli.h"
#include "cli/files/recorded_frame.h"
#include "pictures/metrics.h"
#include "reconstruction/context/corrected_views.h"
#include "reconstruction/context/view_surface.h"
#include "reconstruction/developed_frame.h"
#include "reconstruction/reconstruction_error.h"

#define ALPHA_HALF 16384u /* of a runtime's alpha_q15: less is empty */

typedef struct drawing {
    const t3r_recording *recording;
    const char *path;
    reconstruction *r;
    corrected_views corrected;
    uint8_t *rgb, *drawn, *shown;
    uint16_t *alpha;
} drawing;

/* Draws frame out->frame from `camera` (NULL: from its recorded one, corrected as the context views around it). */
static int draw(const drawing *d, const t3r_camera *camera, drawn_picture *out)
{
    const uint32_t width = d->r->config.width, height = d->r->config.height;
    const size_t pixels = (size_t)width * height;
    const t3r_target target = {.width = width,
                               .height = height,
                               .rgb = d->drawn,
                               .rgb_stride_bytes = width * 3,
                               .alpha_q15 = d->alpha,
                               .alpha_stride_bytes = width * 2};
    t3r_camera recorded;
    t3r_capture_frame frame;
    int code = recorded_frame_read(d->recording, d->path, out->frame, &frame);
    code =
        code == CLI_OK ? developed_capture(&frame, d->path, out->frame, width, height, d->rgb, NULL, &recorded) : code;
    code = code == CLI_OK ? developed_shown(&frame, d->path, out->frame, width, height, d->shown) : code;
    if (code != CLI_OK) {
        return code;
    }
    double gain[3];
    const t3r_camera moved = corrected_views_camera(&d->corrected, &recorded, gain);
    const t3r_status status = t3r_render(d->r->runtime, camera != NULL ? camera : &moved, &target);
    if (status != T3R_OK) {
        return reconstruction_error(status, d->path, &d->r->config, d->r->arena_bytes);
    }
    corrected_views_expose(d->drawn, pixels, gain);
    uint32_t empty = 0, shown = 0;
    for (size_t i = 0; i < pixels; i++) {
        shown += d->shown[i] != 0;
        empty += d->shown[i] != 0 && d->alpha[i] < ALPHA_HALF;
    }
    out->psnr = metric_psnr(d->rgb, d->drawn, d->shown, width, height);
    out->empty = (double)empty / (double)shown;
    return CLI_OK;
}

static int draw_context(const drawing *d, const reconstruction_account *account, drawn_picture *pictures,
                        uint32_t *count)
{
    int code = CLI_OK;
    for (uint32_t v = 0; v < account->context_count && code == CLI_OK; v++) {
        drawn_picture *out = &pictures[(*count)++];
        const t3r_pair pair = t3r_stereo_pair(d->r->runtime, v, NULL);
        *out = (drawn_picture){.frame = account->context[v], .used = true};
        out->no_depth = d->r->config.depth == T3R_DEPTH_STEREO && pair != T3R_PAIR_OK ? t3r_pair_text(pair) : NULL;
        code = draw(d, account->has_cameras ? &account->camera[v] : NULL, out);
    }
    return code;
}

static bool is_drawn(const drawn_picture *pictures, uint32_t count, uint32_t frame)
{
    bool is = false;
    for (uint32_t i = 0; i < count; i++) {
        is = is || pictures[i].frame == frame;
    }
    return is;
}

/* Draws frames that the scene was not made of, without a message where one cannot be read. */
static void draw_others(const drawing *d, drawn_picture *pictures, uint32_t *count)
{
    const uint32_t frames = t3r_recording_frame_count(d->recording), used = *count;
    const uint32_t step = (frames - used + DRAWN_OTHERS - 1) / DRAWN_OTHERS;
    char dropped[1];
    uint32_t others = 0;
    cli_keep_errors(dropped, sizeof dropped);
    for (uint32_t i = 0; i < frames && *count < used + DRAWN_OTHERS; i++) {
        t3r_capture_frame frame;
        drawn_picture other = {.frame = i};
        if (!is_drawn(pictures, used, i) && others++ % step == 0 &&
            recorded_frame_read(d->recording, d->path, i, &frame) == CLI_OK && draw(d, NULL, &other) == CLI_OK) {
            pictures[(*count)++] = other;
        }
    }
    cli_keep_errors(NULL, 0);
}

static void mark_blurred(const drawing *d, drawn_picture *pictures, uint32_t count)
{
    double sharpness[DRAWN_MOST] = {0};
    for (uint32_t i = 0; i < count; i++) {
        t3r_capture_frame frame;
        view_surface surface;
        if (recorded_frame_read(d->recording, d->path, pictures[i].frame, &frame) == CLI_OK &&
            view_surface_make(&surface, &frame, d->path, pictures[i].frame, false) == CLI_OK) {
            sharpness[i] = surface.sharpness;
        }
    }
    const double usual = view_sharpness_usual(sharpness, count);
    for (uint32_t i = 0; i < count; i++) {
        pictures[i].blurred = view_sharpness_is_blurred(sharpness[i], usual);
    }
}

int drawn_pictures(const t3r_recording *recording, const char *path, reconstruction *r,
                   const reconstruction_account *account, drawn_picture pictures[DRAWN_MOST], uint32_t *count)
{
    const size_t pixels = (size_t)r->config.width * r->config.height;
    drawing d = {.recording = recording,
                 .path = path,
                 .r = r,
                 .rgb = malloc(3 * pixels),
                 .drawn = malloc(3 * pixels),
                 .shown = malloc(pixels),
                 .alpha = malloc(2 * pixels)};
    const bool counted = r->uncounted;
    *count = 0;
    r->uncounted = true;
    int code = d.rgb != NULL && d.drawn != NULL && d.shown != NULL && d.alpha != NULL
                   ? corrected_views_of(recording, path, account, &d.corrected)
                   : cli_error(CLI_BAD_INPUT, "out of memory");
    code = code == CLI_OK ? draw_context(&d, account, pictures, count) : code;
    if (code == CLI_OK) {
        draw_others(&d, pictures, count);
        mark_blurred(&d, pictures, *count);
    }
    r->uncounted = counted;
    cli_progress_end();
    free(d.alpha);
    free(d.shown);
    free(d.drawn);
    free(d.rgb);
    return code;
}
