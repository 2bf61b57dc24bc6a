/* SPDX-License-Identifier: Apache-2.0 */
/* Any text as a machine of plans: a reason, or prices of a named machine. */
#include <stdlib.h>

#include "planning/machine.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    machine m;
    char error[256] = "";
    const int result = machine_parse(&m, (const char *)data, size, error, sizeof error);
    if ((result != 0) != (error[0] != '\0') || (result == 0 && (m.threads < 1 || m.threads > T3R_MAX_WORKERS))) {
        abort();
    }
    return 0;
}
