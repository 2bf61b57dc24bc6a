/* SPDX-License-Identifier: Apache-2.0 */
#include "pictures/exif.h"

#include <stdbool.h>
#include <string.h>

enum { HEADER_BYTES = 8, ENTRY_BYTES = 12, TAG_ORIENTATION = 0x112, TYPE_SHORT = 3, MOST = 8 };

static uint32_t load(const uint8_t *at, uint32_t bytes, bool big)
{
    uint32_t value = 0;
    for (uint32_t i = 0; i < bytes; i++) {
        value = value << 8 | at[big ? i : bytes - 1 - i];
    }
    return value;
}

uint32_t exif_orientation(const uint8_t *tiff, size_t count)
{
    const bool big = count >= HEADER_BYTES && memcmp(tiff, "MM\0*", 4) == 0;
    if (!big && (count < HEADER_BYTES || memcmp(tiff, "II*\0", 4) != 0)) {
        return EXIF_UPRIGHT;
    }
    const size_t directory = load(tiff + 4, 4, big);
    if (directory > count || count - directory < 2) {
        return EXIF_UPRIGHT;
    }
    const size_t entries = load(tiff + directory, 2, big), whole = (count - directory - 2) / ENTRY_BYTES;
    for (size_t i = 0; i < entries && i < whole; i++) {
        const uint8_t *entry = tiff + directory + 2 + i * ENTRY_BYTES;
        const uint32_t value = load(entry + 8, 2, big);
        if (load(entry, 2, big) == TAG_ORIENTATION && load(entry + 2, 2, big) == TYPE_SHORT) {
            return value >= EXIF_UPRIGHT && value <= MOST ? value : EXIF_UPRIGHT;
        }
    }
    return EXIF_UPRIGHT;
}
