/* SPDX-License-Identifier: Apache-2.0 */
/* The best settings for a size of RAM. */
#include "arena.h"
#include "core/config.h"
#include "core/fixed.h"
#include "core/memory.h"
#include "ram_rows.h"
#include "state/state.h"

typedef struct ram_row {
    uint32_t ram_bytes;
    uint16_t side, views;
    uint32_t gaussians;
    const char *weights;
    uint16_t column_bytes, refine;
} ram_row;

#define ROW(...) {__VA_ARGS__},
static const ram_row rows[] = {T3R_RAM_ROWS(ROW)};
enum { ROWS = sizeof rows / sizeof rows[0] };

static t3r_config config_of(const ram_row *row)
{
    t3r_config config = t3r_default_config(row->side, row->side, row->views, row->gaussians);
    config.head = row->weights != NULL ? T3R_HEAD_LEARNED : T3R_HEAD_ANALYTIC;
    config.head_column_bytes = row->column_bytes;
    config.refine = row->refine;
    config.fit_passes = 0; /* the table's figures are of so many */
    return config;
}

t3r_status t3r_ram_config_as(uint64_t digest, uint64_t bytes, t3r_config *config, t3r_ram_info *info)
{
    T3R_REFUSE_UNLESS(digest == t3r_header_interface(), T3R_ERR_INTERFACE);
    T3R_REFUSE_UNLESS(config != NULL, T3R_ERR_ARGUMENT);
    if (bytes < rows[0].ram_bytes) {
        return T3R_ERR_ARENA;
    }
    size_t at = 0;
    while (at + 1 < ROWS && bytes >= rows[at + 1].ram_bytes) {
        at++;
    }
    const ram_row *row = &rows[at];
    const t3r_config chosen = config_of(row);
    size_t least, most;
    const t3r_status status = t3r_plan_bytes(&chosen, &least, &most);
    if (status != T3R_OK) {
        return status;
    }
    const size_t strip = (size_t)T3R_RAM_STRIP_ROWS * row->side * 5, target = T3R_PIXELS_(row->side, row->side) * 3;
    const uint64_t left = bytes - strip - target - T3R_RAM_STACK_BYTES - T3R_RAM_PROGRAM_BYTES;
    *config = chosen;
    if (info != NULL) {
        *info = (t3r_ram_info){
            .ram_bytes = row->ram_bytes,
            .arena_bytes = left < most ? (size_t)left / T3R_ARENA_ALIGN * T3R_ARENA_ALIGN : most,
            .strip_rows = T3R_RAM_STRIP_ROWS,
            .strip_bytes = strip,
            .target_bytes = target,
            .stack_bytes = T3R_RAM_STACK_BYTES,
            .program_bytes = T3R_RAM_PROGRAM_BYTES,
            .weights = row->weights,
        };
    }
    return T3R_OK;
}
