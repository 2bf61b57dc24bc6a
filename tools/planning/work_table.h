/* SPDX-License-Identifier: Apache-2.0 */
/* The work of a build, stage by stage: operations, and with a machine's prices milliseconds. */
#ifndef TRIM3R_TOOLS_WORK_TABLE_H
#define TRIM3R_TOOLS_WORK_TABLE_H

#include <cjson/cJSON.h>

#include "planning/work.h"

/* Adds "operations" by stage; with prices (else NULL) also "stages_ms", "build_ms" and "render_ms". */
void work_table_add_json(cJSON *object, const work_counts *work, const work_prices *prices);
void work_table_print(const work_counts *work, const work_prices *prices);

#endif
