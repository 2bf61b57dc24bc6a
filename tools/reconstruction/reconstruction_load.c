/* SPDX-License-Identifier: Apache-2.0 */
/* A run with a scene from a file: it only renders. */
#include <inttypes.h>
#include <math.h>

#include "cli/cli.h"
#include "reconstruction/reconstruction.h"
#include "reconstruction/reconstruction_error.h"
#include "scene/scene_append.h"

static int append_loaded(reconstruction *r, const scene_eye *eye)
{
    uint32_t index = 0;
    t3r_status status = scene_append_all(r->runtime, &r->loaded, eye, &index);
    if (status != T3R_OK && index > 0) {
        char reason[T3R_ERROR_BYTES];
        return cli_error(
            CLI_BAD_INPUT, "Gaussian %" PRIu32 ": %s", index - 1,
            t3r_scene_append_error(status, r->runtime, &r->loaded.gaussians[index - 1], reason, sizeof reason));
    }
    if (status == T3R_OK) {
        status = t3r_get_scene(r->runtime, &r->scene);
    }
    return status == T3R_OK ? CLI_OK : reconstruction_error(status, "scene", &r->config, r->arena_bytes);
}

int reconstruction_look_from(reconstruction *r, const t3r_camera *camera, uint32_t width, uint32_t height)
{
    if (r->loaded.gaussians == NULL) {
        return CLI_OK;
    }
    const scene_eye eye = {camera, width, height};
    const bool was_seen = r->is_seen;
    r->seen = scene_seen_from(&r->loaded, &eye);
    r->is_seen = scene_differs(&r->loaded, &r->seen);
    return was_seen || r->is_seen ? append_loaded(r, &eye) : CLI_OK;
}

double reconstruction_depth(const reconstruction *r, uint32_t depth_q20)
{
    return ldexp(seen_depth(&r->seen, depth_q20), r->scene.frame.exponent);
}

static int load(reconstruction *r, uint32_t width, uint32_t height, const reconstruction_options *options)
{
    uint32_t count = r->loaded.count == 0 ? 1 : r->loaded.count;
    r->config = t3r_default_config(T3R_MIN_SIDE, T3R_MIN_SIDE, 0, count);
    r->config.render_width = width;
    r->config.render_height = height;
    r->config.tile_splats = options->config.tile_splats;
    int code = reconstruction_open_arena(r, options);
    if (code != CLI_OK) {
        return code;
    }
    return append_loaded(r, NULL);
}

int reconstruction_load(reconstruction *r, scene_file *scene, uint32_t width, uint32_t height,
                        const reconstruction_options *options)
{
    *r = (reconstruction){.loaded = *scene};
    *scene = (scene_file){0};
    int code = load(r, width, height, options);
    if (code != CLI_OK) {
        reconstruction_close(r);
    }
    return code;
}
