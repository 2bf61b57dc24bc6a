/* SPDX-License-Identifier: Apache-2.0 */
/* Sentences about errors of calls that convert a row of pixels. */
#include "pixels/row_checks.h"
#include "sentence.h"

const char *t3r_unpack_row_error(t3r_status status, t3r_packing packing, const uint8_t *packed, uint32_t width,
                                 const uint8_t *rgb, char *text, size_t text_bytes)
{
    t3r_fault fault;
    return t3r_sentence(status, t3r_packed_checks(packing, packed, rgb, width, &fault), &fault, text, text_bytes);
}

const char *t3r_demosaic_row_error(t3r_status status, t3r_bayer order, uint32_t y, const uint8_t *above,
                                   const uint8_t *row, const uint8_t *below, uint32_t width, const uint8_t *rgb,
                                   char *text, size_t text_bytes)
{
    (void)y;
    t3r_fault fault;
    return t3r_sentence(status, t3r_demosaic_checks(order, above, row, below, width, rgb, &fault), &fault, text,
                        text_bytes);
}

const char *t3r_pack_row_error(t3r_status status, t3r_packing packing, const uint8_t *rgb, const uint16_t *alpha_q15,
                               uint32_t width, const uint8_t *packed, char *text, size_t text_bytes)
{
    (void)alpha_q15;
    t3r_fault fault;
    return t3r_sentence(status, t3r_packed_checks(packing, rgb, packed, width, &fault), &fault, text, text_bytes);
}

const char *t3r_composite_row_error(t3r_status status, const uint8_t *rgb, const uint16_t *alpha_q15, uint32_t width,
                                    const uint8_t background[3], char *text, size_t text_bytes)
{
    t3r_fault fault;
    return t3r_sentence(status, t3r_composite_checks(rgb, alpha_q15, width, background, &fault), &fault, text,
                        text_bytes);
}
