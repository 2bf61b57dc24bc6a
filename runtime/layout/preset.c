/* SPDX-License-Identifier: Apache-2.0 */
/* Presets: settings for an amount of work. */
#include "layout/plan_checks.h"
#include "state/state.h"

typedef struct preset_row {
    const char *weights;
    uint32_t refine; /* at most */
    uint32_t structural;
} preset_row;

/* Chosen on training scenes (docs/study/results.md). */
static const preset_row rows[] = {
    [T3R_PRESET_FAST] = {"tiny", 2, 0},
    [T3R_PRESET_BALANCED] = {"small", 8, 0},
    [T3R_PRESET_BEST] = {"small", 32, 1},
};
_Static_assert(sizeof rows / sizeof *rows == T3R_PRESET_COUNT, "a row a preset");

t3r_status t3r_set_preset_as(uint64_t digest, t3r_preset preset, t3r_config *config, const char **weights)
{
    T3R_REFUSE_UNLESS(digest == t3r_header_interface(), T3R_ERR_INTERFACE);
    T3R_PASS(t3r_set_preset_checks(preset, config, NULL));
    const preset_row *row = &rows[preset];
    config->head = T3R_HEAD_LEARNED;
    config->refine = row->refine;
    config->fit_passes = 1;
    config->structural = row->structural;
    if (weights != NULL) {
        *weights = row->weights;
    }
    return T3R_OK;
}
