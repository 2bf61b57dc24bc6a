/* SPDX-License-Identifier: Apache-2.0 */
/* trim3r plan --ram: the settings for a size of RAM, and its uses. */
#ifndef T3R_PLAN_RAM_H
#define T3R_PLAN_RAM_H

#include <stdbool.h>
#include <stdint.h>

/* Prints them; returns an exit code of cli/cli.h. */
int plan_ram(uint64_t bytes, bool json);

#endif
