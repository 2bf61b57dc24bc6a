/* SPDX-License-Identifier: Apache-2.0 */
/* cameras.bin: count (8 bytes), then each: number (4), model (4), width (8), height (8), parameters (8 each).
 * images.bin: count (8), then each: number (4), quaternion and translation (7 x 8), camera (4), name and a zero byte,
 * count of points (8), points (24 each). Little-endian. */
#include <inttypes.h>
#include <string.h>

#include "host/little_floats.h"
#include "host/reason.h"
#include "import/colmap/colmap_camera.h"
#include "import/colmap/colmap_model.h"
#include "mcap/reader_limits.h"

#define POINT_BYTES 24

static bool take_bytes(FILE *file, void *bytes, size_t count)
{
    return fread(bytes, 1, count, file) == count;
}

static bool take_u32(FILE *file, uint32_t *value)
{
    uint8_t bytes[4];
    bool taken = take_bytes(file, bytes, sizeof bytes);
    *value = taken ? t3r_load_le32(bytes) : 0;
    return taken;
}

static bool take_u64(FILE *file, uint64_t *value)
{
    uint8_t bytes[8];
    bool taken = take_bytes(file, bytes, sizeof bytes);
    *value = taken ? t3r_load_le64(bytes) : 0;
    return taken;
}

static bool take_doubles(FILE *file, double *values, uint32_t count)
{
    bool taken = true;
    for (uint32_t i = 0; i < count && taken; i++) {
        uint8_t bytes[8];
        taken = take_bytes(file, bytes, sizeof bytes);
        values[i] = taken ? t3r_load_double(bytes) : 0;
    }
    return taken;
}

static const char *cut = "the file ends in it";

static const char *read_camera(FILE *file, colmap_model *model)
{
    uint32_t id, lens_id;
    uint64_t width, height;
    double parameters[COLMAP_PARAMETERS_MOST];
    if (!take_u32(file, &id) || !take_u32(file, &lens_id) || !take_u64(file, &width) || !take_u64(file, &height)) {
        return cut;
    }
    const colmap_camera_model *lens = lens_id <= INT32_MAX ? colmap_model_of_id((int32_t)lens_id) : NULL;
    if (lens == NULL) {
        return "an unknown camera model";
    }
    if (!take_doubles(file, parameters, colmap_model_parameters(lens))) {
        return cut;
    }
    colmap_camera camera = {.id = id};
    camera.wrong = colmap_intrinsics(lens, parameters, width, height, &camera.intrinsics);
    return colmap_model_add_camera(model, &camera);
}

/* Returns NULL, or what is wrong. */
static const char *take_name(FILE *file, char name[COLMAP_NAME_BYTES])
{
    for (uint32_t length = 0; length < COLMAP_NAME_BYTES; length++) {
        int c = getc_unlocked(file);
        if (c == EOF) {
            return cut;
        }
        name[length] = (char)c;
        if (c == '\0') {
            return NULL;
        }
    }
    return "a name of more than 4096 bytes";
}

static const char *read_image(FILE *file, colmap_model *model)
{
    uint32_t id, camera;
    uint64_t points;
    rigid pose;
    char name[COLMAP_NAME_BYTES];
    if (!take_u32(file, &id) || !take_doubles(file, pose.rotation, 4) || !take_doubles(file, pose.position, 3) ||
        !take_u32(file, &camera)) {
        return cut;
    }
    const char *wrong = take_name(file, name);
    if (wrong != NULL) {
        return wrong;
    }
    /* a jump past the end is noticed at the next image, or does no harm */
    if (!take_u64(file, &points) || points > INT64_MAX / POINT_BYTES ||
        fseeko(file, (off_t)(points * POINT_BYTES), SEEK_CUR) != 0) {
        return "its points reach past the file's end";
    }
    return colmap_model_add_image(model, name, camera, pose);
}

/* Reads a count, and that many items with `read`. Every item takes at least the bytes of its fields, so a false count
 * ends at the end of the file. */
static int read_all(FILE *file, colmap_model *model, const char *(*read)(FILE *file, colmap_model *model),
                    const char *what, char *error, size_t error_bytes)
{
    uint64_t count;
    if (!take_u64(file, &count)) {
        return t3r_reason(error, error_bytes, "shorter than its count of %ss", what);
    }
    for (uint64_t i = 0; i < count; i++) {
        const char *wrong = read(file, model);
        if (wrong != NULL) {
            return t3r_reason(error, error_bytes, "%s %" PRIu64 " of %" PRIu64 ": %s", what, i + 1, count, wrong);
        }
    }
    return 0;
}

int colmap_read_cameras_binary(FILE *file, colmap_model *model, char *error, size_t error_bytes)
{
    return read_all(file, model, read_camera, "camera", error, error_bytes);
}

int colmap_read_images_binary(FILE *file, colmap_model *model, char *error, size_t error_bytes)
{
    return read_all(file, model, read_image, "image", error, error_bytes);
}
