/* SPDX-License-Identifier: Apache-2.0 */
/* Poses of a list that cannot be used: they are left out, counted and named; --strict refuses them. */
#ifndef TRIM3R_TOOLS_POSE_LOSSES_H
#define TRIM3R_TOOLS_POSE_LOSSES_H

#include <stdbool.h>
#include <stdint.h>

#define POSE_LOSSES_STRICT_HELP "refuse a list of poses of which some cannot be used (they are left out and counted)"

/* Initialise with zeros. */
typedef struct pose_losses {
    uint64_t count;
    char first[256]; /* where the first of them is, and what is wrong with it: "line 2: why" */
} pose_losses;

void pose_losses_add(pose_losses *losses, uint64_t count, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
/* Adds an entry whose time stamp an earlier one has: nothing says which of the two is meant. */
void pose_losses_add_repeated(pose_losses *losses, double seconds);
/* Prints what was left out of a file as a warning; with `strict`, as an error. Returns an exit status of cli.h. */
int pose_losses_print(const pose_losses *losses, const char *path, bool strict);

#endif
