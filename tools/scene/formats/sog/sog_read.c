/* SPDX-License-Identifier: Apache-2.0 */
#include <inttypes.h>
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "cli/tables/json_input.h"
#include "host/reason.h"
#include "mcap/reader_limits.h"
#include "scene/formats/byte_codes.h"
#include "scene/formats/sog/codebook.h"
#include "scene/formats/sog/sog.h"
#include "scene/formats/sog/sog_archive.h"
#include "scene/formats/sog/webp_texels.h"

enum { CENTROIDS_MOST = 65536 }; /* limit of a label's 16 bits */

typedef struct sog_file {
    uint32_t count, degree;
    bool mip;
    webp_texels pictures[SOG_PICTURES], centroids, labels;
    uint32_t centroid_count;
    double low[3], high[3];
    double scales[CODEBOOK_VALUES], colours[CODEBOOK_VALUES], harmonics[CODEBOOK_VALUES];
} sog_file;

typedef struct reader {
    sog_archive *archive;
    char *error;
    size_t error_bytes;
} reader;

#define FAIL(r, ...) t3r_reason((r)->error, (r)->error_bytes, __VA_ARGS__)

static const cJSON *get(const cJSON *object, const char *name)
{
    return cJSON_GetObjectItemCaseSensitive(object, name);
}

/* Reads `count` finite numbers of an array. */
static int get_numbers(const reader *r, const cJSON *meta, const char *part, const char *name, int count, double *out)
{
    const cJSON *array = get(get(meta, part), name), *item;
    int at = 0;
    if (!cJSON_IsArray(array) || cJSON_GetArraySize(array) != count) {
        return FAIL(r, SOG_META ": %s has no %d %s", part, count, name);
    }
    cJSON_ArrayForEach(item, array)
    {
        if (!cJSON_IsNumber(item) || !isfinite(item->valuedouble)) {
            return FAIL(r, SOG_META ": %s of %s: not a number", name, part);
        }
        out[at++] = item->valuedouble;
    }
    return 0;
}

/* Reads a whole number of 0..most. */
static int get_whole(const reader *r, const cJSON *object, const char *name, uint64_t most, uint32_t *out)
{
    const cJSON *item = get(object, name);
    *out = 0;
    if (!cJSON_IsNumber(item) || !(item->valuedouble >= 0 && item->valuedouble <= (double)most) ||
        item->valuedouble != floor(item->valuedouble)) {
        return FAIL(r, SOG_META ": %s is missing or is not a whole number of 0..%" PRIu64, name, most);
    }
    *out = (uint32_t)item->valuedouble;
    return 0;
}

/* Reads the picture named by files[index] of a part, of `least` to `most` texels. */
static int read_picture(const reader *r, const cJSON *meta, const char *part, int index, uint64_t least, uint64_t most,
                        webp_texels *out)
{
    const cJSON *name = cJSON_GetArrayItem(get(get(meta, part), "files"), index);
    size_t size;
    if (!cJSON_IsString(name)) {
        return FAIL(r, SOG_META ": %s names no file %d", part, index);
    }
    uint8_t *bytes = sog_archive_read(r->archive, name->valuestring, &size, r->error, r->error_bytes);
    if (bytes == NULL) {
        return -1;
    }
    char reason[128] = "";
    int result = webp_texels_read(bytes, size, most, out, reason, sizeof reason);
    if (result == 0 && (uint64_t)out->width * out->height < least) {
        (void)t3r_reason(reason, sizeof reason, "%" PRIu32 "x%" PRIu32 " texels; at least %" PRIu64 " are needed",
                         out->width, out->height, least);
        result = -1;
    }
    free(bytes);
    return result == 0 ? 0 : FAIL(r, "%s: %s", name->valuestring, reason);
}

static int read_harmonics(const reader *r, const cJSON *meta, uint64_t most, sog_file *out)
{
    const cJSON *part = get(meta, "shN");
    if (part == NULL) {
        return 0;
    }
    if (get_whole(r, part, "bands", HARMONICS_DEGREE_MOST, &out->degree) != 0 ||
        get_whole(r, part, "count", CENTROIDS_MOST, &out->centroid_count) != 0) {
        return -1;
    }
    const uint32_t rest = harmonics_rest(out->degree);
    const uint32_t rows = (out->centroid_count + SOG_CENTROIDS_A_ROW - 1) / SOG_CENTROIDS_A_ROW;
    const uint64_t texels = (uint64_t)SOG_CENTROIDS_A_ROW * rest * rows;
    if (out->degree == 0) {
        return 0;
    }
    if (get_numbers(r, meta, "shN", "codebook", CODEBOOK_VALUES, out->harmonics) != 0 ||
        read_picture(r, meta, "shN", 0, texels,
                     (uint64_t)SOG_CENTROIDS_A_ROW * rest * (CENTROIDS_MOST / SOG_CENTROIDS_A_ROW),
                     &out->centroids) != 0 ||
        read_picture(r, meta, "shN", 1, out->count, most, &out->labels) != 0) {
        return -1;
    }
    return out->centroids.width == SOG_CENTROIDS_A_ROW * rest
               ? 0
               : FAIL(r, "the centroids are not %u in a row", SOG_CENTROIDS_A_ROW);
}

static int read_meta(const reader *r, const cJSON *meta, uint64_t packed, sog_file *out)
{
    static const struct {
        const char *part;
        int index;
    } files[SOG_PICTURES] = {{"means", 0}, {"means", 1}, {"scales", 0}, {"quats", 0}, {"sh0", 0}};
    uint32_t version;
    if (get(meta, "version") == NULL && get(meta, "means") != NULL) {
        return FAIL(r, SOG_META ": SOG of version 1; %d is read: convert it by PlayCanvas's splat-transform",
                    SOG_VERSION);
    }
    if (get_whole(r, meta, "version", UINT32_MAX, &version) != 0) {
        return -1;
    }
    if (version != SOG_VERSION) {
        return FAIL(r, SOG_META ": version %" PRIu32 "; %d is read", version, SOG_VERSION);
    }
    if (get_whole(r, meta, "count", t3r_limit_gaussians(packed), &out->count) != 0 ||
        get_numbers(r, meta, "means", "mins", 3, out->low) != 0 ||
        get_numbers(r, meta, "means", "maxs", 3, out->high) != 0 ||
        get_numbers(r, meta, "scales", "codebook", CODEBOOK_VALUES, out->scales) != 0 ||
        get_numbers(r, meta, "sh0", "codebook", CODEBOOK_VALUES, out->colours) != 0) {
        return -1;
    }
    if (out->count == 0) {
        return FAIL(r, SOG_META ": the file holds no Gaussians");
    }
    const cJSON *model = get(meta, "model");
    out->mip = cJSON_IsString(model) && strcmp(model->valuestring, SOG_MODEL_MIP) == 0;
    const uint64_t most = 2 * (uint64_t)out->count + 4096; /* writers pad rows and columns */
    for (int i = 0; i < SOG_PICTURES; i++) {
        if (read_picture(r, meta, files[i].part, files[i].index, out->count, most, &out->pictures[i]) != 0) {
            return -1;
        }
    }
    return read_harmonics(r, meta, most, out);
}

static int unpack_rotation(const uint8_t *texel, double rotation[4])
{
    const int largest = texel[3] - SOG_ROTATION_TAG;
    double left = 1;
    if (largest < 0) {
        return -1;
    }
    for (int i = 0, at = 0; i < 4; i++) {
        if (i != largest) {
            rotation[i] = (texel[at++] / 255.0 - 0.5) * M_SQRT2;
            left -= rotation[i] * rotation[i];
        }
    }
    rotation[largest] = sqrt(fmax(left, 0));
    return 0;
}

static void unpack_harmonics(const sog_file *sog, uint32_t index, scene_row *row)
{
    const uint8_t *texel = sog->labels.rgba + (size_t)index * 4;
    const uint32_t label = texel[0] | (uint32_t)texel[1] << 8, rest = harmonics_rest(sog->degree);
    if (label >= sog->centroid_count) {
        return;
    }
    /* the picture has all centroids' texels, SOG_CENTROIDS_A_ROW centroids in a row */
    const uint8_t *centroid = sog->centroids.rgba + (size_t)label * rest * 4;
    for (uint32_t i = 0; i < rest; i++) {
        for (int channel = 0; channel < 3; channel++) {
            row->rest[i][channel] = sog->harmonics[centroid[4 * i + (uint32_t)channel]];
        }
    }
}

static int read_row(void *user, uint32_t index, scene_row *row, char *error, size_t error_bytes)
{
    const sog_file *sog = user;
    const uint8_t *texel[SOG_PICTURES];
    for (int i = 0; i < SOG_PICTURES; i++) {
        texel[i] = sog->pictures[i].rgba + (size_t)index * 4;
    }
    *row = (scene_row){.opacity_logit = logit_of_byte(texel[SOG_COLOURS][3])};
    for (int k = 0; k < 3; k++) {
        const double share = (texel[SOG_MEANS_LOW][k] | texel[SOG_MEANS_HIGH][k] << 8) / 65535.0;
        const double at = sog->low[k] + (sog->high[k] - sog->low[k]) * share;
        row->position[k] = copysign(expm1(fabs(at)), at);
        row->log_scale[k] = sog->scales[texel[SOG_SCALES][k]];
        row->harmonic[k] = sog->colours[texel[SOG_COLOURS][k]];
        if (!isfinite(row->position[k])) {
            return t3r_reason(error, error_bytes, "Gaussian %" PRIu32 ": a position that is not finite", index);
        }
    }
    if (unpack_rotation(texel[SOG_ROTATIONS], row->rotation) != 0) {
        return t3r_reason(error, error_bytes, "Gaussian %" PRIu32 ": a rotation without its tag", index);
    }
    if (sog->degree > 0) {
        unpack_harmonics(sog, index, row);
    }
    return 0;
}

static int read_archive(const reader *r, uint64_t packed, sog_file *out)
{
    size_t size;
    char reason[128] = "";
    uint8_t *text = sog_archive_read(r->archive, SOG_META, &size, r->error, r->error_bytes);
    if (text == NULL) {
        return -1;
    }
    cJSON *meta = json_parse((const char *)text, size, reason, sizeof reason);
    const int result = meta == NULL ? FAIL(r, SOG_META ": %s", reason) : read_meta(r, meta, packed, out);
    cJSON_Delete(meta);
    free(text);
    return result;
}

int sog_parse(const uint8_t *bytes, size_t count, const scene_sink *sink, char *error, size_t error_bytes)
{
    sog_file sog = {0};
    const reader r = {sog_archive_open(bytes, count, error, error_bytes), error, error_bytes};
    if (r.archive == NULL) {
        return -1;
    }
    int result = read_archive(&r, count, &sog);
    sog_archive_close(r.archive);
    if (result == 0) {
        const scene_rows rows = {
            .count = sog.count, .degree = sog.degree, .mip = sog.mip, .read = read_row, .user = &sog};
        result = sink->take(sink->user, &rows, error, error_bytes);
    }
    for (int i = 0; i < SOG_PICTURES; i++) {
        webp_texels_free(&sog.pictures[i]);
    }
    webp_texels_free(&sog.centroids);
    webp_texels_free(&sog.labels);
    return result;
}
