/* SPDX-License-Identifier: Apache-2.0 */
/* Options of a command that name files, declared in its own table, in `flags` next to argp's. The guard of files
 * (file_guard.h) and the tests read them there. */
#ifndef TRIM3R_TOOLS_FILE_OPTIONS_H
#define TRIM3R_TOOLS_FILE_OPTIONS_H

#include <argp.h>
#include <stdint.h>

#include "cli/options/file_kind.h"

#define OPTION_READS 0x100      /* the value is a file that is read */
#define OPTION_FOLDER 0x400     /* a folder: to be written, or readable in place of a file */
#define OPTION_LIST 0x800       /* several files separated by commas */
#define OPTION_OR_WORD 0x1000   /* a file, or a word that names none */
#define OPTION_OR_DEVICE 0x2000 /* a file or a device, optionally preceded by an adapter's name and a colon */
#define OPTION_PIPE 0x4000      /* the file may also be standard output: "-" (standard_output.h) */
#define OPTION_LATER 0x8000     /* a file that is read, and may not be there yet */
#define OPTION_WRITES_BIT 0x200
/* The value is a file that is written, or with OPTION_FOLDER files in a folder, of these kinds. */
#define OPTION_WRITES(kinds) (OPTION_WRITES_BIT | (int)(kinds) << 16)
#define OPTION_KINDS(flags) ((file_kind)((flags) >> 16))
/* A row of a command's table for its non-option arguments. Help does not show it. */
#define OPTION_ARGUMENTS(name, flags)                                                                                  \
    {                                                                                                                  \
        name, 0, NULL, OPTION_DOC | OPTION_HIDDEN | (flags), NULL, 0                                                   \
    }

/* A file named on the command line. */
typedef struct named_file {
    char option[32]; /* "-o", "--csv", or "the argument" */
    const char *path;
    int flags;
} named_file;

/* Replaces argp_parse(): first refuses what file_guard_begin() refuses, ending the process as a usage error does. Adds
 * --force if the command writes files. */
void file_options_parse(const struct argp *argp, int argc, char **argv, void *input);

#endif
