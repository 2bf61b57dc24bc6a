/* SPDX-License-Identifier: Apache-2.0 */
/* Builds the scene of the views that were added: exactly a budget, or the fewest Gaussians that suffice. */
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>

#include "api/least.h"
#include "cli/cli.h"
#include "reconstruction/reconstruction.h"

/* Reports which frames give no depth together, and why. */
static int stereo_error(const t3r_runtime *runtime, const reconstruction *r, const char *path)
{
    uint32_t partner;
    t3r_pair pair = t3r_stereo_pair(runtime, 0, &partner);
    return cli_error(CLI_BAD_INPUT, "%s: frames %" PRIu32 " and %" PRIu32 " give no depth%s: %s", path, r->context[0],
                     r->context[partner], r->context_count > 2 ? ", nor any other two" : "", t3r_pair_text(pair));
}

int reconstruction_make_error(const reconstruction *r, t3r_status status, const char *what)
{
    return status == T3R_ERR_STEREO ? stereo_error(r->runtime, r, what)
                                    : cli_error(CLI_BAD_INPUT, "%s: %s", what, r->reason);
}

/* Builds a scene; r->reason gets the reason of an error. */
static t3r_status make(reconstruction *r, const t3r_request *request)
{
    const t3r_status status = t3r_reconstruct(r->runtime, request, &r->scene);
    if (status != T3R_OK) {
        (void)t3r_reconstruct_error(status, r->runtime, request, &r->scene, r->reason, sizeof r->reason);
    }
    return status;
}

/* Analyses the views by building a scene of one Gaussian. */
static t3r_status analyse(reconstruction *r, t3r_request request)
{
    request.gaussians = 1;
    return make(r, &request);
}

/* Builds the fewest Gaussians that draw the context views at options->min_psnr. */
static t3r_status make_least(reconstruction *r, const reconstruction_options *options, t3r_request request)
{
    const uint32_t width = r->config.width, height = r->config.height;
    uint8_t *rgb = malloc((size_t)width * height * 3);
    const t3r_target picture = {.width = width, .height = height, .rgb = rgb, .rgb_stride_bytes = 3 * width};
    t3r_status status = T3R_ERR_ARENA;
    if (rgb != NULL) {
        status = analyse(r, request);
    } else {
        snprintf(r->reason, sizeof r->reason, "out of memory");
    }
    if (status == T3R_OK) {
        const uint32_t psnr_q8 = (uint32_t)(options->min_psnr * 256 + 0.5);
        status = t3r_rebuild_least_counted(r->runtime, &request, psnr_q8, &picture, (const uint8_t *const *)r->shown,
                                           &r->scene, &r->least);
        (void)t3r_rebuild_least_error(status, r->runtime, &request, psnr_q8, &picture, &r->scene, &r->least, r->reason,
                                      sizeof r->reason);
    }
    free(rgb);
    return status;
}

/* Builds the fewest Gaussians that lose at most options->max_loss. */
static t3r_status make_automatic(reconstruction *r, const reconstruction_options *options, t3r_request request)
{
    const t3r_status status = analyse(r, request);
    request.gaussians = r->config.gaussians;
    return status == T3R_OK ? measured_loss_build(r->runtime, &r->config, &request, options->max_loss, &r->scene,
                                                  &r->loss, r->reason)
                            : status;
}

t3r_status reconstruction_make(reconstruction *r, const reconstruction_options *options, const uint16_t *const *planes)
{
    const t3r_request request = {.importance = planes, .importance_stride_bytes = r->config.width * 2};
    return options->min_psnr > 0 ? make_least(r, options, request)
           : options->automatic  ? make_automatic(r, options, request)
                                 : make(r, &request);
}
