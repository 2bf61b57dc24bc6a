/* SPDX-License-Identifier: Apache-2.0 */
/* runtime/layout/arena.c with every configuration that t3r_config_check() accepts: each field that decides a size has
 * the full range of runtime/core/config.c. Unsigned overflow counts as an alarm, too. */
#include "core/config.h"
#include "layout/arena.h"

static uint32_t any(uint32_t low, uint32_t high)
{
    return (uint32_t)t3r_any(low, high);
}

int main(void)
{
    const t3r_config config = {
        .width = any(8, T3R_MAX_SIDE),
        .height = any(8, T3R_MAX_SIDE),
        .views = any(0, T3R_MAX_VIEWS),
        .max_gaussians = any(1, T3R_MAX_GAUSSIANS),
        .gaussians = any(1, T3R_MAX_GAUSSIANS),
        .render_width = any(1, T3R_MAX_SIDE),
        .render_height = any(1, T3R_MAX_SIDE),
        .levels = any(1, T3R_MAX_LEVELS),
        .clusters = any(0, T3R_MAX_CLUSTERS),
        .allocate = (t3r_allocation)any(0, T3R_ALLOCATE_COUNT - 1),
        .head_column_bytes = any(0, T3R_MAX_HEAD_COLUMN_BYTES),
        .refine = any(0, T3R_MAX_REFINE),
        .depth = (t3r_depth)any(0, T3R_DEPTH_COUNT - 1),
        .keep_analysis = any(0, 1),
        .warm = any(0, 1),
        .stream = any(0, 1),
        .tile_splats = any(0, T3R_MAX_GAUSSIANS),
        .workers = any(1, T3R_MAX_WORKERS),
    };
    t3r_layout layout = {0};
    t3r_most_arena_bytes(&config);
    t3r_lay_out(&config, 0, &layout);
    return 0;
}
