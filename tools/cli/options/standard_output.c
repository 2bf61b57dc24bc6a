/* SPDX-License-Identifier: Apache-2.0 */
/* The state here is per process: the descriptor that was standard output. */
#include "cli/options/standard_output.h"

#include <fcntl.h>
#include <string.h>
#include <unistd.h>

static int kept = -1;

int standard_output_keep(void)
{
    kept = fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, STDERR_FILENO + 1);
    return kept >= 0 && dup2(STDERR_FILENO, STDOUT_FILENO) >= 0 ? 0 : -1;
}

bool standard_output_is(const char *path)
{
    return kept >= 0 && strcmp(path, STANDARD_OUTPUT_WORD) == 0;
}

FILE *standard_output_open(void)
{
    const int descriptor = fcntl(kept, F_DUPFD_CLOEXEC, STDERR_FILENO + 1);
    FILE *stream = descriptor >= 0 ? fdopen(descriptor, "wb") : NULL;
    if (stream == NULL && descriptor >= 0) {
        close(descriptor);
    }
    return stream;
}
