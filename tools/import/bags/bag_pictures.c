#include "import/bags/bag_pictures.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

#include "host/little_floats.h"
#include "host/reason.h"

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
    *out = (t3r_decoded_image){p->width, p->height, T3R_PIXEL_GREY, p->samples};
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
    if (picture_parse(bytes, count, p, error, error_bytes) != 0) {
        return -1;
    }
    if (p->bits != 8) {
        return t3r_reason(error, error_bytes, "the colour image has 16 bits a sample");
    }
    *out = (t3r_decoded_image){p->width, p->height, p->channels == 3 ? T3R_PIXEL_RGB24 : T3R_PIXEL_GREY, p->samples};
    return 0;
}

t3r_image_decoder bag_pictures_decoder(bag_pictures *pictures)
{
    return (t3r_image_decoder){decode, pictures};
}

void bag_pictures_free(bag_pictures *pictures)
{
    picture_free(&pictures->colour);
    picture_free(&pictures->depth);
}
