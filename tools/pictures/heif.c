/* SPDX-License-Identifier: Apache-2.0 */
#include "pictures/heif.h"

#include "host/reason.h"

#ifdef T3R_HEIF

#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "pictures/exif.h"
#include "pictures/heif_functions.h"
#include "pictures/heif_references.h"

#define FILE_BYTES_MOST (256L << 20)
#define BRAND_AT 4u /* "ftyp" and a brand of four letters */
#define BRAND_BYTES 8u
#define TILE_MOST 1024  /* side of a grid's tile, of which a small picture shows a part */
#define OFFSET_BYTES 4u /* before EXIF, of its TIFF header */

typedef struct heif_file {
    const heif_functions *call;
    uint8_t *bytes;
    size_t count;
    struct heif_context *context;
    struct heif_image_handle *handle;
    struct heif_image *image;
} heif_file;

int heif_describe(char *text, size_t text_bytes)
{
    const heif_functions *call = heif_functions_load(text, text_bytes);
    if (call != NULL) {
        snprintf(text, text_bytes, "libheif %s", call->get_version());
    }
    return call != NULL ? 0 : -1;
}

bool heif_is(const uint8_t *bytes, size_t count)
{
    static const char *const brands[] = {"heic", "heix", "heim", "heis", "mif1", "avif"};
    for (size_t i = 0; i < sizeof brands / sizeof *brands && count >= BRAND_AT + BRAND_BYTES; i++) {
        if (memcmp(bytes + BRAND_AT, "ftyp", 4) == 0 && memcmp(bytes + BRAND_AT + 4, brands[i], 4) == 0) {
            return true;
        }
    }
    return false;
}

bool heif_is_named(const char *name)
{
    const char *dot = strrchr(name, '.');
    return dot != NULL &&
           (strcasecmp(dot, ".heic") == 0 || strcasecmp(dot, ".heif") == 0 || strcasecmp(dot, ".avif") == 0);
}

static int failed(struct heif_error is, char *error, size_t error_bytes)
{
    return is.code == heif_error_Ok ? 0 : t3r_reason(error, error_bytes, "HEIF: %s", is.message);
}

static int load(heif_file *h, FILE *file, char *error, size_t error_bytes)
{
    const long bytes = fseek(file, 0, SEEK_END) == 0 ? ftell(file) : -1;
    h->bytes = bytes > 0 && bytes <= FILE_BYTES_MOST && fseek(file, 0, SEEK_SET) == 0 ? malloc((size_t)bytes) : NULL;
    h->count = h->bytes != NULL ? fread(h->bytes, 1, (size_t)bytes, file) : 0;
    return h->count > 0 ? 0 : t3r_reason(error, error_bytes, "HEIF: the file cannot be read, or has over 256 MiB");
}

/* Reads the lens alone: the library turns the picture as the file states. */
static int read_exif(const heif_file *h, picture *out)
{
    heif_item_id id;
    if (h->call->image_handle_get_list_of_metadata_block_IDs(h->handle, "Exif", &id, 1) != 1) {
        return 0;
    }
    const size_t count = h->call->image_handle_get_metadata_size(h->handle, id);
    uint8_t *block = malloc(count + 1);
    if (block == NULL) {
        return -1;
    }
    if (count > OFFSET_BYTES && h->call->image_handle_get_metadata(h->handle, id, block).code == heif_error_Ok) {
        const size_t offset = (size_t)block[0] << 24 | (size_t)block[1] << 16 | (size_t)block[2] << 8 | block[3];
        const size_t at = offset < count - OFFSET_BYTES ? OFFSET_BYTES + offset : count;
        out->focal_35mm = exif_read(block + at, count - at).focal_35mm;
    }
    free(block);
    return 0;
}

static int open_picture(heif_file *h, uint32_t most_side, picture *out, char *error, size_t error_bytes)
{
    const char *wrong = heif_references_check(h->bytes, h->count);
    if (wrong != NULL) {
        return t3r_reason(error, error_bytes, "HEIF: %s", wrong);
    }
    h->context = h->call->context_alloc();
    if (h->context == NULL) {
        return t3r_reason(error, error_bytes, "out of memory");
    }
    h->call->context_set_maximum_image_size_limit(h->context, (int)most_side);
    if (failed(h->call->context_read_from_memory_without_copy(h->context, h->bytes, h->count, NULL), error,
               error_bytes) != 0 ||
        failed(h->call->context_get_primary_image_handle(h->context, &h->handle), error, error_bytes) != 0) {
        return -1;
    }
    const int width = h->call->image_handle_get_width(h->handle), height = h->call->image_handle_get_height(h->handle);
    if (width < 1 || height < 1 || (uint32_t)width > most_side || (uint32_t)height > most_side ||
        (uint64_t)width * (uint64_t)height > PICTURE_LARGEST_PIXELS) {
        return t3r_reason(error, error_bytes, "HEIF: image exceeds the largest size");
    }
    out->width = (uint32_t)width;
    out->height = (uint32_t)height;
    out->channels = h->call->image_handle_has_alpha_channel(h->handle) ? 4 : 3;
    out->bits = 8;
    out->orientation = EXIF_UPRIGHT;
    return read_exif(h, out) == 0 ? 0 : t3r_reason(error, error_bytes, "out of memory");
}

/* Limits what is decoded to the stored size, from which the library crops and turns the picture: a grid may state
 * another, and only that is decoded. */
static void limit_size(heif_file *h)
{
    const int width = h->call->image_handle_get_ispe_width(h->handle);
    const int height = h->call->image_handle_get_ispe_height(h->handle), side = width > height ? width : height;
    h->call->context_set_maximum_image_size_limit(h->context, side > TILE_MOST ? side : TILE_MOST);
}

static int decode(heif_file *h, picture *out, char *error, size_t error_bytes)
{
    limit_size(h);
    const enum heif_chroma form = out->channels == 4 ? heif_chroma_interleaved_RGBA : heif_chroma_interleaved_RGB;
    if (failed(h->call->decode_image(h->handle, &h->image, heif_colorspace_RGB, form, NULL), error, error_bytes) != 0) {
        return -1;
    }
    int stride;
    const uint8_t *plane = h->call->image_get_plane_readonly(h->image, heif_channel_interleaved, &stride);
    const size_t row = (size_t)out->width * out->channels;
    if (plane == NULL || stride < 0 || (size_t)stride < row ||
        h->call->image_get_width(h->image, heif_channel_interleaved) != (int)out->width ||
        h->call->image_get_height(h->image, heif_channel_interleaved) != (int)out->height) {
        return t3r_reason(error, error_bytes, "HEIF: the picture has another size than its header states");
    }
    out->samples = malloc(row * out->height);
    if (out->samples == NULL) {
        return t3r_reason(error, error_bytes, "out of memory");
    }
    for (size_t y = 0; y < out->height; y++) {
        memcpy((uint8_t *)out->samples + y * row, plane + y * (size_t)stride, row);
    }
    return 0;
}

int heif_read(FILE *file, uint32_t most_side, bool header_only, picture *out, char *error, size_t error_bytes)
{
    heif_file h = {.call = heif_functions_load(error, error_bytes)};
    if (h.call == NULL) {
        return -1;
    }
    int status = load(&h, file, error, error_bytes);
    status = status == 0 ? open_picture(&h, most_side, out, error, error_bytes) : status;
    status = status == 0 && !header_only ? decode(&h, out, error, error_bytes) : status;
    h.call->image_release(h.image);
    h.call->image_handle_release(h.handle);
    h.call->context_free(h.context);
    free(h.bytes);
    return status;
}

#else

int heif_describe(char *text, size_t text_bytes)
{
    return t3r_reason(text, text_bytes, "not in this build");
}

bool heif_is(const uint8_t *bytes, size_t count)
{
    (void)bytes;
    (void)count;
    return false;
}

bool heif_is_named(const char *name)
{
    (void)name;
    return false;
}

int heif_read(FILE *file, uint32_t most_side, bool header_only, picture *out, char *error, size_t error_bytes)
{
    (void)file;
    (void)most_side;
    (void)header_only;
    (void)out;
    return t3r_reason(error, error_bytes, "HEIF: not in this build");
}

#endif
