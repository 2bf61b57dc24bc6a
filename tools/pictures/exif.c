/* SPDX-License-Identifier: Apache-2.0 */
#include "pictures/exif.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

enum { HEADER_BYTES = 8, ENTRY_BYTES = 12, TYPE_SHORT = 3, TYPE_LONG = 4, TYPE_RATIONAL = 5, RATIONAL_BYTES = 8 };
enum { TAG_ORIENTATION = 0x112, TAG_EXIF = 0x8769, TAG_FOCAL = 0x920a, TAG_WIDTH = 0xa002, TAG_HEIGHT = 0xa003 };
enum { TAG_PIXELS_PER_UNIT = 0xa20e, TAG_UNIT = 0xa210, TAG_FOCAL_35MM = 0xa405 };
enum { MOST = 8, INCH = 2 };

#define FOCAL_LEAST 5.0 /* mm in terms of 35 mm film; others are misstated */
#define FOCAL_MOST 3000.0

static const double unit_mm[] = {[INCH] = 25.4, [3] = 10, [4] = 1, [5] = 0.001};

typedef struct tiff_block {
    const uint8_t *bytes;
    size_t count;
    bool big;
} tiff_block;

static uint32_t load(const tiff_block *block, size_t from, uint32_t bytes)
{
    const uint8_t *at = block->bytes + from;
    uint32_t value = 0;
    for (uint32_t i = 0; i < bytes; i++) {
        value = value << 8 | at[block->big ? i : bytes - 1 - i];
    }
    return value;
}

/* Returns where the value of a directory's entry begins; 0 if it is not there, or of another type. */
static size_t value_of(const tiff_block *block, size_t directory, uint32_t tag, uint32_t type)
{
    if (directory > block->count || block->count - directory < 2) {
        return 0;
    }
    const size_t entries = load(block, directory, 2), whole = (block->count - directory - 2) / ENTRY_BYTES;
    for (size_t i = 0; i < entries && i < whole; i++) {
        const size_t entry = directory + 2 + i * ENTRY_BYTES;
        if (load(block, entry, 2) == tag && load(block, entry + 2, 2) == type) {
            return entry + 8;
        }
    }
    return 0;
}

/* Returns a number of a directory; 0 if it is not there, or of another type. */
static uint32_t number_of(const tiff_block *block, size_t directory, uint32_t tag, uint32_t type)
{
    const size_t value = value_of(block, directory, tag, type);
    return value != 0 ? load(block, value, type == TYPE_LONG ? 4 : 2) : 0;
}

/* Returns a side in pixels, which may be of either type; 0 if it is not there. */
static uint32_t side_of(const tiff_block *block, size_t directory, uint32_t tag)
{
    const uint32_t side = number_of(block, directory, tag, TYPE_LONG);
    return side != 0 ? side : number_of(block, directory, tag, TYPE_SHORT);
}

/* Returns a ratio of a directory; 0 if it is not there, or not a number. */
static double ratio_of(const tiff_block *block, size_t directory, uint32_t tag)
{
    const size_t value = value_of(block, directory, tag, TYPE_RATIONAL);
    const size_t at = value != 0 ? load(block, value, 4) : block->count;
    if (at > block->count || block->count - at < RATIONAL_BYTES) {
        return 0;
    }
    const uint32_t divisor = load(block, at + 4, 4);
    return divisor != 0 ? load(block, at, 4) / (double)divisor : 0;
}

/* Returns the focal length in terms of 35 mm film, from the focal length in mm and the pixels that a length of the
 * sensor has; 0 if they do not state a plausible one. */
static double focal_by_sensor(const tiff_block *block, size_t directory)
{
    const uint32_t stated = number_of(block, directory, TAG_UNIT, TYPE_SHORT), unit = stated != 0 ? stated : INCH;
    const uint32_t width = side_of(block, directory, TAG_WIDTH), height = side_of(block, directory, TAG_HEIGHT);
    if (unit < INCH || unit >= sizeof unit_mm / sizeof *unit_mm || width == 0 || height == 0) {
        return 0;
    }
    const double pixels_per_mm = ratio_of(block, directory, TAG_PIXELS_PER_UNIT) / unit_mm[unit];
    const double focal = ratio_of(block, directory, TAG_FOCAL) * pixels_per_mm * hypot(36, 24) / hypot(width, height);
    return focal >= FOCAL_LEAST && focal <= FOCAL_MOST ? focal : 0;
}

exif_facts exif_read(const uint8_t *tiff, size_t count)
{
    exif_facts facts = {.orientation = EXIF_UPRIGHT};
    const tiff_block block = {tiff, count, count >= HEADER_BYTES && memcmp(tiff, "MM\0*", 4) == 0};
    if (!block.big && (count < HEADER_BYTES || memcmp(tiff, "II*\0", 4) != 0)) {
        return facts;
    }
    const size_t first = load(&block, 4, 4);
    const uint32_t orientation = number_of(&block, first, TAG_ORIENTATION, TYPE_SHORT);
    facts.orientation = orientation >= EXIF_UPRIGHT && orientation <= MOST ? orientation : EXIF_UPRIGHT;
    const size_t second = number_of(&block, first, TAG_EXIF, TYPE_LONG);
    if (second != 0) {
        const uint32_t stated = number_of(&block, second, TAG_FOCAL_35MM, TYPE_SHORT);
        facts.focal_35mm = stated != 0 ? stated : focal_by_sensor(&block, second);
    }
    return facts;
}

double exif_focal_pixels(double focal_35mm, uint32_t width, uint32_t height)
{
    return focal_35mm * hypot(width, height) / hypot(36, 24);
}
