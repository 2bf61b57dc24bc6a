/* SPDX-License-Identifier: Apache-2.0 */
#include "import/poses/pose_losses.h"

#include <inttypes.h>
#include <stdarg.h>
#include <stdio.h>

#include "cli/cli.h"

void pose_losses_add(pose_losses *losses, uint64_t count, const char *format, ...)
{
    if (losses->count == 0) {
        va_list arguments;
        va_start(arguments, format);
        vsnprintf(losses->first, sizeof losses->first, format, arguments);
        va_end(arguments);
    }
    losses->count += count;
}

void pose_losses_add_repeated(pose_losses *losses, double seconds)
{
    pose_losses_add(losses, 1, "the time stamp %.6f is there twice", seconds);
}

int pose_losses_print(const pose_losses *losses, const char *path, bool strict)
{
    if (losses->count == 0) {
        return CLI_OK;
    }
    if (strict) {
        return cli_error(CLI_BAD_INPUT, "%s: --strict refuses %" PRIu64 " poses; the first: %s", path, losses->count,
                         losses->first);
    }
    return cli_error(CLI_OK, "warning: %s: poses left out: %" PRIu64 "; the first: %s", path, losses->count,
                     losses->first);
}
