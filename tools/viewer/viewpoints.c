/* SPDX-License-Identifier: Apache-2.0 */
#include "viewer/viewpoints.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>

#include "cli/cli.h"
#include "cli/files/recorded_frame.h"
#include "reconstruction/developed_frame.h"
#include "viewer/start_view.h"

int viewpoints_add(viewpoints *v, const t3r_recording *recording, const char *path, uint32_t index, uint32_t width,
                   uint32_t height, bool with_depth)
{
    const size_t pixels = (size_t)width * height;
    if (v->count == BUNDLE_MOST_FRAMES) {
        return cli_error(CLI_BAD_USAGE, "a page holds at most %u frames", BUNDLE_MOST_FRAMES);
    }
    t3r_capture_frame recorded;
    int code = recorded_frame_read(recording, path, index, &recorded);
    if (code != CLI_OK) {
        return code;
    }
    with_depth = with_depth && recorded.frame.depth != NULL;
    bundle_frame *frame = &v->frames[v->count];
    snprintf(v->names[v->count], PAGE_NAME_BYTES, "frame %" PRIu32, index);
    v->count++;
    frame->depth_unit_q40 = recorded.frame.depth_unit_q40;
    frame->rgb = malloc(pixels * 3);
    frame->depth = with_depth ? malloc(pixels * sizeof *frame->depth) : NULL;
    if (frame->rgb == NULL || (with_depth && frame->depth == NULL)) {
        return cli_error(CLI_BAD_INPUT, "out of memory");
    }
    code = developed_capture(&recorded, path, index, width, height, frame->rgb, frame->depth, &frame->camera);
    if (code != CLI_OK || recorded.camera.distortion == T3R_DISTORTION_NONE) {
        return code;
    }
    frame->shown = malloc(pixels);
    return frame->shown != NULL ? developed_shown(&recorded, path, index, width, height, frame->shown)
                                : cli_error(CLI_BAD_INPUT, "out of memory");
}

bool viewpoints_middle(const uint32_t *context, uint32_t count, uint32_t *middle)
{
    *middle = count > 1 ? (context[0] + context[1]) / 2 : 0;
    return count > 1 && *middle != context[0] && *middle != context[1];
}

int viewpoints_add_before(viewpoints *v, const scene_file *scene, uint32_t width, uint32_t height)
{
    t3r_camera start;
    if (start_view(scene, width, height, &start) != 0) {
        return cli_error(CLI_BAD_INPUT, "out of memory");
    }
    v->frames[v->count] = (bundle_frame){.camera = start};
    snprintf(v->names[v->count], PAGE_NAME_BYTES, "the start");
    v->count++;
    return CLI_OK;
}

void viewpoints_free(viewpoints *v)
{
    for (uint32_t i = 0; i < v->count; i++) {
        free(v->frames[i].rgb);
        free(v->frames[i].depth);
        free(v->frames[i].shown);
    }
    v->count = 0;
}
