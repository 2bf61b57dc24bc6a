/* SPDX-License-Identifier: Apache-2.0 */
/* The table of the runtime's hot loops, one entry each. The header of each kernel states its ranges, alignment and
 * padding.
 *
 * Plain C defines every entry (kernels_c.c). A variant for an instruction set gives the same bits for all inputs that
 * the kernel's header allows, and reads and writes no byte beyond what that header states. t3r_kernels_choose() fills a
 * table with plain C and replaces entries by the variants that the processor supports. To add a variant, put its file
 * in the folder of the architecture and a row in that folder's variants.h. tests/kernels then compares it with plain C.
 */
#ifndef T3R_KERNELS_H
#define T3R_KERNELS_H

#include <stdint.h>

#include "blend.h"
#include "blur.h"
#include "census.h"
#include "convolve.h"
#include "disparity_at.h"
#include "hash_bytes.h"
#include "image_rows.h"
#include "keys.h"
#include "luma_at.h"
#include "nearest.h"
#include "path_row.h"
#include "place.h"
#include "points.h"
#include "project.h"
#include "radix.h"
#include "ray_row.h"
#include "scatter.h"
#include "seed.h"
#include "solve.h"
#include "wavelet_rows.h"
#include "winner_row.h"

typedef struct t3r_kernels {
    /* image */
    t3r_packed_row_kernel *packed_row;
    t3r_nv12_row_kernel *nv12_row;
    t3r_triple_row_kernel *triple_row;
    t3r_box_sums_kernel *box_sums;
    t3r_weigh_row_kernel *weigh_row;
    t3r_divide_row_kernel *divide_row;
    /* pointmap */
    t3r_unproject_kernel *unproject;
    t3r_locate_kernel *locate;
    /* stereo */
    t3r_ray_row_kernel *ray_row;
    t3r_luma_at_kernel *luma_at;
    t3r_census_row_kernel *census_row;
    t3r_census_costs_kernel *census_costs;
    t3r_path_row_kernel *path_row;
    t3r_winner_row_kernel *winner_row;
    t3r_disparity_at_kernel *disparity_at;
    /* wavelet */
    t3r_luma_row_kernel *luma_row;
    t3r_split_row_kernel *split_row;
    t3r_db2_predict_kernel *db2_predict;
    t3r_db2_lift_kernel *db2_lift;
    t3r_db2_split_kernel *db2_split;
    t3r_db2_join_kernel *db2_join;
    t3r_subtract_row_kernel *subtract_row;
    t3r_haar_update_kernel *haar_update;
    t3r_cdf53_predict_kernel *cdf53_predict;
    t3r_cdf53_update_kernel *cdf53_update;
    t3r_texture_finest_kernel *texture_finest;
    t3r_texture_coarse_kernel *texture_coarse;
    t3r_texture_add_kernel *texture_add;
    t3r_texture_spread_kernel *texture_spread;
    /* superclusters and budget */
    t3r_sample_potential_kernel *sample_potential;
    t3r_sample_approach_kernel *sample_approach;
    t3r_nearest_begin_kernel *nearest_begin; /* with nearest: a variant replaces both */
    t3r_nearest_kernel *nearest;
    t3r_blur_row_kernel *blur_row;
    t3r_blur_column_kernel *blur_column;
    t3r_wanted_row_kernel *wanted_row;
    t3r_key_row_kernel *key_row;
    /* head */
    t3r_convolve_kernel *convolve;
    t3r_depthwise_kernel *depthwise;
    t3r_pack_layer_kernel *pack_layer; /* with convolve_packed: NULL in plain C, which uses unpacked layers */
    t3r_convolve_packed_kernel *convolve_packed;
    /* raster and refine */
    t3r_project_kernel *project;
    t3r_radix_count_kernel *radix_count;
    t3r_radix_pass_kernel *radix_pass;
    t3r_place_kernel *place;
    t3r_blend_kernel *blend;
    t3r_blend_keep_kernel *blend_keep;
    t3r_axes_kernel *axes;
    t3r_compare_row_kernel *compare_row;
    t3r_scatter_kernel *scatter;
    t3r_solve_kernel *solve;
    /* the hash of each stage */
    t3r_hash_bytes_kernel *hash_bytes;

    /* Bytes of an activation in convolve_packed's strips: 2 = int16, 1 = a byte of activation + 128. */
    uint32_t strip_bytes;
    /* T3R_CPU_... features that the table was filled for. */
    uint32_t features;
} t3r_kernels;

/* Plain C: the definition of all entries except packed layers. */
extern const t3r_kernels t3r_kernels_c;

/* Fills the table for a processor with these features, T3R_CPU_...; 0: plain C. */
void t3r_kernels_choose(t3r_kernels *table, uint32_t cpu);

/* Returns the T3R_CPU_... features that the processor can have. On x86-64 these are the features that the processor and
 * its operating system have; elsewhere those of the architecture, or of the core that a firmware is compiled for. */
uint32_t t3r_kernels_features(void);

#endif
