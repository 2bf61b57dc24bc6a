/* SPDX-License-Identifier: Apache-2.0 */
#include "trim3r/commands/plan_ram.h"

#include <inttypes.h>
#include <stdio.h>

#include "cli/cli.h"
#include "cli/tables/json_output.h"
#include "reconstruction/chosen_head.h"
#include "reconstruction/reconstruction_error.h"
#include "trim3r.h"

/* Uses of RAM, in the order of the tables. */
enum { PARTS = 6 };
typedef struct part {
    const char *key, *name;
    uint64_t bytes;
} part;

static void parts_of(uint64_t bytes, const t3r_ram_info *info, part parts[PARTS])
{
    const uint64_t taken =
        info->arena_bytes + info->strip_bytes + info->target_bytes + info->stack_bytes + info->program_bytes;
    const part all[PARTS] = {
        {"arena_bytes", "arena", info->arena_bytes},
        {"strip_bytes", "rows of a frame, colour and depth", info->strip_bytes},
        {"target_bytes", "picture that is drawn", info->target_bytes},
        {"stack_bytes", "stack", info->stack_bytes},
        {"program_bytes", "variables of the program", info->program_bytes},
        {"left_bytes", "left over", bytes - taken},
    };
    for (int i = 0; i < PARTS; i++) {
        parts[i] = all[i];
    }
}

static void print_json(const t3r_config *c, const t3r_ram_info *info, const char *head, uint64_t operations,
                       const part parts[PARTS])
{
    cJSON *root = cJSON_CreateObject();
    json_add_integer(root, "ram_bytes", (int64_t)info->ram_bytes);
    json_add_integer(root, "width", c->width);
    json_add_integer(root, "height", c->height);
    json_add_integer(root, "views", c->views);
    json_add_integer(root, "gaussians", c->gaussians);
    json_add_integer(root, "clusters", t3r_cluster_count(c));
    cJSON_AddStringToObject(root, "head", head);
    json_add_integer(root, "head_column_bytes", c->head_column_bytes);
    json_add_integer(root, "refine", c->refine);
    json_add_integer(root, "strip_rows", info->strip_rows);
    json_add_integer(root, "operations", (int64_t)operations);
    for (int i = 0; i < PARTS; i++) {
        json_add_integer(root, parts[i].key, (int64_t)parts[i].bytes);
    }
    json_print(root);
}

static void print_table(const t3r_config *c, const t3r_ram_info *info, const char *head, uint64_t operations,
                        const part parts[PARTS])
{
    printf("settings for %" PRIu64 " bytes of RAM\n", info->ram_bytes);
    printf("%-36s %" PRIu32 "x%" PRIu32 "\n", "  working size and picture", c->width, c->height);
    printf("%-36s %" PRIu32 "\n", "  context views", c->views);
    printf("%-36s %" PRIu32 "\n", "  Gaussians", c->gaussians);
    printf("%-36s %" PRIu32 "\n", "  SuperClusters", t3r_cluster_count(c));
    printf("%-36s %s\n", "  head", head);
    printf("%-36s %" PRIu32 "\n", "  refinement passes", c->refine);
    printf("%-36s %" PRIu32 "\n", "  rows of a frame at once", info->strip_rows);
    printf("%-36s %.0f\n\nbytes of RAM\n", "  M operations of a build", (double)operations / 1e6);
    uint64_t all = 0;
    for (int i = 0; i < PARTS; i++) {
        printf("  %-34s %10" PRIu64 "\n", parts[i].name, parts[i].bytes);
        all += parts[i].bytes;
    }
    printf("  %-34s %10" PRIu64 "\n", "all", all);
}

/* Finds the smallest size by bisection. */
static uint64_t least_bytes(void)
{
    uint64_t low = 0, high = UINT64_C(1) << 40;
    t3r_config config;
    while (low < high) {
        const uint64_t middle = low + (high - low) / 2;
        if (t3r_ram_config(middle, &config, NULL) == T3R_ERR_ARENA) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    return low;
}

int plan_ram(uint64_t bytes, bool json)
{
    t3r_config config;
    t3r_ram_info info;
    t3r_status status = t3r_ram_config(bytes, &config, &info);
    if (status == T3R_ERR_ARENA) {
        return cli_error(CLI_BUDGET_TOO_SMALL,
                         "%" PRIu64 " bytes of RAM are too few: the smallest size is %" PRIu64 " (--ram %" PRIu64 "K)",
                         bytes, least_bytes(), least_bytes() >> 10);
    }
    if (status != T3R_OK) {
        return reconstruction_error(status, "ram", &config, 0);
    }
    const char *name = info.weights != NULL ? info.weights : t3r_head_name(config.head);
    chosen_head head;
    int code = chosen_head_open(&head, name);
    if (code != CLI_OK) {
        return code;
    }
    t3r_work_counts work;
    status = t3r_count_work(&config, info.arena_bytes, head.weights, head.bytes, &work);
    chosen_head_close(&head);
    if (status != T3R_OK) {
        return reconstruction_error(status, "ram", &config, info.arena_bytes);
    }
    part parts[PARTS];
    parts_of(bytes, &info, parts);
    (json ? print_json : print_table)(&config, &info, name, t3r_price_of_build(&work, &t3r_operations), parts);
    return CLI_OK;
}
