/* SPDX-License-Identifier: Apache-2.0 */
#include "pictures/picture.h"

#include <errno.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <jpeglib.h>
#include <png.h>

#include "capture/jpeg_damage.h"
#include "capture/jpeg_scans.h"
#include "cli/files/whole_file.h"
#include "host/file_bytes.h"
#include "host/reason.h"
#include "pictures/exif.h"
#include "pictures/foreign_file.h"
#include "pictures/heif.h"
#include "trim3r.h"

/* Both libraries report errors by longjmp. Everything that must survive a jump, or be freed after one, is in a struct
 * of the caller's, so that no local variable is read after a jump. */

#define REASON_BYTES 256
#define EXIF_BYTES 65533u /* most bytes of EXIF that are kept of a JPEG: one marker */
#define OPAQUE_FROM 128u  /* least alpha of a valid pixel */

/* Limits of reading a picture. */
typedef struct extent {
    uint32_t most_side;
    bool header_only;
} extent;

static int fail(char *error, size_t error_bytes, const char *path, const char *reason)
{
    return t3r_reason(error, error_bytes, "%s: %s", path, reason);
}

static void *allocate_samples(const picture *p)
{
    return calloc((size_t)p->width * p->height, (size_t)p->channels * (p->bits / 8u));
}

/* ---- PNG ------------------------------------------------------------------------------------------------------- */

typedef struct png_work {
    png_structp png;
    png_infop info;
    FILE *file;
    png_bytep *rows;
    extent want;
    char reason[REASON_BYTES];
} png_work;

static void png_on_error(png_structp png, png_const_charp message)
{
    png_work *work = png_get_error_ptr(png);
    snprintf(work->reason, sizeof work->reason, "PNG: %s", message);
    png_longjmp(png, 1);
}

static void png_on_warning(png_structp png, png_const_charp message)
{
    (void)png;
    (void)message;
}

static int point_rows(png_work *work, const picture *p)
{
    size_t stride = (size_t)p->width * p->channels * (p->bits / 8u);
    work->rows = malloc(p->height * sizeof *work->rows);
    if (work->rows == NULL) {
        snprintf(work->reason, sizeof work->reason, "out of memory");
        return -1;
    }
    for (uint32_t y = 0; y < p->height; y++) {
        work->rows[y] = (png_bytep)p->samples + y * stride;
    }
    return 0;
}

/* Stores what the camera stated. */
static void keep_exif(picture *out, const uint8_t *tiff, size_t count)
{
    const exif_facts facts = exif_read(tiff, count);
    out->orientation = facts.orientation;
    out->focal_35mm = facts.focal_35mm;
}

/* Reads the chunk eXIf. */
static void read_png_exif(png_work *work, picture *out)
{
    png_unknown_chunkp chunks = NULL;
    const bool there = png_get_unknown_chunks(work->png, work->info, &chunks) > 0;
    keep_exif(out, there ? chunks[0].data : NULL, there ? chunks[0].size : 0);
}

/* Moves the last channel, which is alpha, from the samples into a plane; drops it if every pixel is opaque. */
static int split_alpha(picture *p)
{
    uint8_t *samples = p->samples;
    const size_t pixels = (size_t)p->width * p->height;
    const uint32_t colours = p->channels - 1;
    bool opaque = true;
    p->valid = malloc(pixels);
    for (size_t i = 0; i < pixels && p->valid != NULL; i++) {
        p->valid[i] = samples[i * p->channels + colours] >= OPAQUE_FROM;
        opaque = opaque && p->valid[i] != 0;
        memmove(samples + i * colours, samples + i * p->channels, colours);
    }
    p->channels = colours;
    const int status = p->valid != NULL ? 0 : -1;
    if (opaque) {
        free(p->valid);
        p->valid = NULL;
    }
    return status;
}

static bool little_endian(void)
{
    const uint16_t one = 1;
    return *(const uint8_t *)&one == 1;
}

static int png_decode(png_work *work, picture *out)
{
    work->png = png_create_read_struct(PNG_LIBPNG_VER_STRING, work, png_on_error, png_on_warning);
    if (work->png == NULL || setjmp(png_jmpbuf(work->png))) {
        return -1;
    }
    work->info = png_create_info_struct(work->png);
    if (work->info == NULL) {
        png_error(work->png, "out of memory");
    }
    png_init_io(work->png, work->file);
    png_set_user_limits(work->png, work->want.most_side, work->want.most_side);
    /* read only pixels: a text, profile or preview may decompress to megabytes; -1: all such chunks, also those that
     * libpng knows */
    png_set_keep_unknown_chunks(work->png, PNG_HANDLE_CHUNK_NEVER, NULL, -1);
    png_set_keep_unknown_chunks(work->png, PNG_HANDLE_CHUNK_ALWAYS, (png_const_bytep) "eXIf", 1);
    png_read_info(work->png, work->info);
    png_byte colour_type = png_get_color_type(work->png, work->info);
    png_byte depth = png_get_bit_depth(work->png, work->info);
    bool grey = (colour_type & PNG_COLOR_MASK_COLOR) == 0;
    out->width = png_get_image_width(work->png, work->info);
    out->height = png_get_image_height(work->png, work->info);
    out->channels = grey ? 1 : 3;
    out->bits = colour_type == PNG_COLOR_TYPE_GRAY && depth == 16 ? 16 : 8;
    read_png_exif(work, out);
    if (work->want.header_only) {
        return 0;
    }
    if ((uint64_t)out->width * out->height > PICTURE_LARGEST_PIXELS) {
        png_error(work->png, "image exceeds the largest number of pixels");
    }
    if (out->bits == 16) {
        if (little_endian()) {
            png_set_swap(work->png);
        }
    } else {
        png_set_scale_16(work->png);
        png_set_expand(work->png);
    }
    const bool alpha = out->bits == 8 && ((colour_type & PNG_COLOR_MASK_ALPHA) != 0 ||
                                          png_get_valid(work->png, work->info, PNG_INFO_tRNS) != 0);
    out->channels += alpha;
    png_set_interlace_handling(work->png);
    png_read_update_info(work->png, work->info);
    if (png_get_rowbytes(work->png, work->info) != (size_t)out->width * out->channels * (out->bits / 8u)) {
        png_error(work->png, "row size differs from what the header says");
    }
    out->samples = allocate_samples(out);
    if (out->samples == NULL || point_rows(work, out) != 0) {
        png_error(work->png, "out of memory");
    }
    png_read_image(work->png, work->rows);
    png_read_end(work->png, NULL);
    if (alpha && split_alpha(out) != 0) {
        png_error(work->png, "out of memory");
    }
    return 0;
}

static int read_png(FILE *file, const char *path, extent want, picture *out, char *error, size_t error_bytes)
{
    png_work work = {.file = file, .want = want, .reason = "PNG: out of memory"};
    int status = png_decode(&work, out);
    png_destroy_read_struct(&work.png, &work.info, NULL);
    free(work.rows);
    if (status != 0) {
        picture_free(out);
        return fail(error, error_bytes, path, work.reason);
    }
    return 0;
}

static int png_encode(png_work *work, const picture *in)
{
    work->png = png_create_write_struct(PNG_LIBPNG_VER_STRING, work, png_on_error, png_on_warning);
    if (work->png == NULL || setjmp(png_jmpbuf(work->png))) {
        return -1;
    }
    work->info = png_create_info_struct(work->png);
    if (work->info == NULL || point_rows(work, in) != 0) {
        png_error(work->png, "out of memory");
    }
    png_init_io(work->png, work->file);
    png_set_IHDR(work->png, work->info, in->width, in->height, (int)in->bits,
                 in->channels == 3 ? PNG_COLOR_TYPE_RGB : PNG_COLOR_TYPE_GRAY, PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_write_info(work->png, work->info);
    if (in->bits == 16 && little_endian()) {
        png_set_swap(work->png);
    }
    png_write_image(work->png, work->rows);
    png_write_end(work->png, NULL);
    return 0;
}

int picture_write_png(const char *path, const picture *in, char *error, size_t error_bytes)
{
    if (in->samples == NULL || in->width == 0 || in->height == 0 || (in->channels != 1 && in->channels != 3) ||
        (in->bits != 8 && !(in->bits == 16 && in->channels == 1))) {
        return fail(error, error_bytes, path, "only 8-bit RGB, 8-bit grey and 16-bit grey pictures can be written");
    }
    t3r_whole_file file;
    if (whole_file_begin(&file, path, error, error_bytes) != 0) {
        return -1;
    }
    png_work work = {.file = file.stream, .reason = "PNG: out of memory"};
    int status = png_encode(&work, in);
    png_destroy_write_struct(&work.png, &work.info);
    free(work.rows);
    if (status != 0) {
        t3r_whole_file_abandon(&file);
        return fail(error, error_bytes, file.path, work.reason);
    }
    return t3r_whole_file_commit(&file, NULL, error, error_bytes);
}

/* ---- JPEG ------------------------------------------------------------------------------------------------------ */

typedef struct jpeg_work {
    struct jpeg_error_mgr manager; /* first: the library hands back a pointer to it */
    struct jpeg_decompress_struct jpeg;
    t3r_jpeg_scans scans;
    jmp_buf escape;
    extent want;
    bool ends_early; /* the file ends before its end marker */
    char reason[REASON_BYTES];
} jpeg_work;

static void jpeg_fail(jpeg_work *work, const char *reason)
{
    snprintf(work->reason, sizeof work->reason, "JPEG: %s", reason);
    longjmp(work->escape, 1);
}

static void jpeg_on_error(j_common_ptr jpeg)
{
    char message[JMSG_LENGTH_MAX];
    jpeg->err->format_message(jpeg, message);
    jpeg_fail((jpeg_work *)jpeg->err, message);
}

static void jpeg_on_message(j_common_ptr jpeg, int level)
{
    if (!t3r_jpeg_is_harmless(jpeg, level, &((jpeg_work *)jpeg->err)->ends_early)) {
        jpeg_on_error(jpeg);
    }
}

/* Reads the first marker with EXIF. */
static void read_jpeg_exif(const struct jpeg_decompress_struct *jpeg, picture *out)
{
    static const char name[] = "Exif\0";
    const struct jpeg_marker_struct *marker = jpeg->marker_list;
    while (marker != NULL && (marker->data_length <= sizeof name || memcmp(marker->data, name, sizeof name) != 0)) {
        marker = marker->next;
    }
    const bool there = marker != NULL;
    keep_exif(out, there ? marker->data + sizeof name : NULL, there ? marker->data_length - sizeof name : 0);
}

static void jpeg_refuse(j_common_ptr jpeg, const char *reason)
{
    jpeg_fail((jpeg_work *)jpeg->err, reason);
}

static int jpeg_decode(jpeg_work *work, FILE *file, picture *out)
{
    if (setjmp(work->escape)) {
        return -1;
    }
    jpeg_create_decompress(&work->jpeg);
    t3r_jpeg_watch_scans(&work->jpeg, &work->scans, jpeg_refuse);
    jpeg_stdio_src(&work->jpeg, file);
    jpeg_save_markers(&work->jpeg, JPEG_APP0 + 1, EXIF_BYTES);
    jpeg_read_header(&work->jpeg, TRUE);
    if (work->jpeg.image_width > work->want.most_side || work->jpeg.image_height > work->want.most_side ||
        (uint64_t)work->jpeg.image_width * work->jpeg.image_height > PICTURE_LARGEST_PIXELS) {
        jpeg_fail(work, "image exceeds the largest size");
    }
    read_jpeg_exif(&work->jpeg, out);
    if (work->want.header_only) {
        out->width = work->jpeg.image_width;
        out->height = work->jpeg.image_height;
        return 0;
    }
    if (work->jpeg.num_components == 4) {
        jpeg_fail(work, "four inks (CMYK) are not read; convert IN.jpg -colorspace sRGB OUT.jpg makes three colours of "
                        "them");
    }
    bool grey = work->jpeg.jpeg_color_space == JCS_GRAYSCALE;
    work->jpeg.out_color_space = grey ? JCS_GRAYSCALE : JCS_RGB;
    work->jpeg.dct_method = JDCT_ISLOW;
    jpeg_start_decompress(&work->jpeg);
    out->width = work->jpeg.output_width;
    out->height = work->jpeg.output_height;
    out->channels = grey ? 1 : 3;
    out->bits = 8;
    out->samples = allocate_samples(out);
    if (out->samples == NULL) {
        jpeg_fail(work, "out of memory");
    }
    while (work->jpeg.output_scanline < out->height) {
        JSAMPROW row = (JSAMPROW)out->samples + (size_t)work->jpeg.output_scanline * out->width * out->channels;
        jpeg_read_scanlines(&work->jpeg, &row, 1);
    }
    if (work->ends_early && !t3r_jpeg_is_whole(&work->jpeg)) {
        jpeg_fail(work, "the file ends before its last scans");
    }
    jpeg_finish_decompress(&work->jpeg);
    return 0;
}

static int read_jpeg(FILE *file, const char *path, extent want, picture *out, char *error, size_t error_bytes)
{
    jpeg_work work;
    memset(&work, 0, sizeof work);
    work.want = want;
    work.jpeg.err = jpeg_std_error(&work.manager);
    work.manager.error_exit = jpeg_on_error;
    work.manager.emit_message = jpeg_on_message;
    int status = jpeg_decode(&work, file, out);
    jpeg_destroy_decompress(&work.jpeg);
    if (status != 0) {
        picture_free(out);
        return fail(error, error_bytes, path, work.reason);
    }
    return 0;
}

/* ---- HEIC, AVIF ------------------------------------------------------------------------------------------------ */

static int read_heif(FILE *file, const char *path, extent want, picture *out, char *error, size_t error_bytes)
{
    char reason[REASON_BYTES] = "out of memory";
    int status = heif_read(file, want.most_side, want.header_only, out, reason, sizeof reason);
    status = status == 0 && !want.header_only && out->channels == 4 ? split_alpha(out) : status;
    if (status != 0) {
        picture_free(out);
        return fail(error, error_bytes, path, reason);
    }
    return 0;
}

/* ---- any kind -------------------------------------------------------------------------------------------------- */

static int read_stream(FILE *file, const char *path, extent want, picture *out, char *error, size_t error_bytes)
{
    static const uint8_t png_magic[8] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
    static const uint8_t jpeg_magic[3] = {0xff, 0xd8, 0xff};
    uint8_t magic[FOREIGN_FILE_BYTES] = {0};
    size_t got = fread(magic, 1, sizeof magic, file);
    if (ferror(file)) {
        return fail(error, error_bytes, path, strerror(errno));
    }
    if (got == 0) {
        return fail(error, error_bytes, path, "the file is empty");
    }
    if (fseek(file, 0, SEEK_SET) != 0) {
        return fail(error, error_bytes, path, "not a seekable file");
    }
    if (memcmp(magic, png_magic, sizeof png_magic) == 0) {
        return read_png(file, path, want, out, error, error_bytes);
    }
    if (memcmp(magic, jpeg_magic, sizeof jpeg_magic) == 0) {
        return read_jpeg(file, path, want, out, error, error_bytes);
    }
    if (heif_is(magic, got)) {
        return read_heif(file, path, want, out, error, error_bytes);
    }
    const char *foreign = foreign_file_of_bytes(magic, got);
    return fail(error, error_bytes, path, foreign != NULL ? foreign : "neither PNG nor JPEG");
}

static int read_any(const char *path, extent want, picture *out, char *error, size_t error_bytes)
{
    memset(out, 0, sizeof *out);
    FILE *file = t3r_file_open(path, error, error_bytes);
    if (file == NULL) {
        return -1;
    }
    int status = read_stream(file, path, want, out, error, error_bytes);
    fclose(file);
    return status;
}

static int parse_any(const uint8_t *bytes, size_t count, extent want, picture *out, char *error, size_t error_bytes)
{
    memset(out, 0, sizeof *out);
    FILE *file = count > 0 ? fmemopen((void *)(uintptr_t)bytes, count, "rb") : NULL; /* only read */
    if (file == NULL) {
        return t3r_reason(error, error_bytes, count > 0 ? "out of memory" : "the picture is empty");
    }
    int status = read_stream(file, "picture", want, out, error, error_bytes);
    fclose(file);
    return status;
}

int picture_parse(const uint8_t *bytes, size_t count, picture *out, char *error, size_t error_bytes)
{
    return parse_any(bytes, count, (extent){.most_side = T3R_MAX_SIDE}, out, error, error_bytes);
}

int picture_parse_large(const uint8_t *bytes, size_t count, picture *out, char *error, size_t error_bytes)
{
    return parse_any(bytes, count, (extent){.most_side = PICTURE_LARGEST_SIDE}, out, error, error_bytes);
}

int picture_read(const char *path, picture *out, char *error, size_t error_bytes)
{
    return read_any(path, (extent){.most_side = T3R_MAX_SIDE}, out, error, error_bytes);
}

int picture_read_large(const char *path, picture *out, char *error, size_t error_bytes)
{
    return read_any(path, (extent){.most_side = PICTURE_LARGEST_SIDE}, out, error, error_bytes);
}

int picture_header(const char *path, picture *out, char *error, size_t error_bytes)
{
    return read_any(path, (extent){PICTURE_LARGEST_SIDE, true}, out, error, error_bytes);
}

int picture_size(const char *path, uint32_t *width, uint32_t *height, char *error, size_t error_bytes)
{
    picture header;
    int status = picture_header(path, &header, error, error_bytes);
    *width = header.width;
    *height = header.height;
    return status;
}

void picture_free(picture *p)
{
    free(p->samples);
    free(p->valid);
    memset(p, 0, sizeof *p);
}
