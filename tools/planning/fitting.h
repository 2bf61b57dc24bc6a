/* SPDX-License-Identifier: Apache-2.0 */
/* The settings that fit an arena and a time: what `plan --arena --time` lists. */
#ifndef TRIM3R_TOOLS_FITTING_H
#define TRIM3R_TOOLS_FITTING_H

#include <stdbool.h>
#include <stdint.h>

#include "planning/machine.h"
#include "trim3r.h"

typedef struct fitting_options {
    uint64_t bytes;       /* limit of the arena; 0 = any */
    uint64_t nanoseconds; /* limit of a build; 0 = any */
    const char *machine;  /* a file of machine.h; NULL = this machine */
} fitting_options;

/* Reads the machine of that file, whose prices must be for so many threads; without a file, measures this machine.
 * Returns CLI_OK, or an exit status of cli.h after a message. */
int fitting_machine(const fitting_options *options, uint32_t threads, machine *m);

/* Prints the list; what the configuration leaves open is 0 Gaussians and CHOICES_ANY_REFINE. head: NULL = each. An
 * exit status of cli.h; CLI_BUDGET_TOO_SMALL where nothing fits. */
int fitting_list(const fitting_options *options, const t3r_config *config, const char *head, bool json, bool markdown);

#endif
