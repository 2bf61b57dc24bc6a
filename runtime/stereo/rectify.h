/* SPDX-License-Identifier: Apache-2.0 */
/* Stage stereo, first part: maps two posed pinhole cameras to planes in which every point lies in the same row of both
 * (SPEC.md, "Stereo: rectification").
 *
 * The x axis of the rectified frame is the baseline, from the first camera to the second. A ray of either camera is
 * a x + b e(row): rows are planes through the baseline, and a / b is the cotangent of the ray's angle to it. In units
 * of the baseline, a point whose two cotangents differ by d is 1 / d away from it.
 *
 *      planar   rows are lines of a plane, a = column, b = 1: as a stereo camera has it
 *      polar    rows are half-planes, a = 2 t, b = 1 - t^2, t = column: the tangent of half the angle to e. For pairs
 *               whose baseline points where they look: the epipole, and pictures all around it, stay finite. */
#ifndef T3R_RECTIFY_H
#define T3R_RECTIFY_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "core/divisor.h"
#include "core/workers.h"
#include "kernels/kernels.h"
#include "trim3r.h"

#define T3R_RECTIFIED_LEAST 32u /* least width and height */

typedef struct t3r_rectified_view {
    int32_t fx_q16, fy_q16, cx_q16, cy_q16;
    int32_t turn_q30[9]; /* row-major; the columns are the rectified frame's axes in the camera's frame */
} t3r_rectified_view;

typedef struct t3r_rectification {
    bool polar;
    uint32_t view_width, view_height;        /* of both views */
    uint32_t width, height;                  /* of the first view's plane */
    int32_t scale_q16[2];                    /* pixels a unit of column and of row */
    int32_t first_q16[2];                    /* position of column 0 and row 0 of the first view's plane, pixels */
    int32_t least_disparity, most_disparity; /* range of possible disparities of any pixel of both pictures, whole
                                              * pixels */
    t3r_divisor column_scale;                /* divisor scale_q16[0] */
    t3r_rectified_view view[2];
    uint32_t baseline_q31; /* length: baseline_q31 2^(baseline_exponent - 31) in Q32 world units */
    int32_t baseline_exponent;
} t3r_rectification;

/* Rectifies two checked, undistorted cameras with views of width x height. The plane and a right one that is
 * disparities - 1 columns wider take no more memory, and their matching no more work memory, than squares of
 * T3R_RECTIFIED_SIDE. */
t3r_pair t3r_rectify(const t3r_camera *first, const t3r_camera *second, uint32_t width, uint32_t height,
                     uint32_t disparities, t3r_rectification *rect);

/* A ray in the rectified frame by its place in a plane. */
typedef struct t3r_column {
    int32_t a_q24, b_q24; /* b <= 0: no such ray */
} t3r_column;

/* Returns the column at a place in units of column, Q24: at most 4 in planes, at most 1 for rays of polar ones. */
static inline t3r_column t3r_column_of(bool polar, int64_t at_q24)
{
    if (!polar) {
        return (t3r_column){(int32_t)at_q24, 1 << 24};
    }
    return (t3r_column){(int32_t)(2 * at_q24), (int32_t)((1 << 24) - t3r_round_shift64(at_q24 * at_q24, 24))};
}

/* Returns the column x pixels from the baseline's normal, Q16. The plane's first column is at first_q16[0]. */
static inline t3r_column t3r_rectified_column(const t3r_rectification *rect, int32_t x_q16)
{
    return t3r_column_of(rect->polar, t3r_divide_q24(&rect->column_scale, x_q16, 4));
}

/* Computes the place of a view's pixel, Q16: column as above, row counted from the plane's first; and the distance of
 * its ray from the baseline at z = 1 in the view, Q24. Returns false if it has no place. */
bool t3r_rectified_place(const t3r_rectification *rect, uint32_t view, int32_t u_q16, int32_t v_q16,
                         int32_t place_q16[2], int32_t *across_q24);

/* A set of a view's columns: `count`, up to T3R_RAYS, from u on, every step-th; and the x of their rays. */
typedef struct t3r_view_columns {
    uint32_t u, step, count;
    int32_t x_q24[T3R_RAYS]; /* 0 after the last */
} t3r_view_columns;

void t3r_view_columns_of(const t3r_rectification *rect, uint32_t view, uint32_t u, uint32_t step, uint32_t count,
                         t3r_view_columns *columns);

/* Computes the places of a view's pixels in these columns and row v, like t3r_rectified_place(). places->z_q24 is the
 * distance, 0 = no place. */
void t3r_rectified_places(const t3r_kernels *kernels, const t3r_rectification *rect, uint32_t view,
                          const t3r_view_columns *columns, uint32_t v, t3r_ray_places *places);

/* Samples `count` pixels of each of the given rows of a plane of `view`, whose first column is at x_q16, row after row:
 * luma 1..255, 0 where the view shows nothing. luma: the view's own plane, 0 where it shows nothing. */
void t3r_rectified_rows(const t3r_kernels *kernels, const t3r_rectification *rect, uint32_t view, const uint8_t *luma,
                        int32_t x_q16, t3r_share rows, uint32_t count, uint8_t *out);

#endif
