/* SPDX-License-Identifier: Apache-2.0 */
#include "reconstruction/reconstruction_error.h"

#include <inttypes.h>

#include "cli/cli.h"

int reconstruction_error(t3r_status status, const char *what, const t3r_config *config, size_t arena_bytes)
{
    t3r_plan_info plan = {0};
    if (status == T3R_ERR_CONFIG && config != NULL) {
        char reason[T3R_ERROR_BYTES];
        return cli_error(CLI_BAD_USAGE, "%s: %s", what, t3r_plan_error(status, config, &plan, reason, sizeof reason));
    }
    if (status == T3R_ERR_ARENA && config != NULL && t3r_plan(config, &plan) == T3R_OK) {
        return cli_error(CLI_BUDGET_TOO_SMALL,
                         "the arena of %zu bytes is too small: %zu are needed at least, %zu for full speed (--arena)",
                         arena_bytes, plan.min_bytes, plan.bytes);
    }
    return cli_error(CLI_BAD_INPUT, "%s: %s", what, t3r_error_text(status));
}

int reconstruction_view_error(t3r_status status, const t3r_runtime *runtime, const char *path, uint32_t index,
                              const t3r_capture_frame *frame)
{
    char reason[T3R_ERROR_BYTES];
    return cli_error(CLI_BAD_INPUT, "%s%sframe %" PRIu32 ": %s", path != NULL ? path : "", path != NULL ? ": " : "",
                     index, t3r_add_view_error(status, runtime, &frame->frame, &frame->camera, reason, sizeof reason));
}

int reconstruction_render_error(t3r_status status, const char *what, const t3r_runtime *runtime,
                                const t3r_camera *camera, const t3r_target *target)
{
    char reason[T3R_ERROR_BYTES];
    return cli_error(CLI_BAD_INPUT, "%s: %s", what,
                     t3r_render_error(status, runtime, camera, target, reason, sizeof reason));
}
