/* SPDX-License-Identifier: Apache-2.0 */
#include "frame_pairing.h"

#include <stdbool.h>
#include <string.h>

void t3r_pairing_add_colour(t3r_pairing *pairing, t3r_pairing_item item)
{
    pairing->colour.items[pairing->colour.count++] = item;
}

void t3r_pairing_add_depth(t3r_pairing *pairing, t3r_pairing_item item)
{
    if (pairing->depth_last_ns != 0 && item.stamp_ns > pairing->depth_last_ns) {
        pairing->depth_interval_ns = item.stamp_ns - pairing->depth_last_ns;
    }
    pairing->depth_last_ns = item.stamp_ns;
    pairing->depth.items[pairing->depth.count++] = item;
}

t3r_pairing_item t3r_pairing_take(t3r_pairing_queue *queue)
{
    t3r_pairing_item first = queue->items[0];
    queue->count--;
    memmove(queue->items, queue->items + 1, queue->count * sizeof first);
    return first;
}

static int64_t magnitude(int64_t x)
{
    return x < 0 ? -x : x;
}

t3r_pairing_verdict t3r_pairing_decide(const t3r_pairing *pairing, int64_t now_ns, int64_t *gap_ns)
{
    const t3r_pairing_queue *colours = &pairing->colour, *depths = &pairing->depth;
    *gap_ns = INT64_MAX;
    if (colours->count == 0) {
        return depths->count >= pairing->most ? T3R_PAIRING_NOT_DEPTH : T3R_PAIRING_WAIT;
    }
    const t3r_pairing_item *colour = &colours->items[0];
    bool full = colours->count >= pairing->most || depths->count >= pairing->most;
    bool over = full || now_ns - colour->arrived_ns >= pairing->patience_ns;
    if (depths->count == 0) {
        return over ? T3R_PAIRING_COLOUR : T3R_PAIRING_WAIT;
    }
    int64_t gap = depths->items[0].stamp_ns - colour->stamp_ns;
    if (gap < -pairing->near_ns) {
        return T3R_PAIRING_NOT_DEPTH; /* too old for this colour image and all later ones */
    }
    bool more = depths->count > 1;
    if (more && magnitude(depths->items[1].stamp_ns - colour->stamp_ns) < magnitude(gap)) {
        return T3R_PAIRING_NOT_DEPTH;
    }
    *gap_ns = gap;
    if (gap > pairing->near_ns) {
        return T3R_PAIRING_COLOUR; /* later ones are farther still */
    }
    /* an earlier depth image may be followed by a nearer one, unless the interval rules that out */
    bool nearest = gap >= 0 || more || (pairing->depth_interval_ns != 0 && -gap <= pairing->depth_interval_ns / 2);
    return nearest || over ? T3R_PAIRING_BOTH : T3R_PAIRING_WAIT;
}
