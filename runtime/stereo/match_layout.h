/* Work memory of the matching paths: the parts of T3R_MATCH_PARTS_(). */
#ifndef T3R_MATCH_LAYOUT_H
#define T3R_MATCH_LAYOUT_H

#include "core/cut.h"
#include "match.h"

#define T3R_MATCH_PART_(type, part, count) type *part;
typedef struct t3r_match_layout {
    /* sums, cost: a block's; winners: a row's; states: one a block, before its first row, and four more; bits: census
     * of a left row; straight, mirrored: census of a right row, by rising and by falling column; least: lowest cost
     * against each right pixel, by falling column */
    T3R_MATCH_PARTS_(T3R_MATCH_PART_, 0, 0, 0, 0)
    uint8_t *down[2]; /* states of the last row and of this row */
    uint8_t *up[2];   /* likewise, from below */
    size_t state_bytes;
} t3r_match_layout;
#undef T3R_MATCH_PART_

#define T3R_MATCH_TAKE_(type, part, count) layout.part = t3r_take(cut, (count) * sizeof(type));
static inline t3r_match_layout t3r_match_lay_out(const t3r_match *match, t3r_cut *cut)
{
    const size_t blocks = T3R_MATCH_BLOCKS(match->height);
    t3r_match_layout layout;
    T3R_MATCH_PARTS_(T3R_MATCH_TAKE_, match->width, match->height, match->disparities, match->paths)
    layout.state_bytes = T3R_MATCH_STATES(match->paths) * T3R_PATH_STATE_BYTES(match->width, match->disparities);
    for (size_t i = 0; i < 2; i++) {
        layout.down[i] = layout.states + (blocks + i) * layout.state_bytes;
        layout.up[i] = layout.states + (blocks + 2 + i) * layout.state_bytes;
    }
    return layout;
}
#undef T3R_MATCH_TAKE_

#endif
