/* SPDX-License-Identifier: Apache-2.0 */
#define _GNU_SOURCE /* of the C library: a process may be bound to some of the processors */
#include <sched.h>

#include "trim3r_host.h"

uint32_t t3r_cpu_count(void)
{
    cpu_set_t allowed;
    const int count = sched_getaffinity(0, sizeof allowed, &allowed) == 0 ? CPU_COUNT(&allowed) : 1;
    return count > T3R_MAX_THREADS ? T3R_MAX_THREADS : (uint32_t)count;
}
