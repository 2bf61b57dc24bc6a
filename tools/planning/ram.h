/* SPDX-License-Identifier: Apache-2.0 */
/* The best settings for the RAM of a device, and what takes it: what `plan --ram` prints. */
#ifndef TRIM3R_TOOLS_RAM_H
#define TRIM3R_TOOLS_RAM_H

#include <stdbool.h>
#include <stdint.h>

/* Prints the settings for so many bytes of RAM: those of the largest size in ram_rows.h that is not above them. Returns
 * CLI_OK, or an exit status of cli.h after a message; CLI_BUDGET_TOO_SMALL for less than the smallest size. */
int ram_print(uint64_t bytes, bool json);

#endif
