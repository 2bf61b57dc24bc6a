/* SPDX-License-Identifier: Apache-2.0 */
/* The heads that --head names: analytic, none, the shipped networks, weight files. */
#ifndef TRIM3R_TOOLS_CHOSEN_HEAD_H
#define TRIM3R_TOOLS_CHOSEN_HEAD_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "state/ablation.h"
#include "trim3r.h"

#define CHOSEN_HEAD_DEFAULT "small"
#define CHOSEN_HEAD_VALUES "tiny|small|FILE.t3w|analytic|none" /* all values of --head */

typedef struct chosen_head {
    t3r_head head;
    bool unadapted;      /* for `none`: `analytic`, which then treats every point as retained */
    char name[16];       /* analytic, none, or the name in a network's weights */
    char bits[8];        /* of a network's weights and activations: 8, 16, or W/A if they differ; else "" */
    const void *weights; /* NULL for analytic and none */
    size_t bytes;
    uint32_t weight_bits, activation_bits;
    char crc[9]; /* for a network, 8 hexadecimal digits; else "" */
    void *owned; /* weights read from a file */
} chosen_head;

/* Whether the text is one of the names or ends in .t3w. */
bool chosen_head_is_one(const char *text);

/* Opens a head. Returns CLI_OK, after which chosen_head_close() must be called; or an exit status of cli.h after a
 * message. A weight file is refused with the reason of t3r_weights_error(). */
int chosen_head_open(chosen_head *chosen, const char *text);
void chosen_head_close(chosen_head *chosen);

/* Shows a network a mask in which every pixel was retained (hidden_mask.h); does nothing to analytic and none. Returns
 * CLI_OK, or a status after a message; chosen_head_close() must still be called. */
int chosen_head_hide_mask(chosen_head *chosen);

/* Sets the configuration's head, and its head_column_bytes: a network's need, 0 for analytic and none. */
void chosen_head_configure(const chosen_head *chosen, t3r_config *config);

/* Binds a network's weights after t3r_init(); omits what `ablation` removes, and for `none` the adaptation. */
t3r_status chosen_head_bind(const chosen_head *chosen, t3r_runtime *runtime, t3r_ablation ablation);

#endif
