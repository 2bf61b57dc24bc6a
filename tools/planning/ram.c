/* SPDX-License-Identifier: Apache-2.0 */
#include "planning/ram.h"

#include <inttypes.h>
#include <stdio.h>

#include "cli/cli.h"
#include "cli/tables/json_output.h"
#include "planning/plan_code.h"
#include "planning/ram_rows.h"
#include "planning/work.h"
#include "reconstruction/chosen_head.h"
#include "reconstruction/reconstruction_error.h"

typedef struct ram_row {
    uint64_t bytes;
    uint32_t side, views, gaussians;
    const char *head;
    uint32_t refine;
} ram_row;

#define ROW(...) {__VA_ARGS__},
static const ram_row rows[] = {RAM_ROWS(ROW)};
enum { ROWS = sizeof rows / sizeof rows[0] };

/* Users of RAM, in the order of the tables. */
enum { ARENA, STRIP, TARGET, STACK, PROGRAM, LEFT, PARTS };
static const struct {
    const char *key, *name;
} parts[PARTS] = {
    [ARENA] = {"arena_bytes", "arena"},
    [STRIP] = {"strip_bytes", "rows of a frame, colour and depth"},
    [TARGET] = {"target_bytes", "picture that is drawn"},
    [STACK] = {"stack_bytes", "stack"},
    [PROGRAM] = {"program_bytes", "variables of the program"},
    [LEFT] = {"left_bytes", "left over"},
};

typedef struct ram_plan {
    const ram_row *row;
    t3r_config config;
    uint64_t part[PARTS]; /* bytes */
    double operations;    /* of a build */
} ram_plan;

static t3r_config config_of(const ram_row *row, const chosen_head *head)
{
    t3r_config config = t3r_default_config(row->side, row->side, row->views, row->gaussians);
    chosen_head_configure(head, &config);
    config.refine = row->refine;
    config.fit_passes = 0; /* the table's figures are of so many */
    return config;
}

/* Shares the bytes out: the arena gets what is left, at most its bytes for full speed. */
static t3r_status share_out(uint64_t bytes, const chosen_head *head, ram_plan *plan)
{
    const uint64_t side = plan->row->side;
    plan->config = config_of(plan->row, head);
    plan->part[STRIP] = RAM_STRIP_ROWS * side * 5;
    plan->part[TARGET] = side * side * 3;
    plan->part[STACK] = RAM_STACK_BYTES;
    plan->part[PROGRAM] = RAM_PROGRAM_BYTES;
    uint64_t left = bytes;
    for (int i = STRIP; i < LEFT; i++) {
        left -= plan->part[i];
    }
    size_t least, most;
    t3r_status status = t3r_plan_bytes(&plan->config, &least, &most);
    if (status != T3R_OK) {
        return status;
    }
    plan->part[ARENA] = left < most ? left / T3R_ARENA_ALIGN * T3R_ARENA_ALIGN : most;
    plan->part[LEFT] = left - plan->part[ARENA];
    work_counts work;
    status = work_count(&plan->config, (size_t)plan->part[ARENA], head->weights, &work);
    if (status == T3R_OK) {
        plan->operations = work_price_of_build(&work, &work_operations);
    }
    return status;
}

static void print_json(const ram_plan *plan)
{
    const t3r_config *c = &plan->config;
    cJSON *root = cJSON_CreateObject();
    json_add_integer(root, "ram_bytes", (int64_t)plan->row->bytes);
    json_add_integer(root, "width", c->width);
    json_add_integer(root, "height", c->height);
    json_add_integer(root, "views", c->views);
    json_add_integer(root, "gaussians", c->gaussians);
    json_add_integer(root, "clusters", t3r_cluster_count(c));
    cJSON_AddStringToObject(root, "head", plan->row->head);
    json_add_integer(root, "head_column_bytes", c->head_column_bytes);
    json_add_integer(root, "refine", c->refine);
    json_add_integer(root, "strip_rows", RAM_STRIP_ROWS);
    json_add_integer(root, "operations", (int64_t)plan->operations);
    for (int i = 0; i < PARTS; i++) {
        json_add_integer(root, parts[i].key, (int64_t)plan->part[i]);
    }
    json_print(root);
}

/* Prints what a firmware writes for these settings. */
static void print_code(const ram_plan *plan)
{
    printf("\nin a firmware\n  static _Alignas(T3R_ARENA_ALIGN) uint8_t arena[%" PRIu64 "];\n", plan->part[ARENA]);
    plan_code_settings(stdout, &plan->config, plan->row->head, "  ");
}

static void print_text(const ram_plan *plan)
{
    const t3r_config *c = &plan->config;
    printf("settings for %" PRIu64 " bytes of RAM\n", plan->row->bytes);
    printf("%-36s %" PRIu32 "x%" PRIu32 "\n", "  working size and picture", c->width, c->height);
    printf("%-36s %" PRIu32 "\n", "  context views", c->views);
    printf("%-36s %" PRIu32 "\n", "  Gaussians", c->gaussians);
    printf("%-36s %" PRIu32 "\n", "  SuperClusters", t3r_cluster_count(c));
    printf("%-36s %s\n", "  head", plan->row->head);
    printf("%-36s %" PRIu32 "\n", "  refinement passes", c->refine);
    printf("%-36s %u\n", "  rows of a frame at once", RAM_STRIP_ROWS);
    printf("%-36s %.0f\n\nbytes of RAM\n", "  M operations of a build", plan->operations * 1e-6);
    uint64_t all = 0;
    for (int i = 0; i < PARTS; i++) {
        printf("  %-34s %10" PRIu64 "\n", parts[i].name, plan->part[i]);
        all += plan->part[i];
    }
    printf("  %-34s %10" PRIu64 "\n", "all", all);
    print_code(plan);
}

int ram_print(uint64_t bytes, bool json)
{
    if (bytes < rows[0].bytes) {
        return cli_error(CLI_BUDGET_TOO_SMALL,
                         "%" PRIu64 " bytes of RAM are too few: the smallest size is %" PRIu64 " (--ram %" PRIu64 "K)",
                         bytes, rows[0].bytes, rows[0].bytes >> 10);
    }
    ram_plan plan = {.row = rows};
    while (plan.row + 1 < rows + ROWS && bytes >= plan.row[1].bytes) {
        plan.row++;
    }
    chosen_head head;
    const int code = chosen_head_open(&head, plan.row->head);
    if (code != CLI_OK) {
        return code;
    }
    const t3r_status status = share_out(bytes, &head, &plan);
    chosen_head_close(&head);
    if (status != T3R_OK) {
        return reconstruction_error(status, "ram", &plan.config, (size_t)plan.part[ARENA]);
    }
    (json ? print_json : print_text)(&plan);
    return CLI_OK;
}
