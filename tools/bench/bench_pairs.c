#include "bench/bench_pairs.h"

#include <stdatomic.h>

#include "kernels/kernels.h"
#include "state/state.h"

static _Atomic uint64_t pairs; /* workers count concurrently */
static t3r_kernels saved;

static void count(const t3r_tile_splat *splat)
{
    const uint32_t groups = (splat->drawn & 1u) + (splat->drawn >> 1 & 1u);
    atomic_fetch_add(&pairs, (uint64_t)groups * T3R_LANES * (splat->last - splat->first + 1u));
}

static void blend(t3r_tile *tile, const t3r_tile_splat *splat)
{
    count(splat);
    t3r_blend_c(tile, splat);
}

static uint16_t blend_keep(t3r_tile *restrict tile, const t3r_tile_splat *splat, t3r_blended_row *restrict rows)
{
    count(splat);
    return t3r_blend_keep_c(tile, splat, rows);
}

void bench_pairs_begin(t3r_runtime *runtime)
{
    saved = runtime->kernels;
    pairs = 0;
    runtime->kernels.blend = blend;
    runtime->kernels.blend_keep = blend_keep;
}

double bench_pairs_end(t3r_runtime *runtime)
{
    runtime->kernels = saved;
    return (double)pairs;
}
