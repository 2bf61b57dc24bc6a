/* SPDX-License-Identifier: Apache-2.0 */
/* The checks of calls that convert a row of pixels. */
#ifndef T3R_ROW_CHECKS_H
#define T3R_ROW_CHECKS_H

#include "core/fault.h"

T3R_CHECKS t3r_row_checks(const void *from, const void *to, const char *no_row, uint32_t width, uint32_t least,
                          t3r_fault *fault)
{
    T3R_MISUSE(fault, from != NULL && to != NULL, T3R_ERR_ARGUMENT, no_row);
    T3R_CHECK(fault, width >= least, T3R_ERR_ARGUMENT, "width is @: a row has at least # pixels", width, least);
    return T3R_OK;
}

T3R_CHECKS t3r_packed_checks(t3r_packing packing, const void *from, const void *to, uint32_t width, t3r_fault *fault)
{
    T3R_CHECK(fault, packing < T3R_PACKING_COUNT, T3R_ERR_ARGUMENT, "packing is @: a t3r_packing is 0..#", packing,
              T3R_PACKING_COUNT - 1);
    return t3r_row_checks(from, to, "packed or rgb is NULL", width, 1, fault);
}

T3R_CHECKS t3r_demosaic_checks(t3r_bayer order, const uint8_t *above, const uint8_t *row, const uint8_t *below,
                               uint32_t width, const uint8_t *rgb, t3r_fault *fault)
{
    T3R_CHECK(fault, order < T3R_BAYER_COUNT, T3R_ERR_ARGUMENT, "order is @: a t3r_bayer is 0..#", order,
              T3R_BAYER_COUNT - 1);
    T3R_MISUSE(fault, above != NULL && below != NULL, T3R_ERR_ARGUMENT,
               "above or below is NULL: beyond the first and the last row of a picture lies its second and its last "
               "but one");
    return t3r_row_checks(row, rgb, "row or rgb is NULL", width, 2, fault);
}

T3R_CHECKS t3r_composite_checks(const uint8_t *rgb, const uint16_t *alpha_q15, uint32_t width,
                                const uint8_t background[3], t3r_fault *fault)
{
    T3R_MISUSE(fault, alpha_q15 != NULL, T3R_ERR_ARGUMENT,
               "alpha_q15 is NULL: t3r_target.alpha_q15 makes t3r_render() write it");
    T3R_MISUSE(fault, background != NULL, T3R_ERR_ARGUMENT, "background is NULL: it is r g b");
    return t3r_row_checks(rgb, rgb, "rgb is NULL: it is the row of a view, drawn by t3r_render()", width, 1, fault);
}

#endif
