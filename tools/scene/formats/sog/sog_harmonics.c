/* SPDX-License-Identifier: Apache-2.0 */
#include "scene/formats/sog/sog_harmonics.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

#include "scene/formats/sog/palette.h"
#include "scene/formats/sog/sog.h"

/* Returns the number of palette entries: as many as Gaussians, or half as many; more entries per Gaussian make the file
 * larger. */
static uint32_t entries_of(uint32_t count)
{
    uint32_t entries = PALETTE_ROWS_MOST;
    while (entries > count) {
        entries /= 2;
    }
    return entries;
}

/* Returns the largest coefficient above degree 0, and at least what a scale of 1/4096 holds. */
static double largest_coefficient(const scene_source *source)
{
    double largest = INT16_MAX / 4096.0;
    for (uint32_t i = 0; i < source->rows->count; i++) {
        scene_row row;
        scene_source_row(source, i, &row);
        for (uint32_t k = 0; k < 3 * harmonics_rest(source->degree); k++) {
            largest = fmax(largest, fabs(row.rest[k / 3][k % 3]));
        }
    }
    return largest;
}

/* Returns the coefficients above degree 0 of all Gaussians, times `scale`; free() them. NULL: out of memory. */
static int16_t *coefficients_of(const scene_source *source, double scale)
{
    const uint32_t width = 3 * harmonics_rest(source->degree);
    int16_t *scaled = malloc((size_t)source->rows->count * width * sizeof *scaled);
    for (uint32_t i = 0; i < source->rows->count && scaled != NULL; i++) {
        scene_row row;
        scene_source_row(source, i, &row);
        for (uint32_t k = 0; k < width; k++) {
            scaled[(size_t)i * width + k] = (int16_t)nearbyint(row.rest[k / 3][k % 3] * scale);
        }
    }
    return scaled;
}

static int begin_texels(webp_texels *out, uint32_t width, uint32_t height)
{
    *out = (webp_texels){width, height, calloc((size_t)width * height, 4)};
    return out->rgba != NULL ? 0 : -1;
}

/* Makes the codebook of all means, and the picture of their indices. */
static int fill_centroids(const palette *made, sog_harmonics *out)
{
    const size_t count = (size_t)made->rows * made->width;
    const uint32_t rest = made->width / 3;
    double *values = malloc(count * sizeof *values);
    if (values == NULL || begin_texels(&out->centroids, SOG_CENTROIDS_A_ROW * rest,
                                       (made->rows + SOG_CENTROIDS_A_ROW - 1) / SOG_CENTROIDS_A_ROW) != 0) {
        free(values);
        return -1;
    }
    for (size_t i = 0; i < count; i++) {
        values[i] = made->means[i];
    }
    codebook_make(values, count, out->codebook);
    free(values);
    for (size_t i = 0; i < count; i++) {
        /* a row of the picture holds SOG_CENTROIDS_A_ROW entries, so the texels are contiguous */
        out->centroids.rgba[i / 3 * 4 + i % 3] = codebook_index(out->codebook, made->means[i]);
        out->centroids.rgba[i / 3 * 4 + 3] = 255;
    }
    return 0;
}

static void fill_labels(const palette *made, const uint32_t *order, uint32_t count, webp_texels *out)
{
    for (uint32_t i = 0; i < count; i++) {
        const uint16_t label = made->labels[order[i]];
        uint8_t *texel = out->rgba + (size_t)i * 4;
        texel[0] = (uint8_t)label;
        texel[1] = (uint8_t)(label >> 8);
        texel[3] = 255;
    }
}

int sog_harmonics_make(const scene_source *source, const uint32_t *order, uint32_t width, uint32_t height,
                       sog_harmonics *out)
{
    const uint32_t count = source->rows->count, values = 3 * harmonics_rest(source->degree);
    palette made;
    *out = (sog_harmonics){0};
    const double scale = INT16_MAX / largest_coefficient(source);
    int16_t *scaled = coefficients_of(source, scale);
    const bool is_made = scaled != NULL && palette_make(scaled, count, values, values, entries_of(count), &made) == 0;
    free(scaled);
    if (!is_made) {
        return -1;
    }
    for (size_t i = 0; i < (size_t)made.rows * made.width; i++) {
        made.means[i] /= scale;
    }
    const int result = fill_centroids(&made, out) == 0 && begin_texels(&out->labels, width, height) == 0 ? 0 : -1;
    if (result == 0) {
        out->count = made.rows;
        fill_labels(&made, order, count, &out->labels);
    }
    palette_free(&made);
    return result;
}

void sog_harmonics_free(sog_harmonics *made)
{
    webp_texels_free(&made->centroids);
    webp_texels_free(&made->labels);
}
