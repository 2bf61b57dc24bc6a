/* SPDX-License-Identifier: Apache-2.0 */
#include "study/rivals/tuning/rounds.h"

#include <math.h>

#define PUP_FIRST 0.2 /* share that its first round keeps */

uint32_t rounds_published(method_kind kind)
{
    static const uint32_t rounds[METHOD_KIND_COUNT] = {
        [METHOD_TRIM3R] = 1,        [METHOD_RANDOM] = 1, [METHOD_EAGLES] = 5,
        [METHOD_LIGHTGAUSSIAN] = 1, [METHOD_PUP] = 2,    [METHOD_EFFICIENTGS] = 3,
    };
    return rounds[kind];
}

uint32_t rounds_left(method_kind kind, uint32_t all, uint32_t budget, uint32_t round, uint32_t rounds)
{
    if (round + 1 >= rounds || budget >= all) {
        return budget;
    }
    const double share = (double)budget / all;
    const double left = kind == METHOD_PUP && rounds == 2 ? PUP_FIRST : pow(share, (round + 1.0) / rounds);
    return (uint32_t)fmax(budget, nearbyint(left * all));
}

uint32_t rounds_iterations(uint32_t iterations, uint32_t round, uint32_t rounds)
{
    const uint32_t each = iterations / rounds;
    return round + 1 < rounds ? each : iterations - each * (rounds - 1);
}
