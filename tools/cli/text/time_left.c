/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/text/time_left.h"

double cli_time_left(uint32_t before, uint32_t done, uint32_t total, double elapsed)
{
    if (done >= total) {
        return 0;
    }
    return done > before ? elapsed / (done - before) * (total - done) : -1;
}
