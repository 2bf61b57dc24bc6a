/* SPDX-License-Identifier: Apache-2.0 */
#include "study/chart/front.h"

#include <math.h>
#include <stdlib.h>

/* Orders by cost, then by falling quality; excluded places come last. The index breaks ties, so that the order is
 * unique. */
static int by_cost(const void *left, const void *right)
{
    const chart_place *a = left, *b = right;
    bool a_out = isnan(a->cost) || isnan(a->quality), b_out = isnan(b->cost) || isnan(b->quality);
    if (a_out != b_out) {
        return a_out - b_out;
    }
    int order = a_out ? 0 : (a->cost > b->cost) - (a->cost < b->cost);
    if (order == 0 && !a_out) {
        order = (a->quality < b->quality) - (a->quality > b->quality);
    }
    return order != 0 ? order : (a->index > b->index) - (a->index < b->index);
}

uint32_t chart_front(chart_place *places, uint32_t count)
{
    uint32_t found = 0;
    qsort(places, count, sizeof *places, by_cost);
    for (uint32_t i = 0; i < count && !isnan(places[i].cost) && !isnan(places[i].quality); i++) {
        const chart_place *last = &places[found == 0 ? 0 : found - 1];
        bool better = found == 0 || places[i].quality > last->quality;
        if (better || (places[i].quality == last->quality && places[i].cost == last->cost)) {
            places[found++] = places[i];
        }
    }
    return found;
}
