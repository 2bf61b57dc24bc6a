/* SPDX-License-Identifier: Apache-2.0 */
/* Orientation of a camera when it took a picture. */
#ifndef TRIM3R_TOOLS_EXIF_H
#define TRIM3R_TOOLS_EXIF_H

#include <stddef.h>
#include <stdint.h>

#define EXIF_UPRIGHT 1u
#define EXIF_SWAPS_FROM 5u /* from this orientation on, turning swaps the sides */

/* Returns the orientation, 1 to 8, that a block of EXIF (a TIFF header and its first directory) states; EXIF_UPRIGHT if
 * it states none. */
uint32_t exif_orientation(const uint8_t *tiff, size_t count);

#endif
