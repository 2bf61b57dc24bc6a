/* SPDX-License-Identifier: Apache-2.0 */
/* Settings of methods that fine-tune. All zero: each method's own. */
#ifndef TRIM3R_TOOLS_FINETUNE_OPTIONS_H
#define TRIM3R_TOOLS_FINETUNE_OPTIONS_H

#include <stdbool.h>
#include <stdint.h>

typedef struct finetune_options {
    uint32_t iterations;  /* in all rounds together */
    uint32_t rounds;      /* of pruning, each followed by its part of the iterations */
    bool pruned_widths;   /* the Gaussians start as wide as in the unpruned scene, not as far as their neighbours */
    bool published_rates; /* the rates of 3D Gaussian Splatting, not those tuned for few iterations */
} finetune_options;

#endif
