/* SPDX-License-Identifier: Apache-2.0 */
#include "reconstruction/context/context_frames.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#include "cli/cli.h"
#include "cli/files/recorded_frame.h"
#include "reconstruction/context/context_choice.h"
#include "reconstruction/context/view_surface.h"

#define SHARED_LEAST 0.1 /* of a frame's surface */

static int list_all(const t3r_recording *recording, const char *path, uint32_t except, uint32_t frames[T3R_MAX_VIEWS],
                    uint32_t *count)
{
    const uint32_t there = t3r_recording_frame_count(recording);
    for (uint32_t i = 0; i < there; i++) {
        if (i != except && *count == T3R_MAX_VIEWS) {
            return cli_error(CLI_BAD_INPUT,
                             "%s: the recording holds %" PRIu32 " frames, and a scene is made of at most %u: "
                             "--context auto chooses them",
                             path, there, T3R_MAX_VIEWS);
        }
        if (i != except) {
            frames[(*count)++] = i;
        }
    }
    return CLI_OK;
}

int context_frames(const t3r_recording *recording, const char *path, const reconstruction_options *options,
                   uint32_t except, uint32_t frames[T3R_MAX_VIEWS], uint32_t *count)
{
    *count = options->context_count;
    memcpy(frames, options->context, sizeof options->context);
    switch (options->context_kind) {
    case CONTEXT_ALL:
        return list_all(recording, path, except, frames, count);
    case CONTEXT_AUTO:
        return context_choose(recording, path, options->config.depth, except, frames, count);
    case CONTEXT_LISTED:
        break;
    }
    if (*count == 0) {
        *count = t3r_recording_frame_count(recording) < 2 ? 1 : 2;
        frames[0] = 0;
        frames[1] = 1;
    }
    return CLI_OK;
}

int context_resolve(reconstruction_options *options, const t3r_recording *recording, const char *path)
{
    uint32_t frames[T3R_MAX_VIEWS], count;
    const int code = context_frames(recording, path, options, CONTEXT_NO_FRAME, frames, &count);
    if (code == CLI_OK) {
        memcpy(options->context, frames, sizeof options->context);
        options->context_count = count;
        options->context_kind = CONTEXT_LISTED;
    }
    return code;
}

/* Looks at the context frames. Returns an exit status of cli.h, without a message. */
static int look(const t3r_recording *recording, const char *path, const reconstruction_options *options,
                view_surface *surfaces)
{
    char dropped[1];
    int code = surfaces != NULL ? CLI_OK : CLI_BAD_INPUT;
    cli_keep_errors(dropped, sizeof dropped);
    for (uint32_t v = 0; v < options->context_count && code == CLI_OK; v++) {
        t3r_capture_frame frame;
        code = recorded_frame_read(recording, path, options->context[v], &frame);
        code = code == CLI_OK ? view_surface_make(&surfaces[v], &frame, path, options->context[v], true) : code;
        code = code == CLI_OK && !surfaces[v].measured ? CLI_BAD_INPUT : code;
    }
    cli_keep_errors(NULL, 0);
    return code;
}

/* Warns of view v unless another view shares its surface; of two views once. */
static void warn_of_stranger(const view_surface *surfaces, uint32_t v, const uint32_t *context, uint32_t count)
{
    uint32_t best = v;
    double most = -1;
    for (uint32_t other = 0; other < count; other++) {
        if (other == v) {
            continue;
        }
        const double ours = view_surface_shared(&surfaces[v], &surfaces[other]);
        const double theirs = view_surface_shared(&surfaces[other], &surfaces[v]);
        const double shared = ours > theirs ? ours : theirs;
        if (shared > most) {
            most = shared;
            best = other;
        }
    }
    if (most >= 0 && most < SHARED_LEAST && (count > 2 || v == 0)) {
        (void)cli_error(CLI_OK,
                        "warning: frames %" PRIu32 " and %" PRIu32 " share %.0f %% of their surface%s: do they show "
                        "one place, with right poses?",
                        context[v], context[best], 100 * most,
                        count > 2 ? ", and no other context frame shares more with the first" : "");
    }
}

void context_warn_of_strangers(const t3r_recording *recording, const char *path, const reconstruction_options *options)
{
    if (options->config.depth != T3R_DEPTH_SENSOR || options->context_count < 2 || options->points_of != NULL) {
        return; /* stereo says itself what it cannot match */
    }
    view_surface *surfaces = calloc(options->context_count, sizeof *surfaces);
    if (look(recording, path, options, surfaces) == CLI_OK) {
        for (uint32_t v = 0; v < options->context_count; v++) {
            warn_of_stranger(surfaces, v, options->context, options->context_count);
        }
    }
    free(surfaces);
}
