/* What stands for planes where they are left out: no configuration asks for them (core/config.c). */
#include "plane_fill.h"
#include "plane_outline.h"

#if !T3R_FEATURE_PLANES

void t3r_plane_fill(const t3r_view *view, void *work)
{
    (void)view;
    (void)work;
}

void t3r_plane_outline(const t3r_match *match)
{
    (void)match;
}

#endif
