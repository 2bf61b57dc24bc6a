/* SPDX-License-Identifier: Apache-2.0 */
#include "study/chart/view.h"

#include <math.h>
#include <stdlib.h>

#include "study/chart/front.h"

bool chart_points_have(const chart_points *points, chart_measure measure)
{
    for (uint32_t i = 0; i < points->cell_count; i++) {
        if (!isnan(points->cells[i].value[measure])) {
            return true;
        }
    }
    return false;
}

static void make_axes(chart_view *view, uint32_t count)
{
    double low_x = INFINITY, high_x = -INFINITY, low_y = INFINITY, high_y = -INFINITY;
    for (uint32_t i = 0; i < count; i++) {
        const chart_spot *spot = &view->spots[i];
        if (spot->shown) {
            low_x = fmin(low_x, spot->cost.mean);
            high_x = fmax(high_x, spot->cost.mean);
            low_y = fmin(low_y, spot->quality.mean);
            high_y = fmax(high_y, spot->quality.mean);
        }
    }
    if (view->shown > 0) {
        view->x = chart_axis_make(view->choice.cost, low_x, high_x);
        view->y = chart_axis_make(view->choice.quality, low_y, high_y);
    }
}

static void find_front(chart_view *view, chart_place *places, uint32_t count)
{
    double sign = chart_measures[view->choice.quality].less_is_better ? -1 : 1;
    for (uint32_t i = 0; i < count; i++) {
        const chart_spot *spot = &view->spots[i];
        places[i] = (chart_place){spot->complete ? spot->cost.mean : NAN, sign * spot->quality.mean, i};
    }
    view->front_count = chart_front(places, count);
    for (uint32_t i = 0; i < view->front_count; i++) {
        view->front[i] = places[i].index;
        view->spots[places[i].index].front = true;
    }
}

int chart_view_make(chart_view *view, const chart_points *points, chart_choice choice)
{
    *view = (chart_view){.choice = choice};
    chart_place *places = calloc(points->count, sizeof *places);
    view->spots = calloc(points->count, sizeof *view->spots);
    view->front = calloc(points->count, sizeof *view->front);
    if (places == NULL || view->spots == NULL || view->front == NULL) {
        free(places);
        chart_view_free(view);
        return -1;
    }
    uint32_t costs = 0;
    for (uint32_t i = 0; i < points->count; i++) {
        chart_spot *spot = &view->spots[i];
        spot->cost = chart_points_spread(points, i, choice.cost, choice.scene);
        spot->quality = chart_points_spread(points, i, choice.quality, choice.scene);
        spot->shown = spot->cost.cases > 0 && spot->quality.cases > 0;
        view->shown += spot->shown;
        if (spot->shown) {
            costs = spot->cost.cases > costs ? spot->cost.cases : costs;
            view->cases = spot->quality.cases > view->cases ? spot->quality.cases : view->cases;
        }
    }
    for (uint32_t i = 0; i < points->count; i++) {
        chart_spot *spot = &view->spots[i];
        spot->complete = spot->shown && spot->cost.cases == costs && spot->quality.cases == view->cases;
    }
    make_axes(view, points->count);
    find_front(view, places, points->count);
    free(places);
    return 0;
}

void chart_view_free(chart_view *view)
{
    free(view->spots);
    free(view->front);
    *view = (chart_view){0};
}
