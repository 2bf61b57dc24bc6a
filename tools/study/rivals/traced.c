/* SPDX-License-Identifier: Apache-2.0 */
#include "study/rivals/traced.h"

#include <stdlib.h>

#include "cli/cli.h"
#include "study/rivals/scores/choose.h"

/* Reads the masks after a build that keeps its analysis. */
static int read_masks(traced_points *points, const reconstruction *r, const uint32_t *kept, uint32_t count)
{
    const size_t pixels = (size_t)r->config.width * r->config.height;
    for (uint32_t v = 0; v < r->context_count; v++) {
        points->planes[v] = malloc(pixels * sizeof *points->planes[v]);
        if (points->planes[v] == NULL) {
            return cli_error(CLI_BAD_INPUT, "out of memory");
        }
    }
    return rival_planes(r->runtime, &r->scene, r->context_count, kept, count, points->planes)
               ? CLI_OK
               : cli_error(CLI_BAD_INPUT, "the scene's Gaussians are not those of its masks");
}

int traced_points_make(traced_points *points, const t3r_recording *recording, const char *path,
                       const reconstruction_options *options, const uint32_t *kept, uint32_t count)
{
    /* masks depend on neither head nor refinement: use the cheapest */
    reconstruction_options plain = *options;
    plain.head = "none";
    plain.hide_mask = false;
    plain.config.refine = 0;
    plain.config.keep_analysis = 1;
    plain.hash = false;
    plain.arena = ARENA_FULL;
    *points = (traced_points){0};
    reconstruction r;
    int code = reconstruction_build(&r, recording, path, &plain);
    if (code == CLI_OK) {
        code = read_masks(points, &r, kept, count);
        reconstruction_close(&r);
    }
    return code;
}

void traced_points_free(traced_points *points)
{
    for (uint32_t v = 0; v < T3R_MAX_VIEWS; v++) {
        free(points->planes[v]);
    }
    *points = (traced_points){0};
}
