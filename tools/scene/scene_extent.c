/* SPDX-License-Identifier: Apache-2.0 */
#include "scene/scene_extent.h"

#include <float.h>
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>

#include "core/fixed.h"
#include "host/reason.h"

/* If a tenth of the Gaussians lies within 1 / SPREAD of the median distance, of the centre or of each other, the rest
 * is its backdrop, and the tenth decides: what is near a camera in it is still drawn. It makes the typical distance at
 * most NEARER times less. */
#define SPREAD 16.0
#define NEARER 64.0
#define PAIRS 4096u
/* A unit that is finer by more octaves than positions have bits would show their rounding. */
#define FINER_MOST 20
/* Least width that counts, in typical distances: points have none. */
#define THINNEST 0x1p-16

/* Reorders the values, and returns the one that would stand at `wanted` if they were sorted (Hoare's selection). */
static double take_sorted(double *values, uint32_t count, int64_t wanted)
{
    int64_t low = 0, high = (int64_t)count - 1;
    while (low < high) {
        const double pivot = values[low + (high - low) / 2];
        int64_t left = low, right = high;
        while (left <= right) {
            while (values[left] < pivot) {
                left++;
            }
            while (pivot < values[right]) {
                right--;
            }
            if (left <= right) {
                const double kept = values[left];
                values[left++] = values[right];
                values[right--] = kept;
            }
        }
        if (wanted <= right) {
            high = right;
        } else if (wanted >= left) {
            low = left;
        } else {
            break;
        }
    }
    return values[wanted];
}

static double distance_of(const double position[3], const double centre[3])
{
    return hypot(hypot(position[0] - centre[0], position[1] - centre[1]), position[2] - centre[2]);
}

static double largest_coefficient(const scene_row *row, uint32_t degree)
{
    double largest = 0;
    for (uint32_t i = 0; i < 3 * harmonics_rest(degree); i++) {
        const double size = fabs(row->rest[i / 3][i % 3]);
        largest = size > largest ? size : largest;
    }
    return largest;
}

static bool is_float(double value)
{
    return fabs(value) <= FLT_MAX && (float)value == value;
}

static void widen(scene_bounds *bounds, double value)
{
    bounds->least = value < bounds->least ? value : bounds->least;
    bounds->most = value > bounds->most ? value : bounds->most;
}

/* Fills positions[], widths[], the bounds and the largest coefficient. *are_floats: whether all positions are. */
static int read_positions(const scene_rows *rows, double (*positions)[3], double *widths, scene_extent *out,
                          bool *are_floats, char *error, size_t error_bytes)
{
    scene_row row;
    *are_floats = true;
    *out = (scene_extent){.colour = {INFINITY, -INFINITY}, .log_scale = {INFINITY, -INFINITY}};
    for (uint32_t i = 0; i < rows->count; i++) {
        if (scene_rows_read(rows, i, &row, error, error_bytes) != 0) {
            return -1;
        }
        for (int axis = 0; axis < 3; axis++) {
            positions[i][axis] = row.position[axis];
            *are_floats = *are_floats && is_float(row.position[axis]);
            widen(&out->log_scale, row.log_scale[axis]);
            widen(&out->colour, scene_row_colour(&row, axis));
        }
        widths[i] = fmax(row.log_scale[0], fmax(row.log_scale[1], row.log_scale[2]));
        out->harmonics = fmax(out->harmonics, largest_coefficient(&row, rows->degree));
    }
    return 0;
}

int scene_extent_exponent(const scene_extent *extent)
{
    int exponent;
    (void)frexp(extent->typical, &exponent);
    return exponent - 1;
}

static double reach_of(const scene_extent *extent)
{
    return ldexp(SCENE_REACH, scene_extent_exponent(extent));
}

bool scene_extent_holds(const scene_extent *extent, const double position[3])
{
    return distance_of(position, extent->centre) <= reach_of(extent);
}

/* Moves the values above 0 to the front, in another order. Returns their number. */
static uint32_t keep_positive(double *values, uint32_t count)
{
    uint32_t kept = 0;
    for (uint32_t i = 0; i < count; i++) {
        const double value = values[i];
        if (value > 0) {
            values[i] = values[kept];
            values[kept++] = value;
        }
    }
    return kept;
}

/* Returns the tenth percentile of the distances above 0 between Gaussians, of up to PAIRS from all over the file each
 * with one from anywhere; INFINITY: there are none. Uses values[] as memory. */
static double nearness_of(double (*positions)[3], double *values, uint32_t count)
{
    const uint32_t pairs = count < PAIRS ? count : PAIRS;
    for (uint32_t i = 0; i < pairs; i++) {
        values[i] = distance_of(positions[(uint64_t)i * count / pairs], positions[t3r_mix32(i) % count]);
    }
    const uint32_t apart = keep_positive(values, pairs);
    return apart > 0 ? take_sorted(values, apart, apart / 10) : INFINITY;
}

/* Fills in the typical of the distances from the centre, 0 if all are 0, and how much finer a backdrop's detail is. */
static void find_typical(double *distances, uint32_t count, double nearness, scene_extent *extent)
{
    const uint32_t apart = keep_positive(distances, count);
    extent->typical = 0;
    extent->finer = 0;
    if (apart == 0) {
        return;
    }
    const double median = take_sorted(distances, apart, apart / 2);
    const double near = fmin(take_sorted(distances, apart, apart / 10), nearness);
    extent->typical = fmax(fmin(median, SPREAD * near), median / NEARER);
    if (extent->typical < median) {
        int octaves;
        (void)frexp(extent->typical / near, &octaves);
        extent->finer = (uint32_t)(octaves < FINER_MOST ? octaves : FINER_MOST);
    }
}

/* Fills in place and size. */
static void measure(double (*positions)[3], double *values, uint32_t count, scene_extent *extent)
{
    const double nearness = nearness_of(positions, values, count);
    for (int axis = 0; axis < 3; axis++) {
        for (uint32_t i = 0; i < count; i++) {
            values[i] = positions[i][axis];
        }
        extent->centre[axis] = take_sorted(values, count, count / 2);
    }
    for (uint32_t i = 0; i < count; i++) {
        values[i] = distance_of(positions[i], extent->centre);
    }
    find_typical(values, count, nearness, extent);
    if (extent->typical == 0) {
        extent->typical = exp(fmin(fmax(extent->log_scale.most, -30), 30));
    }
    for (uint32_t i = 0; i < count; i++) {
        extent->far += values[i] > reach_of(extent);
    }
}

/* Returns the distance between floats as large as the largest coordinate. */
static double float_step(const double place[3])
{
    int exponent;
    (void)frexp(fmax(fabs(place[0]), fmax(fabs(place[1]), fabs(place[2]))), &exponent);
    return ldexp(1, exponent - FLT_MANT_DIG);
}

bool scene_extent_is_rounded(const scene_extent *extent)
{
    return extent->step > extent->width / 2;
}

int scene_extent_of(const scene_rows *rows, scene_extent *out, char *error, size_t error_bytes)
{
    double(*positions)[3] = malloc(rows->count * sizeof *positions);
    double *values = malloc(rows->count * sizeof *values);
    bool are_floats;
    int result = positions != NULL && values != NULL
                     ? read_positions(rows, positions, values, out, &are_floats, error, error_bytes)
                     : t3r_reason(error, error_bytes, "out of memory for %" PRIu32 " Gaussians", rows->count);
    if (result == 0) {
        const double width = exp(take_sorted(values, rows->count, rows->count / 2));
        measure(positions, values, rows->count, out);
        out->width = fmax(width, THINNEST * out->typical);
        out->step = are_floats ? float_step(out->centre) : 0;
    }
    free(positions);
    free(values);
    return result;
}

double scene_pull(scene_row *row, double reach)
{
    static const double origin[3] = {0};
    const double times = distance_of(row->position, origin) / reach;
    if (!(times > 1)) {
        return 1;
    }
    for (int axis = 0; axis < 3; axis++) {
        row->position[axis] /= times;
        row->log_scale[axis] -= log(times);
    }
    return times;
}
