/* SPDX-License-Identifier: Apache-2.0 */
/* Plans: the bytes that a configuration needs, and the configuration that an arena can hold. */
#include "arena.h"
#include "core/config.h"
#include "core/fixed.h"
#include "plan_checks.h"
#include "state/state.h"

t3r_status t3r_plan_bytes_as(uint64_t digest, const t3r_config *config, size_t *min_bytes, size_t *bytes)
{
    T3R_REFUSE_UNLESS(digest == t3r_header_interface(), T3R_ERR_INTERFACE);
    const t3r_status status = t3r_plan_bytes_checks(config, min_bytes, bytes, NULL);
    if (status == T3R_OK) {
        t3r_layout layout;
        (void)t3r_lay_out(config, 0, &layout); /* for the two sums */
        *min_bytes = layout.min_bytes;
        *bytes = layout.bytes;
    }
    return status;
}

t3r_status t3r_plan_as(uint64_t digest, const t3r_config *config, t3r_plan_info *plan)
{
    T3R_REFUSE_UNLESS(digest == t3r_header_interface(), T3R_ERR_INTERFACE);
    T3R_REFUSE_UNLESS(plan != NULL, T3R_ERR_ARGUMENT);
    const t3r_status status = t3r_plan_bytes_as(digest, config, &plan->min_bytes, &plan->bytes);
    if (status != T3R_OK) {
        return status;
    }
    t3r_layout layout;
    (void)t3r_lay_out(config, plan->bytes, &layout);
    plan->most_blends = (uint64_t)T3R_TILES_(config->render_width, config->render_height) *
                        T3R_MIN(t3r_tile_splats_of(config), config->max_gaussians);
    plan->buffer_count = T3R_BUFFER_COUNT;
    for (int b = 0; b < T3R_BUFFER_COUNT; b++) {
        t3r_plan_buffer *row = &plan->buffers[b];
        row->name = t3r_buffer_name((enum t3r_buffer)b);
        row->offset = layout.offset[b];
        row->bytes = layout.size[b];
        t3r_buffer_lifetime(config, (enum t3r_buffer)b, &row->first, &row->last);
    }
    return T3R_OK;
}

/* An arena too large to be addressed fits nowhere. */
static bool fits(const t3r_config *config, size_t bytes)
{
    t3r_layout layout;
    return t3r_config_check(config) == T3R_OK && t3r_lay_out(config, bytes, &layout) == T3R_OK;
}

t3r_status t3r_plan_within_as(uint64_t digest, size_t bytes, t3r_config *config)
{
    T3R_REFUSE_UNLESS(digest == t3r_header_interface(), T3R_ERR_INTERFACE);
    T3R_PASS(t3r_plan_within_checks(bytes, config, NULL));
    uint32_t low = 1, high = config->max_gaussians; /* `low` fits; an arena grows with its Gaussians */
    while (low < high) {                            /* halves at most 2^24 candidates */
        uint32_t middle = low + (high - low + 1) / 2;
        const t3r_config tried = t3r_with_room_for(config, middle);
        if (fits(&tried, bytes)) {
            low = middle;
        } else {
            high = middle - 1;
        }
    }
    *config = t3r_with_room_for(config, low);
    return T3R_OK;
}
