/* SPDX-License-Identifier: Apache-2.0 */
/* Orders Gaussians along a Z-order curve, so that neighbours in the pictures are neighbours in the scene. */
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <zip.h>

#include "host/reason.h"
#include "scene/formats/byte_codes.h"
#include "scene/formats/json_stream.h"
#include "scene/formats/sog/codebook.h"
#include "scene/formats/sog/sog.h"
#include "scene/formats/sog/sog_harmonics.h"
#include "scene/formats/sog/webp_texels.h"
#include "scene/scene_order.h"

static const char *const names[SOG_PICTURES] = {"means_l.webp", "means_u.webp", "scales.webp", "quats.webp",
                                                "sh0.webp"};
static const char *const harmonics_names[] = {"shN_centroids.webp", "shN_labels.webp"};

typedef struct sog_file {
    webp_texels pictures[SOG_PICTURES];
    double low[3], high[3]; /* bounds of the logarithms of positions */
    double scales[CODEBOOK_VALUES], colours[CODEBOOK_VALUES];
    bool mip;
    uint32_t degree; /* 0: no harmonics */
    sog_harmonics harmonics;
} sog_file;

static double logarithm(double position)
{
    return copysign(log1p(fabs(position)), position);
}

/* Computes bounds and codebooks. Returns 0, or -1 without memory. */
static int survey(const scene_source *source, sog_file *sog)
{
    const size_t count = source->rows->count;
    double *scales = malloc((3 * count + 1) * sizeof *scales), *colours = malloc((3 * count + 1) * sizeof *colours);
    const bool is_made = scales != NULL && colours != NULL;
    for (uint32_t i = 0; i < count && is_made; i++) {
        scene_row row;
        scene_source_row(source, i, &row);
        for (int k = 0; k < 3; k++) {
            const double at = logarithm(row.position[k]);
            sog->low[k] = i == 0 ? at : fmin(sog->low[k], at);
            sog->high[k] = i == 0 ? at : fmax(sog->high[k], at);
            scales[3 * i + (uint32_t)k] = row.log_scale[k];
            colours[3 * i + (uint32_t)k] = row.harmonic[k];
        }
    }
    if (is_made && count > 0) {
        codebook_make(scales, 3 * count, sog->scales);
        codebook_make(colours, 3 * count, sog->colours);
    }
    free(scales);
    free(colours);
    return is_made ? 0 : -1;
}

static void put_rotation(uint8_t *texel, const double rotation[4])
{
    int largest = 0;
    for (int i = 1; i < 4; i++) {
        largest = fabs(rotation[i]) > fabs(rotation[largest]) ? i : largest;
    }
    const double by = copysign(M_SQRT1_2, rotation[largest]);
    for (int i = 0, at = 0; i < 4; i++) {
        if (i != largest) {
            texel[at++] = byte_of(255 * (by * rotation[i] + 0.5));
        }
    }
    texel[3] = (uint8_t)(SOG_ROTATION_TAG + largest);
}

static void put_row(const scene_row *row, const sog_file *sog, uint8_t *texels[SOG_PICTURES])
{
    for (int k = 0; k < 3; k++) {
        const double size = sog->high[k] - sog->low[k];
        const double share = size > 0 ? (logarithm(row->position[k]) - sog->low[k]) / size : 0;
        const uint32_t steps = (uint32_t)nearbyint(fmin(fmax(share, 0), 1) * 65535);
        texels[SOG_MEANS_LOW][k] = (uint8_t)steps;
        texels[SOG_MEANS_HIGH][k] = (uint8_t)(steps >> 8);
        texels[SOG_SCALES][k] = codebook_index(sog->scales, row->log_scale[k]);
        texels[SOG_COLOURS][k] = codebook_index(sog->colours, row->harmonic[k]);
    }
    texels[SOG_MEANS_LOW][3] = texels[SOG_MEANS_HIGH][3] = texels[SOG_SCALES][3] = 255;
    texels[SOG_COLOURS][3] = byte_of(255 * scene_row_opacity(row));
    put_rotation(texels[SOG_ROTATIONS], row->rotation);
}

/* Allocates pictures, as nearly square as sides of multiples of 4 allow. Returns 0, or -1 without memory. */
static int begin_pictures(sog_file *sog, uint32_t count)
{
    const uint32_t width = 4 * (uint32_t)ceil(sqrt(count) / 4), height = 4 * ((count + 4 * width - 1) / (4 * width));
    for (int i = 0; i < SOG_PICTURES; i++) {
        sog->pictures[i] = (webp_texels){width, height, calloc((size_t)width * height, 4)};
        if (sog->pictures[i].rgba == NULL) {
            return -1;
        }
    }
    return 0;
}

static int fill_pictures(const scene_source *source, sog_file *sog)
{
    uint32_t *order = scene_order_morton(source);
    for (uint32_t i = 0; i < source->rows->count && order != NULL; i++) {
        scene_row row;
        uint8_t *texels[SOG_PICTURES];
        for (int k = 0; k < SOG_PICTURES; k++) {
            texels[k] = sog->pictures[k].rgba + (size_t)i * 4;
        }
        scene_source_row(source, order[i], &row);
        put_row(&row, sog, texels);
    }
    int result = order != NULL ? 0 : -1;
    if (result == 0 && sog->degree > 0) {
        const webp_texels *as = &sog->pictures[0];
        result = sog_harmonics_make(source, order, as->width, as->height, &sog->harmonics);
    }
    free(order);
    return result;
}

/* Appends ,"files":["...",...]. */
static void put_files(json_stream *json, const char *const *first, int count)
{
    json_stream_put(json, ",\"files\":[");
    for (int i = 0; i < count; i++) {
        json_stream_put(json, "%s\"%s\"", i > 0 ? "," : "", first[i]);
    }
    json_stream_put(json, "]");
}

static void put_codebook(json_stream *json, const double values[CODEBOOK_VALUES])
{
    json_stream_numbers(json, "codebook", values, CODEBOOK_VALUES);
}

/* Returns meta.json; free() it. NULL: out of memory. */
static char *make_meta(const sog_file *sog, uint32_t count)
{
    json_stream json;
    json_stream_begin(&json);
    json_stream_put(&json, "{\"asset\":{\"generator\":\"trim3r\"},\"version\":%d,\"count\":%" PRIu32, SOG_VERSION,
                    count);
    if (sog->mip) {
        json_stream_put(&json, ",\"model\":\"%s\"", SOG_MODEL_MIP);
    }
    json_stream_put(&json, ",\"means\":{");
    json_stream_numbers(&json, "mins", sog->low, 3);
    json_stream_put(&json, ",");
    json_stream_numbers(&json, "maxs", sog->high, 3);
    put_files(&json, &names[SOG_MEANS_LOW], 2);
    json_stream_put(&json, "},\"scales\":{");
    put_codebook(&json, sog->scales);
    put_files(&json, &names[SOG_SCALES], 1);
    json_stream_put(&json, "},\"quats\":{\"files\":[\"%s\"]},\"sh0\":{", names[SOG_ROTATIONS]);
    put_codebook(&json, sog->colours);
    put_files(&json, &names[SOG_COLOURS], 1);
    if (sog->degree > 0) {
        json_stream_put(&json, "},\"shN\":{\"count\":%" PRIu32 ",\"bands\":%" PRIu32 ",", sog->harmonics.count,
                        sog->degree);
        put_codebook(&json, sog->harmonics.codebook);
        put_files(&json, harmonics_names, 2);
    }
    json_stream_put(&json, "}}");
    return json_stream_end(&json);
}

/* The archive's members, which libzip reads when it closes the archive. They stay ours: where it fails to take one, it
 * frees its bytes in some cases and not in others. */
typedef struct held_members {
    uint8_t *bytes[SOG_PICTURES + 3];
    uint32_t count;
} held_members;

/* Adds a member, stored, since pictures are compressed already, and holds its bytes. Returns 0, or -1. */
static int add_member(zip_t *zip, held_members *held, const char *name, uint8_t *bytes, size_t count)
{
    held->bytes[held->count++] = bytes;
    zip_source_t *source = zip_source_buffer(zip, bytes, count, 0);
    if (source == NULL) {
        return -1;
    }
    const zip_int64_t index = zip_file_add(zip, name, source, 0);
    if (index < 0) {
        zip_source_free(source);
        return -1;
    }
    /* a fixed time stamp: the same scene gives the same bytes */
    return zip_set_file_compression(zip, (zip_uint64_t)index, ZIP_CM_STORE, 0) == 0 &&
                   zip_file_set_dostime(zip, (zip_uint64_t)index, 0, 33, 0) == 0
               ? 0
               : -1;
}

static int add_picture(zip_t *zip, held_members *held, const char *name, const webp_texels *picture, char *error,
                       size_t error_bytes)
{
    uint8_t *bytes;
    size_t size;
    if (webp_texels_write(picture, &bytes, &size, error, error_bytes) != 0) {
        return -1;
    }
    return add_member(zip, held, name, bytes, size) == 0
               ? 0
               : t3r_reason(error, error_bytes, "%s: %s", name, zip_strerror(zip));
}

static int add_members(zip_t *zip, held_members *held, const sog_file *sog, uint32_t count, char *error,
                       size_t error_bytes)
{
    for (int i = 0; i < SOG_PICTURES; i++) {
        if (add_picture(zip, held, names[i], &sog->pictures[i], error, error_bytes) != 0) {
            return -1;
        }
    }
    if (sog->degree > 0 &&
        (add_picture(zip, held, harmonics_names[0], &sog->harmonics.centroids, error, error_bytes) != 0 ||
         add_picture(zip, held, harmonics_names[1], &sog->harmonics.labels, error, error_bytes) != 0)) {
        return -1;
    }
    char *meta = make_meta(sog, count);
    return meta != NULL && add_member(zip, held, SOG_META, (uint8_t *)meta, strlen(meta)) == 0
               ? 0
               : t3r_reason(error, error_bytes, SOG_META ": out of memory");
}

static int copy_source(zip_source_t *source, FILE *file)
{
    uint8_t bytes[4096];
    zip_int64_t got = zip_source_open(source) == 0 ? 1 : -1;
    while (got > 0) {
        got = zip_source_read(source, bytes, sizeof bytes);
        if (got > 0) {
            fwrite(bytes, 1, (size_t)got, file);
        }
    }
    zip_source_close(source);
    return got < 0 ? -1 : 0;
}

static int write_archive(FILE *file, const sog_file *sog, uint32_t count, char *error, size_t error_bytes)
{
    zip_error_t why;
    held_members held = {.count = 0};
    zip_error_init(&why);
    zip_source_t *archive = zip_source_buffer_create(NULL, 0, 0, &why);
    zip_t *zip = archive != NULL ? zip_open_from_source(archive, ZIP_CREATE | ZIP_TRUNCATE, &why) : NULL;
    int result = -1;
    if (zip == NULL) {
        (void)t3r_reason(error, error_bytes, "%s", zip_error_strerror(&why));
    } else {
        zip_source_keep(archive);
        result = add_members(zip, &held, sog, count, error, error_bytes);
        if (result != 0 || zip_close(zip) != 0) {
            zip_discard(zip);
            result = result != 0 ? result : t3r_reason(error, error_bytes, "the archive was not made");
        } else if (copy_source(archive, file) != 0) {
            result = t3r_reason(error, error_bytes, "the archive was not copied");
        }
    }
    for (uint32_t i = 0; i < held.count; i++) {
        free(held.bytes[i]);
    }
    if (archive != NULL) {
        zip_source_free(archive);
    }
    zip_error_fini(&why);
    return result;
}

int sog_write(FILE *file, const scene_source *source, char *error, size_t error_bytes)
{
    const uint32_t count = source->rows->count;
    sog_file sog = {.mip = source->rows->mip, .degree = source->degree};
    int result = survey(source, &sog) == 0 && begin_pictures(&sog, count) == 0 && fill_pictures(source, &sog) == 0
                     ? 0
                     : t3r_reason(error, error_bytes, "out of memory for %" PRIu32 " Gaussians", count);
    if (result == 0) {
        result = write_archive(file, &sog, count, error, error_bytes);
    }
    for (int i = 0; i < SOG_PICTURES; i++) {
        webp_texels_free(&sog.pictures[i]);
    }
    sog_harmonics_free(&sog.harmonics);
    return result;
}
