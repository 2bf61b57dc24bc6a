/* SPDX-License-Identifier: Apache-2.0 */
#include "kernels/ray_row.h"

#include <stdbool.h>

#include "core/fixed.h"

static inline int64_t coordinate(const t3r_ray_map *map, int axis, int32_t a, int32_t b)
{
    const int64_t sum = (int64_t)a * map->turn_q30[axis] + (int64_t)b * map->slope_q30[axis] + map->base_q54[axis];
    return t3r_round_shift64(sum, 30);
}

static inline int32_t place(const t3r_ray_map *map, int axis, int64_t x, int64_t z)
{
    const int64_t at = t3r_round_div64(x * (1 << 24), z); /* |x| at most 16 z: 2^28 */
    const int64_t q16 = t3r_round_shift64(at * map->scale_q16[axis], 24) + map->offset_q16[axis];
    return (int32_t)t3r_clamp64(q16, INT32_MIN, INT32_MAX);
}

void t3r_ray_row_c(const t3r_ray_map *map, const int32_t *a_q24, const int32_t *b_q24, uint32_t count,
                   t3r_ray_places *out)
{
    for (uint32_t i = 0; i < count; i++) {
        const int64_t x = coordinate(map, 0, a_q24[i], b_q24[i]), y = coordinate(map, 1, a_q24[i], b_q24[i]);
        const int64_t z = coordinate(map, 2, a_q24[i], b_q24[i]), most = z * map->steepest;
        const bool has_place = z >= 1 << 18 && t3r_abs64(x) <= most && t3r_abs64(y) <= most;
        out->x_q16[i] = has_place ? place(map, 0, x, z) : 0;
        out->y_q16[i] = has_place ? place(map, 1, y, z) : 0;
        out->z_q24[i] = has_place ? (int32_t)z : 0;
    }
}
