/* SPDX-License-Identifier: Apache-2.0 */
/* The whole file is in memory; the library reads it from there, a chunk (some lines, or a tile) at a time. */
#include "import/depth/exr_depth.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "host/file_bytes.h"
#include "host/reason.h"
#include "import/depth/raw_depth.h"
#include "mcap/reader_limits.h"
#include "trim3r.h"

bool exr_depth_is(const char *name)
{
    const char *dot = strrchr(name, '.');
    return dot != NULL && strcasecmp(dot, ".exr") == 0;
}

#ifdef T3R_EXR

#include <openexr.h>

enum {
    REASON_BYTES = 256,
    TILE_SIDE_LEAST = 8, /* smaller tiles, unless the picture is small, take longer to find than to decompress */
    TILE_SIDE_MOST =
        1024, /* a chunk is in memory four times: compressed, decompressed, while it decompresses, as floats */
    /* room for attributes, the table of chunks, and the chunks' own headers */
    FILE_BYTES_BESIDE = 16 << 20,
    ALLOCATION_MOST = 64 << 20, /* bounds what the library allocates on the header's word */
};

/* The decompressed size is bounded by the sides, whatever the size of the file. */
_Static_assert((uint64_t)T3R_MAX_SIDE *T3R_MAX_SIDE * sizeof(float) <= T3R_LIMIT_UNPACKED_FREE,
               "depth of the largest sides is within what compressed data may become");

typedef struct exr_file {
    const uint8_t *bytes;
    size_t count;
    exr_context_t context;
    char reason[REASON_BYTES]; /* the library's first message */
    exr_attr_box2i_t window;   /* in pixels, both ends inclusive */
    uint32_t width, height;    /* sides of the window */
    exr_storage_t storage;
    double unit;
    uint16_t *samples;       /* width x height */
    bool has_length, is_any; /* some number is a length; some length gave a step */
} exr_file;

const char *exr_depth_missing(void)
{
    return NULL;
}

/* ---- the library's callbacks ---- */

static int64_t give_bytes(exr_const_context_t context, void *user, void *buffer, uint64_t count, uint64_t offset,
                          exr_stream_error_func_ptr_t error)
{
    const exr_file *file = user;
    (void)context;
    (void)error;
    const uint64_t left = offset < file->count ? file->count - offset : 0;
    const uint64_t given = count < left ? count : left;
    if (given > 0) {
        memcpy(buffer, file->bytes + offset, given);
    }
    return (int64_t)given;
}

/* Allocates zeros, so that a damaged chunk that decompresses to less than it should leaves zeros. */
static void *allocate(size_t count)
{
    return count <= ALLOCATION_MOST ? calloc(count, 1) : NULL;
}

static int64_t give_count(exr_const_context_t context, void *user)
{
    (void)context;
    return (int64_t)((const exr_file *)user)->count;
}

static void take_message(exr_const_context_t context, exr_result_t code, const char *message)
{
    void *user = NULL;
    (void)code;
    if (context != NULL && exr_get_user_data(context, &user) == EXR_ERR_SUCCESS && user != NULL) {
        exr_file *file = user;
        if (file->reason[0] == '\0') {
            (void)t3r_reason(file->reason, sizeof file->reason, "%.200s", message);
        }
    }
}

/* Returns NULL, or the library's message. */
static const char *answer(const exr_file *file, exr_result_t code)
{
    return code == EXR_ERR_SUCCESS   ? NULL
           : file->reason[0] != '\0' ? file->reason
                                     : exr_get_default_error_message(code);
}

/* ---- the header: each function returns NULL, or what is wrong ---- */

static const char *check_channel(const exr_file *file)
{
    const exr_attr_chlist_t *channels = NULL;
    const char *wrong = answer(file, exr_get_channels(file->context, 0, &channels));
    if (wrong != NULL) {
        return wrong;
    }
    if (channels->num_channels != 1) {
        return "not one channel, but depth has one";
    }
    const exr_attr_chlist_entry_t *channel = &channels->entries[0];
    return channel->pixel_type != EXR_PIXEL_HALF && channel->pixel_type != EXR_PIXEL_FLOAT
               ? "its channel is neither half nor float"
           : channel->x_sampling != 1 || channel->y_sampling != 1 ? "its channel leaves pixels out"
                                                                  : NULL;
}

static const char *check_compression(const exr_file *file)
{
    exr_compression_t packing;
    const char *wrong = answer(file, exr_get_compression(file->context, 0, &packing));
    if (wrong != NULL) {
        return wrong;
    }
    switch (packing) {
    case EXR_COMPRESSION_NONE:
    case EXR_COMPRESSION_RLE:
    case EXR_COMPRESSION_ZIPS:
    case EXR_COMPRESSION_ZIP:
    case EXR_COMPRESSION_PIZ:
    case EXR_COMPRESSION_PXR24:
        return NULL;
    default:
        return "packed by B44 or DWA, which are for colour; NONE, RLE, ZIP, PIZ and PXR24 are read";
    }
}

static const char *take_window(exr_file *file)
{
    exr_attr_box2i_t display;
    exr_result_t code = exr_get_data_window(file->context, 0, &file->window);
    code = code == EXR_ERR_SUCCESS ? exr_get_display_window(file->context, 0, &display) : code;
    if (code != EXR_ERR_SUCCESS) {
        return answer(file, code);
    }
    const int64_t width = (int64_t)file->window.max.x - file->window.min.x + 1;
    const int64_t height = (int64_t)file->window.max.y - file->window.min.y + 1;
    if (width < 1 || height < 1 || width > T3R_MAX_SIDE || height > T3R_MAX_SIDE) {
        return "its sides are not from 1 to 4096 pixels";
    }
    file->width = (uint32_t)width;
    file->height = (uint32_t)height;
    return memcmp(&display, &file->window, sizeof display) == 0 ? NULL : "its data window is not its display window";
}

static const char *read_header(exr_file *file)
{
    const exr_context_initializer_t how = {.size = sizeof how,
                                           .error_handler_fn = take_message,
                                           .alloc_fn = allocate,
                                           .free_fn = free,
                                           .user_data = file,
                                           .read_fn = give_bytes,
                                           .size_fn = give_count,
                                           .max_image_width = T3R_MAX_SIDE,
                                           .max_image_height = T3R_MAX_SIDE,
                                           .max_tile_width = TILE_SIDE_MOST,
                                           .max_tile_height = TILE_SIDE_MOST,
                                           .zip_level = -2,
                                           .dwa_quality = -1,
                                           .flags = EXR_CONTEXT_FLAG_DISABLE_CHUNK_RECONSTRUCTION};
    int parts = 0;
    exr_result_t code = exr_start_read(&file->context, "depth", &how);
    code = code == EXR_ERR_SUCCESS ? exr_get_count(file->context, &parts) : code;
    if (code == EXR_ERR_SUCCESS && parts != 1) {
        return "not one part";
    }
    code = code == EXR_ERR_SUCCESS ? exr_get_storage(file->context, 0, &file->storage) : code;
    if (code != EXR_ERR_SUCCESS) {
        return answer(file, code);
    }
    if (file->storage != EXR_STORAGE_SCANLINE && file->storage != EXR_STORAGE_TILED) {
        return "neither lines nor tiles of pixels";
    }
    const char *wrong = check_channel(file);
    wrong = wrong != NULL ? wrong : check_compression(file);
    return wrong != NULL ? wrong : take_window(file);
}

/* ---- chunks ---- */

static const char *unpack(exr_file *file, const exr_chunk_info_t *chunk, float *numbers)
{
    exr_decode_pipeline_t work = EXR_DECODE_PIPELINE_INITIALIZER;
    exr_result_t code = exr_decoding_initialize(file->context, 0, chunk, &work);
    if (code == EXR_ERR_SUCCESS) {
        exr_coding_channel_info_t *channel = &work.channels[0];
        channel->decode_to_ptr = (uint8_t *)numbers;
        channel->user_data_type = EXR_PIXEL_FLOAT;
        channel->user_bytes_per_element = sizeof *numbers;
        channel->user_pixel_stride = sizeof *numbers;
        channel->user_line_stride = chunk->width * (int32_t)sizeof *numbers;
        code = exr_decoding_choose_default_routines(file->context, 0, &work);
        code = code == EXR_ERR_SUCCESS ? exr_decoding_run(file->context, 0, &work) : code;
    }
    (void)exr_decoding_destroy(file->context, &work);
    return answer(file, code);
}

/* Converts a chunk's numbers to samples from (x, y) on; the chunk must lie within the picture. */
static void put_steps(exr_file *file, const exr_chunk_info_t *chunk, uint32_t x, uint32_t y, const float *numbers)
{
    for (int32_t row = 0; row < chunk->height; row++) {
        uint16_t *out = file->samples + ((size_t)y + (uint32_t)row) * file->width + x;
        for (int32_t column = 0; column < chunk->width; column++) {
            const float length = *numbers++;
            out[column] = raw_depth_step(length, file->unit);
            file->has_length |= length > 0 && isfinite(length);
            file->is_any |= out[column] != 0;
        }
    }
}

/* Reads the chunk that covers width x height pixels from (x, y) on. */
static const char *take_chunk(exr_file *file, const exr_chunk_info_t *chunk, uint32_t x, uint32_t y, uint32_t width,
                              uint32_t height)
{
    if (chunk->width != (int32_t)width || chunk->height != (int32_t)height) {
        return "a chunk of other sides than its place has";
    }
    float *numbers = calloc((size_t)width * height, sizeof *numbers);
    const char *wrong = numbers != NULL ? unpack(file, chunk, numbers) : "out of memory";
    if (wrong == NULL) {
        put_steps(file, chunk, x, y, numbers);
    }
    free(numbers);
    return wrong;
}

static uint32_t least(uint32_t a, uint32_t b)
{
    return a < b ? a : b;
}

static const char *read_lines(exr_file *file)
{
    int32_t lines = 0;
    const char *wrong = answer(file, exr_get_scanlines_per_chunk(file->context, 0, &lines));
    if (wrong == NULL && lines < 1) {
        return "chunks without lines";
    }
    for (uint32_t y = 0; y < file->height && wrong == NULL; y += (uint32_t)lines) {
        exr_chunk_info_t chunk;
        wrong = answer(file, exr_read_scanline_chunk_info(file->context, 0, file->window.min.y + (int)y, &chunk));
        if (wrong == NULL) {
            wrong = take_chunk(file, &chunk, 0, y, file->width, least((uint32_t)lines, file->height - y));
        }
    }
    return wrong;
}

static bool is_tile_side(int32_t side, uint32_t picture_side)
{
    return side >= (int32_t)least(TILE_SIDE_LEAST, picture_side) && side <= TILE_SIDE_MOST;
}

static const char *read_tiles(exr_file *file)
{
    int32_t wide = 0, high = 0;
    const char *wrong = answer(file, exr_get_tile_sizes(file->context, 0, 0, 0, &wide, &high));
    if (wrong == NULL && !(is_tile_side(wide, file->width) && is_tile_side(high, file->height))) {
        return "sides of tiles are not from 8 to 1024 pixels";
    }
    for (uint32_t y = 0; y < file->height && wrong == NULL; y += (uint32_t)high) {
        for (uint32_t x = 0; x < file->width && wrong == NULL; x += (uint32_t)wide) {
            exr_chunk_info_t chunk;
            wrong =
                answer(file, exr_read_tile_chunk_info(file->context, 0, (int)x / wide, (int)y / high, 0, 0, &chunk));
            if (wrong == NULL) {
                wrong = take_chunk(file, &chunk, x, y, least((uint32_t)wide, file->width - x),
                                   least((uint32_t)high, file->height - y));
            }
        }
    }
    return wrong;
}

static const char *read_samples(exr_file *file)
{
    file->samples = calloc((size_t)file->width * file->height, sizeof *file->samples);
    if (file->samples == NULL) {
        return "out of memory";
    }
    return file->storage == EXR_STORAGE_TILED ? read_tiles(file) : read_lines(file);
}

/* ---- files ---- */

/* Parses a file; out NULL: only the header. */
static int parse(exr_file *file, picture *out, char *error, size_t error_bytes)
{
    const char *wrong = read_header(file);
    wrong = wrong == NULL && out != NULL ? read_samples(file) : wrong;
    int status = 0;
    if (wrong != NULL) {
        status = t3r_reason(error, error_bytes, "OpenEXR: %s", wrong);
    } else if (file->has_length && !file->is_any) {
        status = t3r_reason(error, error_bytes, "OpenEXR: no length in it is from 1 to 65535 steps of %g", file->unit);
    } else if (out != NULL) {
        *out = (picture){
            .width = file->width, .height = file->height, .channels = 1, .bits = 16, .samples = file->samples};
        file->samples = NULL;
    }
    free(file->samples);
    if (file->context != NULL) {
        (void)exr_finish(&file->context);
    }
    return status;
}

int exr_depth_parse(const uint8_t *bytes, size_t count, double unit, picture *out, char *error, size_t error_bytes)
{
    exr_file file = {.bytes = bytes, .count = count, .unit = unit};
    return parse(&file, out, error, error_bytes);
}

static int read_file(const char *path, exr_file *file, picture *out, char *error, size_t error_bytes)
{
    const size_t most = (size_t)T3R_MAX_SIDE * T3R_MAX_SIDE * sizeof(float) + FILE_BYTES_BESIDE;
    char reason[REASON_BYTES];
    uint8_t *bytes = t3r_file_bytes(path, most, &file->count, error, error_bytes);
    if (bytes == NULL) {
        return -1;
    }
    file->bytes = bytes;
    const int status = parse(file, out, reason, sizeof reason);
    free(bytes);
    return status == 0 ? 0 : t3r_reason(error, error_bytes, "%s: %s", path, reason);
}

int exr_depth_read(const char *path, double unit, picture *out, char *error, size_t error_bytes)
{
    exr_file file = {.unit = unit};
    return read_file(path, &file, out, error, error_bytes);
}

int exr_depth_size(const char *path, uint32_t *width, uint32_t *height, char *error, size_t error_bytes)
{
    exr_file file = {.unit = 1};
    const int status = read_file(path, &file, NULL, error, error_bytes);
    *width = file.width;
    *height = file.height;
    return status;
}

#else

const char *exr_depth_missing(void)
{
    return "this build does not read OpenEXR: install it (Debian: libopenexr-dev) and build again";
}

int exr_depth_read(const char *path, double unit, picture *out, char *error, size_t error_bytes)
{
    (void)unit;
    (void)out;
    return t3r_reason(error, error_bytes, "%s: %s", path, exr_depth_missing());
}

int exr_depth_parse(const uint8_t *bytes, size_t count, double unit, picture *out, char *error, size_t error_bytes)
{
    (void)bytes;
    (void)count;
    (void)unit;
    (void)out;
    return t3r_reason(error, error_bytes, "%s", exr_depth_missing());
}

int exr_depth_size(const char *path, uint32_t *width, uint32_t *height, char *error, size_t error_bytes)
{
    *width = *height = 0;
    return t3r_reason(error, error_bytes, "%s: %s", path, exr_depth_missing());
}

#endif
