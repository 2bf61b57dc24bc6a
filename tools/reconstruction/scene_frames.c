/* SPDX-License-Identifier: Apache-2.0 */
#include "reconstruction/scene_frames.h"

#include <inttypes.h>
#include <stdlib.h>

#include "cli/cli.h"
#include "reconstruction/developed_frame.h"
#include "reconstruction/splat_depth.h"

int scene_to_prune(const char *path, int flags, scene_file *scene)
{
    char error[512] = "";
    return scene_file_read(path, flags, scene, error, sizeof error) == 0 ? CLI_OK
                                                                         : cli_error(CLI_BAD_INPUT, "%s", error);
}

static int make_frame(scene_frames *made, uint32_t view, const scene_file *scene, const char *scene_path,
                      const t3r_recording *recording, const char *path, uint32_t index, uint32_t width, uint32_t height,
                      t3r_capture_frame *frame)
{
    splat_depth depth;
    made->rgb[view] = malloc((size_t)width * height * 3);
    int code = made->rgb[view] == NULL
                   ? cli_error(CLI_BAD_INPUT, "out of memory")
                   : developed_frame(recording, path, index, width, height, made->rgb[view], NULL, &frame->camera);
    if (code != CLI_OK) {
        return code;
    }
    bool done = splat_depth_make(&depth, scene, &frame->camera, width, height);
    made->depth[view] = depth.steps;
    if (!done) {
        return cli_error(CLI_BAD_INPUT, "out of memory");
    }
    if (depth.seen == 0) {
        return cli_error(CLI_BAD_INPUT,
                         "%s: frame %" PRIu32 " of %s sees none of its %" PRIu32
                         " Gaussians: its views belong in --context, its world is the recording's",
                         scene_path, index, path, scene->count);
    }
    frame->frame = (t3r_frame){.format = T3R_PIXEL_RGB24,
                               .width = width,
                               .height = height,
                               .planes = {made->rgb[view]},
                               .stride_bytes = {width * 3},
                               .depth = depth.steps,
                               .depth_width = width,
                               .depth_height = height,
                               .depth_stride_bytes = width * 2,
                               .depth_unit_q40 = depth.unit_q40};
    return CLI_OK;
}

int scene_frames_make(scene_frames *made, const char *scene, int flags, const t3r_recording *recording,
                      const char *path, const uint32_t *context, uint32_t count, uint32_t width, uint32_t height,
                      t3r_capture_frame *frames)
{
    scene_file read;
    double start = cli_now();
    *made = (scene_frames){0};
    int code = scene_to_prune(scene, flags, &read);
    if (code != CLI_OK) {
        return code;
    }
    made->gaussians = read.count;
    for (uint32_t v = 0; v < count && code == CLI_OK; v++) {
        code = make_frame(made, v, &read, scene, recording, path, context[v], width, height, &frames[v]);
    }
    scene_file_free(&read);
    made->seconds = cli_now() - start;
    return code;
}

void scene_frames_free(scene_frames *made)
{
    for (uint32_t v = 0; v < T3R_MAX_VIEWS; v++) {
        free(made->rgb[v]);
        free(made->depth[v]);
    }
    *made = (scene_frames){0};
}
