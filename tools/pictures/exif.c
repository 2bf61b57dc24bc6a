/* SPDX-License-Identifier: Apache-2.0 */
#include "pictures/exif.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

enum { HEADER_BYTES = 8, ENTRY_BYTES = 12, TYPE_SHORT = 3, TYPE_LONG = 4, MOST = 8 };
enum { TAG_ORIENTATION = 0x112, TAG_EXIF = 0x8769, TAG_FOCAL_35MM = 0xa405 };

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

/* Returns a number of a directory; 0 where it is not there, or of another type. */
static uint32_t number_of(const tiff_block *block, size_t directory, uint32_t tag, uint32_t type)
{
    if (directory > block->count || block->count - directory < 2) {
        return 0;
    }
    const size_t entries = load(block, directory, 2), whole = (block->count - directory - 2) / ENTRY_BYTES;
    for (size_t i = 0; i < entries && i < whole; i++) {
        const size_t entry = directory + 2 + i * ENTRY_BYTES;
        if (load(block, entry, 2) == tag && load(block, entry + 2, 2) == type) {
            return load(block, entry + 8, type == TYPE_LONG ? 4 : 2);
        }
    }
    return 0;
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
    facts.focal_35mm = second != 0 ? number_of(&block, second, TAG_FOCAL_35MM, TYPE_SHORT) : 0;
    return facts;
}

double exif_focal_pixels(uint32_t focal_35mm, uint32_t width, uint32_t height)
{
    return focal_35mm * hypot(width, height) / hypot(36, 24);
}
