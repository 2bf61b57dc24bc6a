/* SPDX-License-Identifier: Apache-2.0 */
#include "trim3r.h"

t3r_status planted_open(t3r_runtime **rt, void *arena, size_t bytes, const t3r_config *config)
{
    return t3r_init(rt, arena, bytes, config);
}
