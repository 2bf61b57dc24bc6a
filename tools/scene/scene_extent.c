/* SPDX-License-Identifier: Apache-2.0 */
#include "scene/scene_extent.h"

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

static void widen(scene_bounds *bounds, double value)
{
    bounds->least = value < bounds->least ? value : bounds->least;
    bounds->most = value > bounds->most ? value : bounds->most;
}

/* Fills positions[], the bounds and the largest coefficient. */
static int read_positions(const scene_rows *rows, double (*positions)[3], scene_extent *out, char *error,
                          size_t error_bytes)
{
    scene_row row;
    *out = (scene_extent){.colour = {INFINITY, -INFINITY}, .log_scale = {INFINITY, -INFINITY}};
    for (uint32_t i = 0; i < rows->count; i++) {
        if (scene_rows_read(rows, i, &row, error, error_bytes) != 0) {
            return -1;
        }
        for (int axis = 0; axis < 3; axis++) {
            positions[i][axis] = row.position[axis];
            widen(&out->log_scale, row.log_scale[axis]);
            widen(&out->colour, scene_row_colour(&row, axis));
        }
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

/* Returns the typical of the distances from the centre; 0: all are 0. */
static double typical_of(double *distances, uint32_t count, double nearness)
{
    const uint32_t apart = keep_positive(distances, count);
    if (apart == 0) {
        return 0;
    }
    const double median = take_sorted(distances, apart, apart / 2);
    const double near = fmin(take_sorted(distances, apart, apart / 10), nearness);
    return fmax(fmin(median, SPREAD * near), median / NEARER);
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
    extent->typical = typical_of(values, count, nearness);
    if (extent->typical == 0) {
        extent->typical = exp(fmin(fmax(extent->log_scale.most, -30), 30));
    }
    for (uint32_t i = 0; i < count; i++) {
        extent->far += values[i] > reach_of(extent);
    }
}

int scene_extent_of(const scene_rows *rows, scene_extent *out, char *error, size_t error_bytes)
{
    double(*positions)[3] = malloc(rows->count * sizeof *positions);
    double *values = malloc(rows->count * sizeof *values);
    int result = positions != NULL && values != NULL
                     ? read_positions(rows, positions, out, error, error_bytes)
                     : t3r_reason(error, error_bytes, "out of memory for %" PRIu32 " Gaussians", rows->count);
    if (result == 0) {
        measure(positions, values, rows->count, out);
    }
    free(positions);
    free(values);
    return result;
}

bool scene_pull(scene_row *row, const double centre[3], double reach)
{
    const double distance = distance_of(row->position, centre);
    if (!(distance > reach)) {
        return false;
    }
    const double share = reach / distance;
    for (int axis = 0; axis < 3; axis++) {
        row->position[axis] = centre[axis] + share * (row->position[axis] - centre[axis]);
        row->log_scale[axis] += log(share);
    }
    return true;
}
