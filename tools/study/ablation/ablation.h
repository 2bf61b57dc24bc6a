/* SPDX-License-Identifier: Apache-2.0 */
/* Ablations: the settings with one part of the method removed or changed, as in GaussianTrim3R's Tables 3 to 8. */
#ifndef TRIM3R_TOOLS_ABLATION_H
#define TRIM3R_TOOLS_ABLATION_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

#include "evaluation/evaluation.h"
#include "reconstruction/reconstruction.h"

#define ABLATIONS_MOST 32u

/* Returns "full", "no-adaptation", "k-5", ...; NULL after the last, of which there are at most ABLATIONS_MOST. The
 * first is the unchanged settings. */
const char *ablation_name(uint32_t ablation);

/* Whether the ablation changes anything for this head, for a recording or for a single image on a plane. */
bool ablation_applies(uint32_t ablation, const chosen_head *head, bool planar);

/* Applies the ablation to the settings and changes no others. */
void ablation_apply(uint32_t ablation, reconstruction_options *settings);

/* Writes a Markdown table of an evaluation's means: a line for each scene and ablation, a column for each budget,
 * cells "PSNR / SSIM". With several scenes the last lines are means in which every scene counts once. Returns false
 * when memory runs out. */
bool ablation_table(FILE *out, const evaluation_row *means, uint32_t count, bool planar);

#endif
