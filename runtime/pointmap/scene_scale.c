#include "scene_scale.h"

#include "core/fixed.h"
#include "core/scene_frame.h"

/* floor(log2) of a raw depth in world units, Q40, offset so that it is never negative: raw < 2^16, unit < 2^64 */
static uint32_t octave(uint64_t depth_unit_q40, uint16_t raw)
{
    uint64_t high = (depth_unit_q40 >> 32) * raw + (((depth_unit_q40 & UINT32_MAX) * raw) >> 32);
    return high != 0 ? 32 + t3r_msb64(high) : t3r_msb64((depth_unit_q40 & UINT32_MAX) * raw);
}

#define OCTAVES 96
#define STEPS 1024

/* The first index at which the running sum passes half of the total */
static uint32_t median_bin(const uint32_t *histogram, uint32_t bins, uint64_t total, uint64_t before)
{
    uint64_t sum = before;
    for (uint32_t bin = 0; bin + 1 < bins; bin++) {
        sum += histogram[bin];
        if (2 * sum > total) {
            return bin;
        }
    }
    return bins - 1;
}

t3r_status t3r_scene_scale_choose(const t3r_view *views, uint32_t count, int32_t *exponent, int32_t *median_q20)
{
    uint32_t octaves[OCTAVES] = {0};
    uint64_t total = 0;
    for (uint32_t v = 0; v < count; v++) {
        uint32_t pixels = views[v].width * views[v].height;
        for (uint32_t i = 0; i < pixels; i++) {
            if (t3r_is_reliable(views[v].validity[i]) && views[v].depth[i] != 0) {
                octaves[octave(views[v].depth_unit_q40, views[v].depth[i])]++;
                total++;
            }
        }
    }
    if (total == 0) {
        return T3R_ERR_NO_DEPTH;
    }
    uint32_t middle = median_bin(octaves, OCTAVES, total, 0);
    *exponent = t3r_clamp32((int32_t)middle - 40, T3R_EXPONENT_LEAST, T3R_EXPONENT_MOST);

    /* Inside that octave: 1024 steps between 1 and 2 scene units. */
    uint32_t steps[STEPS] = {0};
    uint64_t before = 0;
    for (uint32_t v = 0; v < count; v++) {
        t3r_depth_scale scale = t3r_depth_scale_of(views[v].depth_unit_q40, *exponent);
        uint32_t pixels = views[v].width * views[v].height;
        for (uint32_t i = 0; i < pixels; i++) {
            if (!t3r_is_reliable(views[v].validity[i])) {
                continue;
            }
            int32_t depth = t3r_depth_q20(scale, views[v].depth[i]);
            if (depth < 1 << 20) {
                before++;
            } else if (depth < 2 << 20) {
                steps[(depth - (1 << 20)) >> 10]++;
            }
        }
    }
    uint32_t bin = median_bin(steps, STEPS, total, before);
    *median_q20 = (1 << 20) + (int32_t)(bin << 10) + 512;
    return T3R_OK;
}
