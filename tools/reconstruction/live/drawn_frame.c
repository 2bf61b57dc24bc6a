/* SPDX-License-Identifier: Apache-2.0 */
#include "reconstruction/live/drawn_frame.h"

#include <stdbool.h>
#include <stdlib.h>

#include "cli/cli.h"
#include "host/cpu.h"
#include "pictures/metrics.h"
#include "reconstruction/reconstruction_error.h"

#define HALF_Q15 (1u << 14)

int drawn_frame_open(drawn_frame *d, uint32_t width, uint32_t height)
{
    const t3r_config config = t3r_default_config(width, height, 1, 1);
    const size_t pixels = (size_t)width * height;
    t3r_plan_info plan;
    *d = (drawn_frame){.width = width, .height = height};
    t3r_status status = t3r_plan(&config, &plan);
    if (status != T3R_OK) {
        return reconstruction_error(status, "image stage", &config, 0);
    }
    d->target = malloc(pixels * 3);
    d->drawn = malloc(pixels * 3);
    d->mask = malloc(pixels);
    d->depth = malloc(pixels * sizeof *d->depth);
    d->alpha_q15 = malloc(pixels * sizeof *d->alpha_q15);
    if (d->target == NULL || d->drawn == NULL || d->mask == NULL || d->depth == NULL || d->alpha_q15 == NULL ||
        posix_memalign(&d->arena, T3R_ARENA_ALIGN, plan.min_bytes) != 0) {
        d->arena = NULL;
        return cli_error(CLI_BAD_INPUT, "out of memory");
    }
    status = t3r_init(&d->runtime, d->arena, plan.min_bytes, &config);
    status = status == T3R_OK ? t3r_set_cpu(d->runtime, t3r_cpu_features()) : status;
    return status == T3R_OK ? CLI_OK : reconstruction_error(status, "image stage", &config, plan.min_bytes);
}

void drawn_frame_close(drawn_frame *d)
{
    free(d->arena);
    free(d->target);
    free(d->drawn);
    free(d->mask);
    free(d->depth);
    free(d->alpha_q15);
    *d = (drawn_frame){0};
}

t3r_status drawn_frame_draw(drawn_frame *d, const reconstruction *r, const t3r_capture_frame *frame, drawn_mask mask)
{
    const bool has_alpha = mask == DRAWN_WITH_ALPHA;
    t3r_status status = t3r_develop(d->runtime, &frame->frame, &frame->camera, d->target, d->depth, &d->camera);
    if (status != T3R_OK) {
        return status;
    }
    const t3r_target target = {.width = d->width,
                               .height = d->height,
                               .rgb = d->drawn,
                               .rgb_stride_bytes = d->width * 3,
                               .alpha_q15 = has_alpha ? d->alpha_q15 : NULL,
                               .alpha_stride_bytes = has_alpha ? d->width * 2 : 0};
    status = t3r_render(r->runtime, &d->camera, &target);
    for (size_t i = 0; i < (size_t)d->width * d->height; i++) {
        const bool counts = frame->frame.depth != NULL && d->depth[i] != 0;
        d->mask[i] = counts && (!has_alpha || d->alpha_q15[i] >= HALF_Q15) ? 255 : 0;
    }
    return status;
}

double drawn_frame_psnr(const drawn_frame *d)
{
    return metric_psnr(d->target, d->drawn, d->mask, d->width, d->height);
}
