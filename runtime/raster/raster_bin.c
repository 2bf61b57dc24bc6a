#include "core/fixed.h"
#include "raster_tile.h"

typedef struct tile_range {
    uint32_t x0, y0, x1, y1;
} tile_range;

static tile_range tiles_of(const t3r_splat *splat)
{
    return (tile_range){splat->x0 / T3R_TILE_SIDE, splat->y0 / T3R_TILE_SIDE, splat->x1 / T3R_TILE_SIDE,
                        splat->y1 / T3R_TILE_SIDE};
}

void t3r_bin_count(const t3r_binning *bin)
{
    for (uint32_t tile = 0; tile < bin->tiles; tile++) {
        bin->table[tile] = 0;
    }
    /* One more from x0 on, one less behind x1: two steps a row of tiles however wide a splat is */
    for (uint32_t i = 0; i < bin->visible; i++) {
        tile_range range = tiles_of(&bin->splats[bin->order[i]]);
        for (uint32_t y = range.y0; y <= range.y1; y++) {
            uint32_t *row = bin->table + y * bin->across;
            row[range.x0]++;
            if (range.x1 + 1 < bin->across) {
                row[range.x1 + 1]--; /* wraps, and is whole again in the sum */
            }
        }
    }
    for (uint32_t tile = 0; tile < bin->tiles; tile++) {
        bin->table[tile] += tile % bin->across != 0 ? bin->table[tile - 1] : 0;
    }
}

/* Turns the counts of the tiles that fit into the places where their lists start. */
static uint32_t open_lists(const t3r_binning *bin, uint32_t first)
{
    uint64_t sum = 0;
    uint32_t end = first;
    while (end < bin->tiles && sum + bin->table[end] <= bin->capacity) {
        uint32_t count = bin->table[end];
        bin->table[end] = (uint32_t)sum;
        sum += count;
        end++;
    }
    return end;
}

uint32_t t3r_bin_pass(const t3r_binning *bin, uint32_t first)
{
    uint32_t end = open_lists(bin, first);
    uint32_t first_row = first / bin->across, last_row = (end - 1) / bin->across;
    for (uint32_t i = 0; i < bin->visible; i++) {
        uint32_t index = bin->order[i];
        tile_range range = tiles_of(&bin->splats[index]);
        uint32_t y0 = T3R_MAX(range.y0, first_row), y1 = T3R_MIN(range.y1, last_row);
        for (uint32_t y = y0; y <= y1; y++) {
            /* the pass begins and ends within a row of tiles */
            uint32_t x0 = y == first_row ? T3R_MAX(range.x0, first % bin->across) : range.x0;
            uint32_t x1 = y == last_row ? T3R_MIN(range.x1, (end - 1) % bin->across) : range.x1;
            for (uint32_t x = x0; x <= x1; x++) {
                bin->lists[bin->table[y * bin->across + x]++] = index;
            }
        }
    }
    return end;
}
