/* Stubs for builds without the structural loss: core/config.c refuses configurations that ask for it. */
#include "structural.h"

#if !T3R_FEATURE_LOSS

void t3r_structural_loss(t3r_wanted *tile, const t3r_structure *structure)
{
    (void)tile, (void)structure;
}

void t3r_add_levels(const t3r_wanted *tile, const t3r_view_levels *levels, t3r_level_sums *sums)
{
    (void)tile, (void)levels, (void)sums;
}

void t3r_join_levels(t3r_level_sums *sums, const t3r_level_sums *others)
{
    (void)sums, (void)others;
}

t3r_view_levels t3r_fit_levels(const t3r_level_sums *sums)
{
    (void)sums;
    return (t3r_view_levels){{0}, {0}};
}

void t3r_center_levels(t3r_view_levels *lines, uint32_t count)
{
    (void)lines, (void)count;
}

void t3r_move_levels(t3r_view_levels *levels, const t3r_view_levels *line)
{
    (void)levels, (void)line;
}

#endif
