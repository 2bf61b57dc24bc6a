/* SPDX-License-Identifier: Apache-2.0 */
/* Judges what libjpeg only warns of: for truncated or damaged data it fills in grey. Stray bytes before a marker, which
 * some cameras write, are harmless; so is a missing end marker, if all pixels are there. */
#ifndef T3R_PLATFORM_JPEG_DAMAGE_H
#define T3R_PLATFORM_JPEG_DAMAGE_H

#include <stdbool.h>
#include <stdio.h>

#include <jpeglib.h>

#include <jerror.h>

/* For emit_message: whether the picture may still be whole. *ends_early becomes true when the end marker is missing. */
static inline bool t3r_jpeg_is_harmless(j_common_ptr jpeg, int level, bool *ends_early)
{
    const bool end = level < 0 && jpeg->err->msg_code == JWRN_JPEG_EOF;
    *ends_early = *ends_early || end;
    return level >= 0 || end || jpeg->err->msg_code == JWRN_EXTRANEOUS_DATA;
}

/* Whether a picture that ended early has all its pixels, when its last row was read: lost data within a scan of Huffman
 * codes is a warning of its own, so one scan of all components is whole. Of several scans the last ones may be lost. */
static inline bool t3r_jpeg_is_whole(j_decompress_ptr jpeg)
{
    bool whole = !jpeg->arith_code && (!jpeg_has_multiple_scans(jpeg) || jpeg->coef_bits != NULL);
    for (int c = 0; c < jpeg->num_components && whole && jpeg->coef_bits != NULL; c++) {
        for (int i = 0; i < DCTSIZE2 && whole; i++) {
            whole = jpeg->coef_bits[c][i] == 0; /* to the last bit */
        }
    }
    return whole;
}

#endif
