/* SPDX-License-Identifier: Apache-2.0 */
#include "arena.h"

#include "budget/budget.h"
#include "core/fixed.h"
#include "kernels/scatter.h"
#include "raster/raster_splat.h"
#include "refine/refine.h"
#include "refine/refine_tile.h"
#include "state/state.h"
#include "stream/stream_discs.h"
#include "stream/stream_map.h"
#include "superclusters/superclusters.h"

_Static_assert(sizeof(t3r_gaussian) == T3R_GAUSSIAN_BYTES, "trim3r_arena.h knows the Gaussian's size");
_Static_assert(sizeof(t3r_splat) == T3R_SPLAT_BYTES, "trim3r_arena.h knows the splat's size");
_Static_assert(sizeof(t3r_cluster) == T3R_CLUSTER_BYTES, "trim3r_arena.h knows the SuperCluster's size");
_Static_assert(sizeof(t3r_group_count) == T3R_GROUP_COUNT_BYTES, "trim3r_arena.h knows the budget's counts");
_Static_assert(sizeof(t3r_refine_sums) == T3R_REFINE_SUMS_BYTES, "trim3r_arena.h knows refinement's sums");
_Static_assert(sizeof(t3r_wanted) == T3R_WANTED_BYTES, "trim3r_arena.h knows the compared tile's size");
_Static_assert(T3R_KEPT_LEAST * sizeof(uint32_t) == T3R_KEPT_LEAST_BYTES,
               "trim3r_arena.h knows what a splat of a tile keeps");
_Static_assert(sizeof(t3r_map_record) == T3R_MAP_RECORD_BYTES, "trim3r_arena.h knows the map record's size");
_Static_assert(sizeof(t3r_map_disc) == T3R_MAP_DISC_BYTES, "trim3r_arena.h knows the disc's size");
_Static_assert(sizeof(t3r_correction) == T3R_CORRECTION_BYTES, "trim3r_arena.h knows the correction's size");

typedef struct buffer_row {
    size_t bytes;
    t3r_stage first, last;
} buffer_row;

#define ROW(with, NAME, text, buffer_bytes, first_stage, last_stage)                                                   \
    rows[T3R_BUFFER_##NAME] = (buffer_row){buffer_bytes, (t3r_stage)(first_stage), (t3r_stage)(last_stage)};

/* The public table of a configuration; bytes are rounded up. */
typedef struct buffer_table {
    buffer_row row[T3R_BUFFER_COUNT];
    size_t full_lists, full_refine; /* bytes with which they save all the passes that they can */
} buffer_table;

/* The sizes that a configuration `c` needs. The compiler removes those of features that are left out. */
#define SHAPE                                                                                                          \
    T3R_SHAPE_(                                                                                                        \
        c->width, c->height, c->views, c->max_gaussians, t3r_cluster_count(c), c->render_width, c->render_height,      \
        c->head_column_bytes, T3R_FEATURE_STREAMS && c->stream != 0 ? T3R_KEEP_MAP : c->keep_analysis,                 \
        T3R_FEATURE_REFINEMENT ? c->refine : 0, T3R_FEATURE_STEREO && c->depth == T3R_DEPTH_STEREO,                    \
        T3R_FEATURE_EXTRAS ? c->workers : 1, T3R_FEATURE_STREAMS && c->warm, T3R_FEATURE_STREAMS ? c->remember : 0)

static void read_table(const t3r_config *c, buffer_table *table)
{
    buffer_row *rows = table->row;
    T3R_BUFFERS(ROW, 0, SHAPE)
    for (int b = 0; b < T3R_BUFFER_COUNT; b++) {
        rows[b].bytes = T3R_UP_(rows[b].bytes);
    }
    table->full_lists = T3R_UP_(T3R_LISTS_BYTES_(SHAPE));
    table->full_refine = T3R_UP_(T3R_REFINE_FULL_BYTES_(SHAPE));
}

static bool alive_together(const buffer_row *a, const buffer_row *b)
{
    return a->first <= b->last && b->first <= a->last;
}

/* Offsets from the bottom: each buffer right above the highest earlier one that is alive when it is. The scene is
 * laid from the top. The table's lifetimes nest, so no stage's top is above the sum of its live buffers (a test
 * holds that against the macros). Returns the least bytes. */
static size_t stack_buffers(const buffer_row rows[T3R_BUFFER_COUNT], size_t offset[T3R_BUFFER_COUNT])
{
    const buffer_row *scene = &rows[T3R_BUFFER_SCENE];
    size_t most = 0;
    for (int b = 0; b < T3R_BUFFER_COUNT; b++) {
        if (b == T3R_BUFFER_SCENE) {
            continue;
        }
        offset[b] = 0;
        for (int a = 0; a < b; a++) {
            if (a != T3R_BUFFER_SCENE && alive_together(&rows[a], &rows[b])) {
                offset[b] = T3R_MAX(offset[b], offset[a] + rows[a].bytes);
            }
        }
        size_t top = offset[b] + rows[b].bytes + (alive_together(&rows[b], scene) ? scene->bytes : 0);
        most = T3R_MAX(most, top);
    }
    return most;
}

t3r_status t3r_lay_out(const t3r_config *config, size_t arena_bytes, t3r_layout *layout)
{
    buffer_table table;
    read_table(config, &table);
    buffer_row *rows = table.row, *lists = &rows[T3R_BUFFER_LISTS], *refine = &rows[T3R_BUFFER_REFINE_WORK];
    layout->min_bytes = stack_buffers(rows, layout->offset);
    size_t raster_top = layout->offset[T3R_BUFFER_LISTS] + table.full_lists + rows[T3R_BUFFER_SCENE].bytes;
    size_t refine_top = layout->offset[T3R_BUFFER_REFINE_WORK] + table.full_refine + rows[T3R_BUFFER_SCENE].bytes;
    layout->bytes = T3R_MAX(layout->min_bytes, T3R_MAX(raster_top, refine_top));
    if (arena_bytes < layout->min_bytes) {
        return T3R_ERR_ARENA;
    }

    layout->offset[T3R_BUFFER_SCENE] = arena_bytes / T3R_ARENA_ALIGN * T3R_ARENA_ALIGN - rows[T3R_BUFFER_SCENE].bytes;
    lists->bytes = layout->offset[T3R_BUFFER_SCENE] - layout->offset[T3R_BUFFER_LISTS];
    if (refine->bytes > 0) {
        refine->bytes = layout->offset[T3R_BUFFER_SCENE] - layout->offset[T3R_BUFFER_REFINE_WORK];
    }
    layout->refine_bytes = refine->bytes;
    layout->list_capacity = T3R_MIN(lists->bytes / sizeof(uint32_t), (size_t)UINT32_MAX);
    for (int b = 0; b < T3R_BUFFER_COUNT; b++) {
        layout->size[b] = rows[b].bytes;
    }
    return T3R_OK;
}

#define NAME_OF(with, NAME, text, buffer_bytes, first_stage, last_stage) [T3R_BUFFER_##NAME] = text,

const char *t3r_buffer_name(enum t3r_buffer buffer)
{
    static const char *const names[] = {T3R_BUFFERS(NAME_OF, 0, 0)};
    return names[buffer];
}

void t3r_buffer_lifetime(const t3r_config *config, enum t3r_buffer buffer, t3r_stage *first, t3r_stage *last)
{
    buffer_table table;
    read_table(config, &table);
    *first = table.row[buffer].first;
    *last = table.row[buffer].last;
}
