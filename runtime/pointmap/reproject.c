/* SPDX-License-Identifier: Apache-2.0 */
#include "reproject.h"

t3r_pinhole t3r_pinhole_of(const t3r_view *view)
{
    return (t3r_pinhole){view->pose, view->fx_q16, view->fy_q16, view->cx_q16, view->cy_q16, view->width, view->height};
}

t3r_unprojection t3r_unprojection_of(const t3r_pointmap *map)
{
    return (t3r_unprojection){t3r_pinhole_of(map->view), map->scale, map->inverse_fx_q32, map->inverse_fy_q32};
}

bool t3r_project_to_pixel(const t3r_view *view, const int32_t point_q20[3], t3r_projected_pixel *projected)
{
    const t3r_pinhole pinhole = t3r_pinhole_of(view);
    const uint32_t pixel = t3r_locate_point(&pinhole, point_q20, &projected->z_q20);
    projected->pixel = pixel;
    return pixel != T3R_NO_PIXEL;
}

bool t3r_reproject(const t3r_pointmap *from, uint32_t u, uint32_t v, const t3r_pointmap *to,
                   t3r_projected_pixel *projected)
{
    int32_t point[3];
    return t3r_point(from, u, v, point) && t3r_project_to_pixel(to->view, point, projected);
}
