/* SPDX-License-Identifier: Apache-2.0 */
#include "import/bags/bag_pictures.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "core/little_endian.h"
#include "host/little_floats.h"
#include "host/reason.h"
#include "import/bags/bag_size.h"
#include "import/bags/bag_straight.h"
#include "import/frames/crop.h"
#include "import/poses/lens.h"
#include "messages/pixel_layout.h"
#include "messages/ros_messages.h"
#include "pictures/exif.h"
#include "pictures/picture_shape.h"

/* Precedes the picture of compressedDepth: how it was made, and two floats a and b. */
#define DEPTH_HEADER_BYTES 12u

static bool begins_with(t3r_text text, const char *word)
{
    return text.count >= strlen(word) && memcmp(text.chars, word, strlen(word)) == 0;
}

/* Metres are a / (sample - b), as depth_image_transport quantizes them; 0 means no measurement. */
static void metres_to_steps(picture *p, double a, double b, uint64_t unit_q40)
{
    uint16_t *samples = p->samples;
    for (size_t i = 0; i < (size_t)p->width * p->height; i++) {
        double steps = samples[i] == 0 ? 0 : nearbyint(ldexp(a / (samples[i] - b), 40) / (double)unit_q40);
        samples[i] = (uint16_t)(steps >= 1 && steps <= UINT16_MAX ? steps : 0); /* false for NaN */
    }
}

/* Converts the samples to little-endian bytes in place. */
static void to_bytes(picture *p)
{
    uint16_t *samples = p->samples;
    for (size_t i = 0; i < (size_t)p->width * p->height; i++) {
        uint16_t sample = samples[i];
        t3r_store_le16((uint8_t *)&samples[i], sample);
    }
}

static int decode_depth(bag_pictures *pictures, t3r_text format, const uint8_t *bytes, size_t count, uint64_t unit_q40,
                        t3r_decoded_image *out, char *error, size_t error_bytes)
{
    picture *p = &pictures->depth;
    bool png = count >= 4 && memcmp(bytes, "\x89PNG", 4) == 0;
    size_t before = png ? 0 : DEPTH_HEADER_BYTES;
    if (count < before) {
        return t3r_reason(error, error_bytes, "the depth image is cut short");
    }
    if (picture_parse(bytes + before, count - before, p, error, error_bytes) != 0) {
        return -1;
    }
    if (p->bits != 16 || p->channels != 1) {
        return t3r_reason(error, error_bytes, "the depth image is no 16-bit grey picture");
    }
    if (!png && begins_with(format, "32FC1")) {
        metres_to_steps(p, (double)t3r_load_float(bytes + 4), (double)t3r_load_float(bytes + 8), unit_q40);
    }
    to_bytes(p);
    *out = (t3r_decoded_image){.width = p->width, .height = p->height, .format = T3R_PIXEL_GREY, .rows = p->samples};
    return 0;
}

/* Fills in *out from the colour picture, reduced to sides of at most T3R_MAX_SIDE. */
static int finish_colour(bag_pictures *pictures, t3r_decoded_image *out, char *error, size_t error_bytes)
{
    picture *p = &pictures->colour;
    const uint32_t n = picture_reduction(p->width, p->height);
    pictures->whole_width = p->width;
    pictures->whole_height = p->height;
    if (n > 1 && !pictures->large) {
        return t3r_reason(error, error_bytes,
                          "%ux%u pixels; sides of up to %u are supported, larger ones with --size of trim3r import",
                          p->width, p->height, T3R_MAX_SIDE);
    }
    if (n > 1) {
        picture_reduce(p, n);
    }
    *out = (t3r_decoded_image){.width = p->width,
                               .height = p->height,
                               .whole_width = pictures->whole_width,
                               .whole_height = pictures->whole_height,
                               .reduction = n,
                               .format = p->channels == 3 ? T3R_PIXEL_RGB24 : T3R_PIXEL_GREY,
                               .rows = p->samples};
    return 0;
}

static int decode(void *user, t3r_text format, const uint8_t *bytes, size_t count, bool depth, uint64_t unit_q40,
                  t3r_decoded_image *out, char *error, size_t error_bytes)
{
    bag_pictures *pictures = user;
    picture *p = depth ? &pictures->depth : &pictures->colour;
    picture_free(p);
    if (depth) {
        return decode_depth(pictures, format, bytes, count, unit_q40, out, error, error_bytes);
    }
    if (picture_parse_large(bytes, count, p, error, error_bytes) != 0) {
        return -1;
    }
    if (p->bits != 8) {
        return t3r_reason(error, error_bytes, "the colour image has 16 bits a sample");
    }
    if (p->orientation > EXIF_UPRIGHT && p->orientation < EXIF_SWAPS_FROM) {
        return t3r_reason(error, error_bytes,
                          "EXIF turns the image (orientation %u), and nothing says whether its camera_info is of the "
                          "turned one",
                          p->orientation);
    }
    if (!picture_blacken(p)) {
        return t3r_reason(error, error_bytes, "all pixels are transparent");
    }
    return finish_colour(pictures, out, error, error_bytes);
}

/* ---- encodings that are no pixel formats ---- */

#define HALF_OPAQUE 128

/* Returns the Bayer order of an encoding's last four letters: "rggb". */
static t3r_bayer bayer_of(const char *letters)
{
    static const char names[T3R_BAYER_COUNT][5] = {
        [T3R_BAYER_RGGB] = "rggb", [T3R_BAYER_GRBG] = "grbg", [T3R_BAYER_GBRG] = "gbrg", [T3R_BAYER_BGGR] = "bggr"};
    t3r_bayer order = T3R_BAYER_COUNT - 1;
    while (order > 0 && memcmp(letters, names[order], 4) != 0) {
        order--;
    }
    return order;
}

static void demosaic(const t3r_ros_image *image, t3r_bayer order, uint8_t *out)
{
    for (uint32_t y = 0; y < image->height; y++, out += (size_t)image->width * 3) {
        const uint8_t *row = image->data + (size_t)y * image->step;
        const uint8_t *above = y == 0 ? row + image->step : row - image->step;
        const uint8_t *below = y + 1 == image->height ? row - image->step : row + image->step;
        (void)t3r_demosaic_row(order, y, above, row, below, image->width, out);
    }
}

/* Unpacks four channels, and marks pixels of alpha 128 and more in `opaque`. Returns whether there are any. */
static bool unpack(const t3r_ros_image *image, t3r_packing packing, uint8_t *out, uint8_t *opaque)
{
    bool any = false;
    for (uint32_t y = 0; y < image->height; y++, out += (size_t)image->width * 3) {
        const uint8_t *row = image->data + (size_t)y * image->step;
        (void)t3r_unpack_row(packing, row, image->width, out);
        for (uint32_t x = 0; x < image->width; x++) {
            const bool is_opaque = row[4 * (size_t)x + 3] >= HALF_OPAQUE;
            *opaque++ = is_opaque;
            any = any || is_opaque;
        }
    }
    return any;
}

/* Checks the sides of a raw image, and that its data hold `rows` rows of that many bytes a pixel. Returns NULL, or what
 * is wrong. */
static const char *extent_error(const t3r_ros_image *image, uint32_t pixel_bytes, uint32_t rows)
{
    const bool fits = image->width >= IMPORT_LEAST_SIDE && image->height >= IMPORT_LEAST_SIDE &&
                      image->width <= PICTURE_LARGEST_SIDE && image->height <= PICTURE_LARGEST_SIDE &&
                      (uint64_t)image->width * image->height <= PICTURE_LARGEST_PIXELS;
    return !fits ? "width or height is outside 2..4096; with --size of trim3r import, 2..16384"
           : image->step < image->width * pixel_bytes || (uint64_t)image->step * rows > image->data_bytes
               ? "data hold fewer than step x rows bytes"
               : NULL;
}

/* Converts an image of a pixel format that the runtime reads, but larger, to RGB. */
static int take_large(const t3r_ros_image *image, t3r_pixel_format format, picture *out, char *error,
                      size_t error_bytes)
{
    const bool nv12 = format == T3R_PIXEL_NV12, pairs = nv12 || format == T3R_PIXEL_YUYV || format == T3R_PIXEL_UYVY;
    const t3r_frame frame = {.format = format,
                             .width = image->width,
                             .height = image->height,
                             .planes = {image->data, image->data + (nv12 ? (size_t)image->step * image->height : 0)},
                             .stride_bytes = {image->step, image->step}};
    const char *wrong =
        extent_error(image, t3r_pixel_row_bytes(format, 1), image->height + t3r_pixel_rows(format, 1, image->height));
    if (wrong == NULL && ((pairs && image->width % 2 != 0) || (nv12 && image->height % 2 != 0))) {
        wrong = "width or height is odd, which its encoding cannot be";
    }
    wrong = wrong != NULL ? wrong : bag_size_colour(&frame, out);
    return wrong == NULL ? 0 : t3r_reason(error, error_bytes, "%s", wrong);
}

static int convert(void *user, const t3r_ros_image *image, t3r_decoded_image *out, char *error, size_t error_bytes)
{
    bag_pictures *pictures = user;
    picture *p = &pictures->colour;
    t3r_pixel_format format;
    picture_free(p);
    if (t3r_pixel_format_of(image->encoding, &format)) {
        return take_large(image, format, p, error, error_bytes) == 0 ? finish_colour(pictures, out, error, error_bytes)
                                                                     : -1;
    }
    const bool bayer = begins_with(image->encoding, "bayer_");
    const char *wrong = extent_error(image, bayer ? 1 : 4, image->height);
    if (wrong != NULL) {
        return t3r_reason(error, error_bytes, "%s", wrong);
    }
    *p = (picture){.width = image->width, .height = image->height, .channels = 3, .bits = 8};
    p->samples = malloc((size_t)image->width * image->height * 3);
    p->valid = bayer ? NULL : malloc((size_t)image->width * image->height);
    if (p->samples == NULL || (!bayer && p->valid == NULL)) {
        return t3r_reason(error, error_bytes, "out of memory");
    }
    if (bayer) {
        demosaic(image, bayer_of(image->encoding.chars + strlen("bayer_")), p->samples);
    } else if (!unpack(image, t3r_text_is(image->encoding, "rgba8") ? T3R_PACKED_RGBA : T3R_PACKED_BGRA, p->samples,
                       p->valid)) {
        free(p->valid); /* drivers leave the fourth channel at 0 */
        p->valid = NULL;
    }
    (void)picture_blacken(p);
    return finish_colour(pictures, out, error, error_bytes);
}

static int redraw(void *user, const t3r_ros_camera_info *info, t3r_frame *frame, bool depth, char *error,
                  size_t error_bytes)
{
    bag_pictures *pictures = user;
    lens bent;
    const char *wrong = lens_of_info(info, &bent);
    if (wrong != NULL) {
        return t3r_reason(error, error_bytes, "%s", wrong);
    }
    lens_reduce(&bent, picture_reduction(info->width, info->height));
    if (bag_straighten_colour(&bent, frame, pictures->colour.valid, &pictures->straight_colour, error, error_bytes) !=
        0) {
        return -1;
    }
    return depth ? bag_straighten_depth(&bent, frame, &pictures->straight_depth, error, error_bytes) : 0;
}

int bag_pictures_hide(bag_pictures *pictures, t3r_frame *frame, bool straightened)
{
    const picture *colour = straightened ? &pictures->straight_colour : &pictures->colour;
    picture *p = &pictures->hidden;
    if (colour->valid == NULL || frame->depth == NULL) {
        return 0;
    }
    picture_free(p);
    *p = (picture){.width = frame->depth_width, .height = frame->depth_height, .channels = 1, .bits = 16};
    p->samples = malloc((size_t)p->width * p->height * 2);
    uint8_t *out = p->samples;
    for (uint32_t i = 0; out != NULL && i < p->width * p->height; i++, out += 2) {
        const uint32_t x = i % p->width, y = i / p->width;
        const uint8_t *sample = frame->depth + (size_t)y * frame->depth_stride_bytes + (size_t)x * 2;
        t3r_store_le16(out, picture_valid_at(colour, x, y, p) ? t3r_load_le16(sample) : 0);
    }
    frame->depth = p->samples;
    frame->depth_stride_bytes = p->width * 2;
    return frame->depth != NULL ? 0 : -1;
}

t3r_image_decoder bag_pictures_decoder(bag_pictures *pictures)
{
    return (t3r_image_decoder){decode, convert, redraw, pictures};
}

void bag_pictures_free(bag_pictures *pictures)
{
    picture_free(&pictures->colour);
    picture_free(&pictures->depth);
    picture_free(&pictures->straight_colour);
    picture_free(&pictures->straight_depth);
    picture_free(&pictures->hidden);
}
