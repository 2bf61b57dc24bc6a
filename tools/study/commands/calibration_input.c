/* SPDX-License-Identifier: Apache-2.0 */
#include "study/commands/calibration_input.h"

#include <stdlib.h>
#include <string.h>

#include "cli/cli.h"
#include "import/folders/planar_recording.h"
#include "import/import_source.h"
#include "reconstruction/reconstruction.h"
#include "reconstruction/reconstruction_error.h"
#include "recording/recording.h"

/* Adds one scene of the context frames for every budget. */
static int add_scene(calibration *c, const t3r_recording *recording, const char *path, const uint32_t *context,
                     uint32_t count)
{
    static const double budgets[] = CALIBRATION_BUDGETS;
    const uint32_t budget_count = sizeof budgets / sizeof *budgets;
    reconstruction_options settings;
    reconstruction_defaults(&settings);
    settings.keep_percent = 100; /* sizes the arena for the largest scene */
    settings.config.keep_analysis = 1;
    settings.hash = false;
    settings.config.refine = 0;
    settings.head = "analytic"; /* a head's input does not depend on the head */
    settings.context_count = count;
    memcpy(settings.context, context, count * sizeof *context);

    reconstruction r;
    int code = reconstruction_build(&r, recording, path, &settings);
    if (code != CLI_OK) {
        return code;
    }
    for (uint32_t i = 0; i < budget_count && code == CLI_OK; i++) {
        cli_progress("calibrate", i, budget_count);
        const t3r_request request = {.gaussians = reconstruction_budget(r.valid_points, budgets[i])};
        t3r_status status = t3r_rebuild(r.runtime, &request, &r.scene);
        if (status != T3R_OK) {
            code = reconstruction_error(status, path, &r.config, r.arena_bytes);
        } else if (calibration_add_views(c, r.runtime) != 0) {
            code = cli_error(CLI_BAD_INPUT, "out of memory");
        }
    }
    reconstruction_close(&r);
    return code;
}

static int add_recording(calibration *c, const char *path)
{
    t3r_recording *recording = import_source_open(path);
    if (recording == NULL) {
        return CLI_BAD_INPUT;
    }
    uint32_t frames = t3r_recording_frame_count(recording), triplets = t3r_recording_triplet_count(recording);
    uint32_t choices = triplets > 0 ? triplets : frames / 2;
    uint32_t pairs = choices < CALIBRATION_PAIRS ? choices : CALIBRATION_PAIRS;
    int code = CLI_OK;
    if (frames < 2) {
        code = add_scene(c, recording, path, (const uint32_t[]){0}, 1);
    }
    for (uint32_t i = 0; i < pairs && code == CLI_OK; i++) {
        uint32_t at = (uint32_t)((uint64_t)i * choices / pairs);
        uint32_t context[2] = {2 * at, 2 * at + 1};
        if (triplets > 0) {
            t3r_triplet triplet = t3r_recording_triplet(recording, at);
            memcpy(context, triplet.context, sizeof context);
        }
        code = add_scene(c, recording, path, context, 2);
    }
    t3r_recording_close(recording);
    return code;
}

static int add_image(calibration *c, char *path, uint32_t width, uint32_t height)
{
    uint8_t *bytes;
    t3r_recording *recording = planar_recording(path, width, height, &bytes);
    if (recording == NULL) {
        return CLI_BAD_INPUT;
    }
    int code = add_scene(c, recording, path, (const uint32_t[]){0}, 1);
    t3r_recording_close(recording);
    free(bytes);
    return code;
}

int calibration_input(calibration *c, char *path, uint32_t width, uint32_t height)
{
    size_t length = strlen(path);
    bool is_recording = length > 5 && strcmp(path + length - 5, ".mcap") == 0;
    return is_recording ? add_recording(c, path) : add_image(c, path, width, height);
}
