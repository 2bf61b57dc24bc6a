/* SPDX-License-Identifier: Apache-2.0 */
#include "reconstruction/replay/hash_report.h"

#include <stdio.h>

#include "cli/tables/json_output.h"

static void print_line(const char *name, uint64_t hash)
{
    char text[HASH_TEXT_BYTES];
    hash_text(hash, text);
    printf("%-14s %s\n", name, text);
}

void hash_report_print(const reconstruction *r, uint64_t whole)
{
    for (int stage = 0; stage < T3R_STAGE_COUNT; stage++) {
        if (r->stage_hashed[stage]) {
            print_line(t3r_stage_name((t3r_stage)stage), r->stage_hash[stage]);
        }
    }
    print_line("final", whole);
}

void hash_report_add_stages(cJSON *object, const reconstruction *r)
{
    cJSON *stages = cJSON_AddObjectToObject(object, "stages");
    for (int stage = 0; stage < T3R_STAGE_COUNT; stage++) {
        if (r->stage_hashed[stage]) {
            json_add_hash(stages, t3r_stage_name((t3r_stage)stage), r->stage_hash[stage]);
        }
    }
}
