/* Projection of a row of rays into a picture (SPEC.md, "Stereo").
 *
 *     ray = (a turn + b slope + base) / 2^30        place = ray_x / ray_z scale + offset, likewise for y
 *
 * Each ray is rounded to Q24, its quotients to Q24, and its place to Q16: round-half-up three times. */
#ifndef T3R_KERNEL_RAY_ROW_H
#define T3R_KERNEL_RAY_ROW_H

#include <stdint.h>

#define T3R_RAYS 64u /* maximum at a time */

typedef struct t3r_ray_map {
    int32_t turn_q30[3], slope_q30[3]; /* for x, y, z */
    int64_t base_q54[3];
    int32_t steepest;     /* at most 16: rays with |x| or |y| above this times z have no place */
    int32_t scale_q16[2]; /* 0..2^30 - 1 */
    int32_t offset_q16[2];
} t3r_ray_map;

typedef struct t3r_ray_places {
    int32_t x_q16[T3R_RAYS], y_q16[T3R_RAYS]; /* clamped to 32 bits; 0 without a place */
    int32_t z_q24[T3R_RAYS];                  /* z of the ray, at least 2^18; 0: no place */
} t3r_ray_places;

/* Projects `count` rays, a multiple of 16 up to T3R_RAYS, with coordinates below 2^27 (Q24). Rays with z below 2^18
 * have no place. a, b: Q24, any integers that give such rays; b is 0 where the map has no slope. */
typedef void t3r_ray_row_kernel(const t3r_ray_map *map, const int32_t *a_q24, const int32_t *b_q24, uint32_t count,
                                t3r_ray_places *out);
t3r_ray_row_kernel t3r_ray_row_c;

#endif
