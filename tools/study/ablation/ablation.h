/* SPDX-License-Identifier: Apache-2.0 */
/* What each part of the method is worth: the settings with one of them taken away or changed, as in GaussianTrim3R's
 * Tables 3 to 8. */
#ifndef TRIM3R_TOOLS_ABLATION_H
#define TRIM3R_TOOLS_ABLATION_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

#include "evaluation/evaluation.h"
#include "reconstruction/reconstruction.h"

#define ABLATIONS_MOST 32u

/* "full", "no-adaptation", "k-5", ...; NULL past the last, of which there are at most ABLATIONS_MOST. The first is
 * the settings as they are. */
const char *ablation_name(uint32_t ablation);

/* Whether it changes anything for this head, and for a recording or for a single image on a plane. */
bool ablation_applies(uint32_t ablation, const chosen_head *head, bool planar);

/* Changes the settings, and nothing else of them. */
void ablation_apply(uint32_t ablation, reconstruction_options *settings);

/* A Markdown table of the means of an evaluation: a line for each scene and ablation, a column for each budget, cells
 * "PSNR / SSIM". Several scenes end in lines of their means, every scene counting once. False without memory. */
bool ablation_table(FILE *out, const evaluation_row *means, uint32_t count, bool planar);

#endif
