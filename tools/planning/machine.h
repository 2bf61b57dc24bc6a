/* SPDX-License-Identifier: Apache-2.0 */
/* A machine as plans model it: the time of a unit of each kind of work. A JSON file, which `bench --calibrate` writes
 * and `plan --machine` reads on any machine:
 *
 *     {"trim3r_machine": 1, "bits_epoch": 10, "threads": 1, "cpu_used": "avx2", "picoseconds": {"image": 9000, ...}}
 *
 * "picoseconds" has exactly the kinds of WORK_KINDS, by name. */
#ifndef TRIM3R_TOOLS_MACHINE_H
#define TRIM3R_TOOLS_MACHINE_H

#include <stddef.h>
#include <stdint.h>

#include "planning/work.h"

#define MACHINE_MAX_BYTES ((size_t)1 << 16) /* most bytes of a file */

typedef struct machine {
    work_prices prices;
    uint32_t threads; /* 1..T3R_MAX_WORKERS; the prices are for so many */
    char cpu[64];     /* vector extensions, named as by t3r_cpu_describe() */
} machine;

/* Parses a file's text. Returns 0, or -1 with "what, where" in error[]. */
int machine_parse(machine *m, const char *text, size_t bytes, char *error, size_t error_bytes);
/* Returns 0, or -1 with "path: why" in error[]. */
int machine_read(machine *m, const char *path, char *error, size_t error_bytes);
int machine_write(const machine *m, const char *path, char *error, size_t error_bytes);

#endif
