/* SPDX-License-Identifier: Apache-2.0 */
#include "reconstruction/lens_masks.h"

#include <stdlib.h>

#include "cli/cli.h"
#include "reconstruction/developed_frame.h"

int lens_mask_find(reconstruction *r, const reconstruction_options *options, const char *path, uint32_t view,
                   const t3r_capture_frame *frame)
{
    const uint32_t width = r->config.width, height = r->config.height;
    free(r->shown[view]);
    r->shown[view] = NULL;
    if (options->min_psnr == 0 || frame->camera.distortion == T3R_DISTORTION_NONE) {
        return CLI_OK;
    }
    r->shown[view] = malloc((size_t)width * height);
    return r->shown[view] != NULL ? developed_shown(frame, path, frame->index, width, height, r->shown[view])
                                  : cli_error(CLI_BAD_INPUT, "out of memory");
}
