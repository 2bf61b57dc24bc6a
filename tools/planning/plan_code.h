/* SPDX-License-Identifier: Apache-2.0 */
/* A configuration and its arena as C, for a firmware. */
#ifndef TRIM3R_TOOLS_PLAN_CODE_H
#define TRIM3R_TOOLS_PLAN_CODE_H

#include <stddef.h>
#include <stdio.h>

#include "trim3r.h"

/* Writes the statements that make `config`: t3r_default_config(), then an assignment for each setting that has another
 * value. head: the name of a learned head, for a comment. */
void plan_code_settings(FILE *file, const t3r_config *config, const char *head, const char *indent);

/* Writes a header with the arena's bytes, T3R_PLANNED_BYTES and T3R_PLANNED_MIN_BYTES, and the function
 * t3r_planned_config(). Write errors stay in the stream
 * (ferror). */
void plan_code_header(FILE *file, const t3r_config *config, const t3r_plan_info *plan, const char *head);

#endif
