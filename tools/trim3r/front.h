/* SPDX-License-Identifier: Apache-2.0 */
/* The program trim3r without main(), which may add commands to the product's. */
#ifndef TRIM3R_TOOLS_FRONT_H
#define TRIM3R_TOOLS_FRONT_H

#include <stdint.h>

typedef struct trim3r_command {
    const char *name;
    int (*run)(int argc, char **argv);
    const char *summary; /* NULL: it replaces the product's command of that name */
} trim3r_command;

typedef struct trim3r_extension {
    const char *heading; /* above its commands in --help */
    const trim3r_command *commands;
    uint32_t count;
} trim3r_extension;

/* Runs the command named by argv[1]; `added` may be NULL. Returns an exit status (cli.h). */
int trim3r_main(int argc, char **argv, const trim3r_extension *added);

#endif
