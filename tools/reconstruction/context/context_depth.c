/* SPDX-License-Identifier: Apache-2.0 */
#include "reconstruction/context/context_depth.h"

#include <math.h>
#include <stdlib.h>

#include "cli/cli.h"
#include "reconstruction/reconstruction.h"

static int ascending(const void *a, const void *b)
{
    const double p = *(const double *)a, q = *(const double *)b;
    return (p > q) - (p < q);
}

/* Returns the median depth of a scene's Gaussians before a camera; 0 if none is before it. */
static double median_depth(const t3r_scene *scene, const pinhole *camera)
{
    double *depths = malloc((scene->count + 1) * sizeof *depths), median = 0;
    uint32_t count = 0;
    for (uint32_t i = 0; i < scene->count && depths != NULL; i++) {
        double place[3], pixel[2];
        for (int k = 0; k < 3; k++) {
            place[k] = ldexp((double)scene->frame.origin_q32[k], -32) +
                       ldexp(scene->gaussians[i].position_q20[k], scene->frame.exponent - 20);
        }
        count += pinhole_project(camera, place, pixel, &depths[count]);
    }
    if (count > 0) {
        qsort(depths, count, sizeof *depths, ascending);
        median = depths[count / 2];
    }
    free(depths);
    return median;
}

double context_depth_of_pair(const t3r_recording *recording, const char *path, const view_surface *first, uint32_t a,
                             uint32_t b)
{
    enum { LONGEST = 192, GAUSSIANS = 500 };
    reconstruction_options options;
    reconstruction r;
    const uint32_t longest = first->width > first->height ? first->width : first->height;
    reconstruction_defaults(&options);
    options.config.depth = T3R_DEPTH_STEREO;
    options.config.width = longest > LONGEST ? first->width * LONGEST / longest : first->width;
    options.config.height = longest > LONGEST ? first->height * LONGEST / longest : first->height;
    options.config.allocate = T3R_ALLOCATE_UNIFORM;
    options.config.refine = options.config.rim = 0;
    options.head = "analytic";
    options.hash = false;
    options.gaussians = GAUSSIANS;
    options.context_count = 2;
    options.context[0] = a;
    options.context[1] = b;
    if (reconstruction_build(&r, recording, path, &options) != CLI_OK) {
        return 0;
    }
    const double depth = median_depth(&r.scene, &first->camera);
    reconstruction_close(&r);
    return depth;
}
