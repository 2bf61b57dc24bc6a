/* SPDX-License-Identifier: Apache-2.0 */
/* Plain C's loops over rows, compiled again: the compiler vectorizes them well. A file compiled for an instruction set
 * includes this and names them: ROW(name). */
#ifndef T3R_KERNELS_LANES_ROWS_H
#define T3R_KERNELS_LANES_ROWS_H

#define t3r_packed_row_c ROW(packed_row)
#define t3r_nv12_row_c ROW(nv12_row)
#define t3r_triple_row_c ROW(triple_row)
#define t3r_box_sums_c ROW(box_sums)
#define t3r_weigh_row_c ROW(weigh_row)
#define t3r_divide_row_c ROW(divide_row)
#include "kernels/plain/image_rows.c"

#define t3r_sample_potential_c ROW(sample_potential)
#define t3r_sample_approach_c ROW(sample_approach)
#include "kernels/plain/seed.c"

#define t3r_luma_row_c ROW(luma_row)
#define t3r_split_row_c ROW(split_row)
#define t3r_db2_predict_c ROW(db2_predict)
#define t3r_db2_lift_c ROW(db2_lift)
#define t3r_db2_split_c ROW(db2_split)
#define t3r_db2_join_c ROW(db2_join)
#define t3r_subtract_row_c ROW(subtract_row)
#define t3r_haar_update_c ROW(haar_update)
#define t3r_cdf53_predict_c ROW(cdf53_predict)
#define t3r_cdf53_update_c ROW(cdf53_update)
#define t3r_texture_finest_c ROW(texture_finest)
#define t3r_texture_coarse_c ROW(texture_coarse)
#define t3r_texture_add_c ROW(texture_add)
#define t3r_texture_spread_c ROW(texture_spread)
#include "kernels/plain/wavelet_rows.c"

#endif
