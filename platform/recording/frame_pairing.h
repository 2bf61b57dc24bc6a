/* SPDX-License-Identifier: Apache-2.0 */
/* Decides which colour and depth images belong to one instant, as they arrive. */
#ifndef T3R_PLATFORM_FRAME_PAIRING_H
#define T3R_PLATFORM_FRAME_PAIRING_H

#include <stdint.h>

#define T3R_PAIRING_MOST 32u

/* An image that waits for its companion. */
typedef struct t3r_pairing_item {
    int64_t stamp_ns, arrived_ns;
    uint32_t sequence, buffer;
} t3r_pairing_item;

typedef struct t3r_pairing_queue {
    t3r_pairing_item items[T3R_PAIRING_MOST]; /* oldest first */
    uint32_t count;
} t3r_pairing_queue;

typedef struct t3r_pairing {
    t3r_pairing_queue colour, depth;
    uint32_t most;                            /* images of either kind that may wait, 1..T3R_PAIRING_MOST */
    int64_t near_ns;                          /* largest distance within one instant */
    int64_t patience_ns;                      /* longest wait of a colour image for its depth */
    int64_t depth_last_ns, depth_interval_ns; /* 0: not known yet */
} t3r_pairing;

typedef enum t3r_pairing_verdict {
    T3R_PAIRING_WAIT,
    T3R_PAIRING_BOTH,      /* the first of both queues belong together */
    T3R_PAIRING_COLOUR,    /* the first colour image has no companion */
    T3R_PAIRING_NOT_DEPTH, /* the first depth image has no colour image */
} t3r_pairing_verdict;

/* Adds at the end of a queue. Stamps ascend; the queue must hold fewer than `most` items. */
void t3r_pairing_add_colour(t3r_pairing *pairing, t3r_pairing_item item);
void t3r_pairing_add_depth(t3r_pairing *pairing, t3r_pairing_item item);
t3r_pairing_item t3r_pairing_take(t3r_pairing_queue *queue);

/* Returns the verdict at time now_ns; a full queue forces a decision. *gap_ns: for BOTH depth's stamp minus colour's;
 * for COLOUR the gap to the nearest depth, INT64_MAX if there is none. */
t3r_pairing_verdict t3r_pairing_decide(const t3r_pairing *pairing, int64_t now_ns, int64_t *gap_ns);

#endif
