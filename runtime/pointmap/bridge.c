#include "bridge.h"

#include "core/fixed.h"

#define AXES 4

/* Whether the pixel ends a hole. Planes of a restored arena may hold anything, so known pixels count only with a
 * depth. */
static bool ends_hole(const t3r_view *view, size_t pixel)
{
    uint8_t validity = view->validity[pixel];
    return view->depth[pixel] != 0 && (t3r_is_known(validity) || t3r_is_lent(validity));
}

/* Returns the steps from (x, y) to the first known pixel, 1..radius, and stores its depth. Returns 0 if there is
 * none. */
static uint32_t look(const t3r_view *view, uint32_t x, uint32_t y, int32_t dx, int32_t dy, uint32_t radius,
                     uint16_t *depth)
{
    int32_t u = (int32_t)x, v = (int32_t)y;
    for (uint32_t i = 1; i <= radius; i++) {
        u += dx;
        v += dy;
        if (u < 0 || v < 0 || u >= (int32_t)view->width || v >= (int32_t)view->height) {
            return 0;
        }
        size_t pixel = (size_t)v * view->width + (size_t)u;
        if (ends_hole(view, pixel)) {
            *depth = view->depth[pixel];
            return i;
        }
    }
    return 0;
}

/* Depth is interpolated as 1 / depth, which is linear on planes. */
static int64_t inverse_q36(uint16_t depth)
{
    return t3r_round_div64((int64_t)1 << 36, depth);
}

/* Returns the depth of a pixel from its brackets, 0 without any. */
static uint16_t depth_across(const t3r_view *view, uint32_t x, uint32_t y, uint32_t radius)
{
    static const int32_t axis[AXES][2] = {{1, 0}, {0, 1}, {1, 1}, {1, -1}};
    int64_t sum = 0, weights = 0; /* a weight is at most 2^22, an inverse 2^36: together below 2^60 */
    uint32_t narrowest = UINT32_MAX;
    uint16_t farther = 0;
    for (int k = 0; k < AXES; k++) {
        uint16_t a = 0, b = 0;
        uint32_t before = look(view, x, y, -axis[k][0], -axis[k][1], radius, &a);
        uint32_t after = before == 0 ? 0 : look(view, x, y, axis[k][0], axis[k][1], radius, &b);
        if (after == 0) {
            continue;
        }
        uint32_t gap = before + after;
        uint32_t square = gap * gap * (axis[k][0] * axis[k][1] == 0 ? 1 : 2); /* squared length: 4..2^20 */
        uint16_t near = T3R_MIN(a, b), deep = T3R_MAX(a, b);
        if (8 * (deep - near) <= near) {
            int64_t weight = t3r_round_div64((int64_t)1 << 24, square);
            sum += weight * t3r_round_div64(inverse_q36(a) * after + inverse_q36(b) * before, gap);
            weights += weight;
        }
        if (square < narrowest) {
            narrowest = square;
            farther = deep;
        }
    }
    /* a weighted mean of inverses lies between the inverses of 65,535 and of 1 */
    return weights == 0 ? farther : (uint16_t)t3r_round_div64(weights * ((int64_t)1 << 36), sum);
}

void t3r_bridge_view(const t3r_view *view, uint32_t radius)
{
    for (uint32_t y = 0; y < view->height && radius > 0; y++) {
        for (uint32_t x = 0; x < view->width; x++) {
            size_t pixel = (size_t)y * view->width + x;
            uint16_t depth = t3r_has_depth(view->validity[pixel]) ? 0 : depth_across(view, x, y, radius);
            if (depth != 0) {
                view->depth[pixel] = depth;
                view->validity[pixel] = T3R_BRIDGED;
            }
        }
    }
}
