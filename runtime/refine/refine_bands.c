/* SPDX-License-Identifier: Apache-2.0 */
#include "refine_bands.h"

#include "core/fixed.h"
#include "core/memory.h"

static uint32_t first_tile_of(const t3r_splat *splat, uint32_t across)
{
    return splat->y0 / T3R_TILE_SIDE * across + splat->x0 / T3R_TILE_SIDE;
}

static uint32_t last_tile_of(const t3r_splat *splat, uint32_t across)
{
    return splat->y1 / T3R_TILE_SIDE * across + splat->x1 / T3R_TILE_SIDE;
}

/* Cuts tiles into bands with about the same number of list entries each. A band may be empty. */
static void cut(const t3r_binning *bin, uint32_t begin, uint32_t end, uint32_t listed, uint32_t count,
                t3r_refine_band *bands)
{
    const uint64_t entries = bin->table[end - 1] - listed; /* up to the end of the last list */
    uint32_t tile = begin;
    for (uint32_t b = 0; b < count; b++) {
        bands[b] = (t3r_refine_band){.begin = tile, .own_from = b == 0 ? 0 : tile};
        while (tile < end && (b + 1 == count || bin->table[tile] - listed <= entries * (b + 1) / count)) {
            tile++;
        }
        bands[b].end = tile;
    }
}

/* Lists the Gaussians of the slice that reach into the band from an earlier one. Returns false when they don't fit. */
static bool find_crossing(const t3r_binning *bin, const t3r_refine_slice *slice, uint32_t most, t3r_refine_band *band,
                          uint32_t *index, t3r_refine_sums *sums)
{
    for (uint32_t i = slice->first; i < slice->first + slice->count; i++) {
        const t3r_splat *splat = &bin->splats[i];
        if (splat->z_q20 == 0 || first_tile_of(splat, bin->across) >= band->own_from ||
            last_tile_of(splat, bin->across) < band->begin) {
            continue;
        }
        if (band->crossing == most) {
            return false;
        }
        const t3r_refine_sums *own = &slice->sums[i - slice->first];
        t3r_refine_sums *copy = &sums[band->crossing];
        *copy = (t3r_refine_sums){.area = own->area, .axes = own->axes}; /* the scale that both sums use */
        index[band->crossing++] = i;
    }
    return true;
}

uint32_t t3r_refine_bands(const t3r_binning *bin, uint32_t begin, uint32_t end, uint32_t listed,
                          const t3r_refine_slice *slice, const t3r_refine_borders *borders,
                          t3r_refine_band bands[T3R_MAX_WORKERS])
{
    uint32_t count = T3R_MIN(borders->bands, end - begin);
    for (bool fits = false; !fits;
         count = fits ? count : count / 2) { /* ends at the latest with one band, which has no border */
        cut(bin, begin, end, listed, count, bands);
        fits = true;
        for (uint32_t b = 1; b < count && fits; b++) {
            const size_t place = (size_t)(b - 1) * borders->most;
            fits = find_crossing(bin, slice, borders->most, &bands[b], borders->index + place, borders->sums + place);
        }
    }
    return count;
}

t3r_refine_sums *t3r_refine_sums_in(const t3r_refine_band *bands, uint32_t band, const t3r_refine_borders *borders,
                                    const t3r_refine_slice *slice, const t3r_splat *splat, uint32_t index,
                                    uint32_t across)
{
    if (first_tile_of(splat, across) >= bands[band].own_from) {
        return &slice->sums[index - slice->first];
    }
    const size_t place = (size_t)(band - 1) * borders->most;
    const uint32_t *crossing = borders->index + place;
    uint32_t low = 0, high = bands[band].crossing - 1; /* index is in the list */
    while (low < high) {
        uint32_t middle = (low + high) / 2;
        if (crossing[middle] < index) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    return &borders->sums[place + low];
}

static void add_each(int32_t *to, const int32_t *from, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        to[i] += from[i];
    }
}

static void add(t3r_refine_sums *to, const t3r_refine_sums *from)
{
    add_each(to->colour, from->colour, 3);
    add_each(&to->weight, &from->weight, 1);
    add_each(to->gradient, from->gradient, T3R_REFINE_MOMENTS_2);
    add_each(to->curvature, from->curvature, T3R_REFINE_MOMENTS_4);
}

void t3r_refine_join(const t3r_refine_band *bands, uint32_t count, const t3r_refine_borders *borders,
                     const t3r_refine_slice *slice)
{
    for (uint32_t b = 1; b < count; b++) {
        const size_t place = (size_t)(b - 1) * borders->most;
        for (uint32_t i = 0; i < bands[b].crossing; i++) {
            add(&slice->sums[borders->index[place + i] - slice->first], &borders->sums[place + i]);
        }
    }
}
