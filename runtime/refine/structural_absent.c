/* The structural loss where it is left out: no configuration is allowed to ask for it (core/config.c). */
#include "structural.h"
#include "view_levels.h"

#if !T3R_FEATURE_LOSS

void t3r_structural_residuals(t3r_wanted *tile)
{
    (void)tile;
}

void t3r_level_residuals(t3r_wanted *tile, const t3r_view_levels *levels)
{
    (void)tile, (void)levels;
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

void t3r_move_levels(const t3r_view_levels *lines, uint32_t count, t3r_view_levels *levels)
{
    (void)lines, (void)count, (void)levels;
}

#endif
