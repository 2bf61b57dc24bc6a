#include "scene_frame.h"

#include "camera.h"
#include "fixed.h"

t3r_status t3r_pose_in_scene(const t3r_camera *camera, const t3r_scene_frame *frame, t3r_pose *pose)
{
    t3r_camera_rotation(camera->rotation_q30, pose->rotation_q30);
    for (int i = 0; i < 3; i++) {
        /* Both are below 2^62 (t3r_camera_check), so the difference is exact; scaling is by 2^-36..2^12. */
        int64_t offset = camera->position_q32[i] - frame->origin_q32[i];
        if (t3r_abs64(offset) >= (int64_t)1 << 61) {
            return T3R_ERR_CAMERA;
        }
        int32_t shift = -12 - frame->exponent;
        if (shift > 0 && t3r_abs64(offset) > T3R_POSITION_MOST_Q20) {
            return T3R_ERR_CAMERA;
        }
        offset = t3r_scale64(offset, shift);
        if (t3r_abs64(offset) > T3R_POSITION_MOST_Q20) {
            return T3R_ERR_CAMERA;
        }
        pose->position_q20[i] = (int32_t)offset;
    }
    return T3R_OK;
}

t3r_depth_scale t3r_depth_scale_of(uint64_t depth_unit_q40, int32_t exponent)
{
    int32_t msb = (int32_t)t3r_msb64(depth_unit_q40);
    t3r_depth_scale scale = {(uint32_t)(msb >= 31 ? depth_unit_q40 >> (msb - 31) : depth_unit_q40 << (31 - msb)), 0};
    /* unit = mantissa 2^(msb - 31) in Q40; Q20 scene units: 2^(-20 - exponent) of that */
    scale.shift = 20 + exponent - (msb - 31);
    return scale;
}

int32_t t3r_depth_q20(t3r_depth_scale scale, uint16_t raw)
{
    int64_t product = (int64_t)raw * scale.mantissa; /* below 2^48 */
    if (scale.shift < -14) {
        return product == 0 ? 0 : T3R_POSITION_MOST_Q20 - 1;
    }
    return (int32_t)T3R_MIN(t3r_scale64(product, -scale.shift), (int64_t)T3R_POSITION_MOST_Q20 - 1);
}

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

t3r_status t3r_scene_frame_choose(const t3r_view *views, uint32_t count, int32_t *exponent, int32_t *median_q20)
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
