/* SPDX-License-Identifier: Apache-2.0 */
#include "planning/work_table.h"

#include <stdbool.h>
#include <stdio.h>

#include "cli/tables/json_output.h"
#include "cli/text/style.h"

static double milliseconds_of(const work_counts *work, const work_prices *prices, t3r_stage stage)
{
    return work_price(work, prices, stage) * 1e-6;
}

void work_table_add_json(cJSON *object, const work_counts *work, const work_prices *prices)
{
    cJSON *operations = cJSON_AddObjectToObject(object, "operations");
    for (int stage = 0; stage < T3R_STAGE_COUNT; stage++) {
        json_add_integer(operations, t3r_stage_name((t3r_stage)stage),
                         (int64_t)work_price(work, &work_operations, (t3r_stage)stage));
    }
    if (prices == NULL) {
        return;
    }
    cJSON *times = cJSON_AddObjectToObject(object, "stages_ms");
    for (int stage = 0; stage < T3R_STAGE_COUNT; stage++) {
        cJSON_AddNumberToObject(times, t3r_stage_name((t3r_stage)stage),
                                milliseconds_of(work, prices, (t3r_stage)stage));
    }
    cJSON_AddNumberToObject(object, "build_ms", work_price_of_build(work, prices) * 1e-6);
    cJSON_AddNumberToObject(object, "render_ms", milliseconds_of(work, prices, T3R_STAGE_RASTER));
}

static void print_row(const char *name, double operations, double milliseconds, bool timed)
{
    printf("%-30s %12.1f", name, operations * 1e-6);
    if (timed) {
        printf(" %12.2f", milliseconds);
    }
    putchar('\n');
}

void work_table_print(const work_counts *work, const work_prices *prices)
{
    const bool timed = prices != NULL;
    printf("%s%-30s %12s%s%s\n", style_begin(stdout, STYLE_HEADING), "stage", "M operations",
           timed ? "           ms" : "", style_end(stdout));
    for (int stage = 0; stage < T3R_STAGE_COUNT; stage++) {
        print_row(t3r_stage_name((t3r_stage)stage), work_price(work, &work_operations, (t3r_stage)stage),
                  timed ? milliseconds_of(work, prices, (t3r_stage)stage) : 0, timed);
    }
    print_row("a build, all but raster", work_price_of_build(work, &work_operations),
              timed ? work_price_of_build(work, prices) * 1e-6 : 0, timed);
}
