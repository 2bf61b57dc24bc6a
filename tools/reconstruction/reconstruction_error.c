/* SPDX-License-Identifier: Apache-2.0 */
#include "reconstruction/reconstruction_error.h"

#include "cli/cli.h"

int reconstruction_error(t3r_status status, const char *what, const t3r_config *config, size_t arena_bytes)
{
    if (status == T3R_ERR_CONFIG && config != NULL && t3r_config_error(config) != NULL) {
        return cli_error(CLI_BAD_USAGE, "%s: %s", what, t3r_config_error(config));
    }
    t3r_plan_info plan;
    if (status == T3R_ERR_ARENA && config != NULL && t3r_plan(config, &plan) == T3R_OK) {
        return cli_error(CLI_BUDGET_TOO_SMALL,
                         "the arena of %zu bytes is too small: %zu are needed at least, %zu for full speed (--arena)",
                         arena_bytes, plan.min_bytes, plan.bytes);
    }
    return cli_error(CLI_BAD_INPUT, "%s: %s", what, t3r_error_text(status));
}
