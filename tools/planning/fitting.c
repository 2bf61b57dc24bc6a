/* SPDX-License-Identifier: Apache-2.0 */
#include "planning/fitting.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>

#include "cli/cli.h"
#include "cli/options/processor_options.h"
#include "cli/tables/json_output.h"
#include "host/cpu.h"
#include "planning/calibrate.h"
#include "planning/choices.h"
#include "reconstruction/chosen_head.h"
#include "reconstruction/reconstruction_error.h"

#define SHORT_ROUNDS 2u /* rounds of a short calibration: about two seconds */
#define SHOWN_MOST 16u  /* most rows of the printed list */

static const char *const every_head[] = {"small", "tiny", "analytic"};
enum { HEADS = sizeof every_head / sizeof every_head[0] };

/* ---- the machine ------------------------------------------------------------------------------------------------- */

int fitting_machine(const fitting_options *o, uint32_t threads, machine *m)
{
    char error[512] = "";
    if (o->machine == NULL) {
        processor_options processor = processor_defaults();
        processor.threads = m->threads = threads;
        t3r_cpu_describe(processor.cpu, m->cpu, sizeof m->cpu);
        double errors[T3R_STAGE_COUNT];
        return calibrate(&processor, SHORT_ROUNDS, &m->prices, errors);
    }
    if (machine_read(m, o->machine, error, sizeof error) != 0) {
        return cli_error(CLI_BAD_INPUT, "%s", error);
    }
    if (m->threads != threads) {
        return cli_error(CLI_BAD_USAGE, "%s was measured with %" PRIu32 " threads: --threads %" PRIu32, o->machine,
                         m->threads, m->threads);
    }
    return CLI_OK;
}

/* ---- the list ---------------------------------------------------------------------------------------------------- */

typedef struct fitting_choices {
    chosen_head heads[HEADS];
    uint32_t head_count;
    choice items[HEADS * CHOICES_MOST];
    uint32_t count;
} fitting_choices;

/* Finds the choices of every head that was opened. */
static int find(fitting_choices *list, const t3r_config *config, const choice_limits *limits)
{
    list->count = 0;
    for (uint32_t i = 0; i < list->head_count; i++) {
        const t3r_status status = choices_add(config, &list->heads[i], limits, list->items, &list->count);
        if (status != T3R_OK) {
            t3r_config least = *config;
            chosen_head_configure(&list->heads[i], &least);
            least.gaussians = least.max_gaussians = 1;
            least.refine = 0;
            return reconstruction_error(status, "settings", &least, 0);
        }
    }
    return CLI_OK;
}

/* Reports the smallest and the fastest settings when nothing fits. */
static int refuse(fitting_choices *list, const t3r_config *config, const choice_limits *limits)
{
    choice_limits any = *limits;
    any.bytes = 0;
    any.most = 0;
    const int code = find(list, config, &any);
    if (code != CLI_OK || list->count == 0) {
        return code != CLI_OK ? code : cli_error(CLI_BUDGET_TOO_SMALL, "no arena holds these settings");
    }
    size_t bytes = SIZE_MAX;
    double price = HUGE_VAL;
    for (uint32_t i = 0; i < list->count; i++) {
        bytes = list->items[i].min_bytes < bytes ? list->items[i].min_bytes : bytes;
        price = fmin(price, list->items[i].price);
    }
    if (limits->prices == NULL) {
        return cli_error(CLI_BUDGET_TOO_SMALL, "nothing fits: the smallest arena is of %zu bytes", bytes);
    }
    return cli_error(CLI_BUDGET_TOO_SMALL,
                     "nothing fits: the smallest arena is of %zu bytes, and the fastest build takes %.3g ms", bytes,
                     price * 1e-6);
}

static double percent_of(const choice *c, const t3r_config *config)
{
    return 100.0 * c->gaussians / ((double)config->width * config->height * config->views);
}

static void print_json(const fitting_choices *list, const t3r_config *config, const choice_limits *limits)
{
    cJSON *root = cJSON_CreateObject();
    json_add_integer(root, "width", config->width);
    json_add_integer(root, "height", config->height);
    json_add_integer(root, "views", config->views);
    cJSON *choices = cJSON_AddArrayToObject(root, "choices");
    for (uint32_t i = 0; i < list->count; i++) {
        const choice *c = &list->items[i];
        cJSON *item = cJSON_CreateObject();
        cJSON_AddStringToObject(item, "head", c->head->name);
        json_add_integer(item, "gaussians", c->gaussians);
        json_add_integer(item, "refine", c->refine);
        cJSON_AddNumberToObject(item, "expected_loss_db", c->loss);
        json_add_integer(item, "min_bytes", (int64_t)c->min_bytes);
        json_add_integer(item, "arena_bytes", (int64_t)c->full_bytes);
        if (limits->prices != NULL) {
            cJSON_AddNumberToObject(item, "build_ms", c->price * 1e-6);
        }
        cJSON_AddItemToArray(choices, item);
    }
    json_print(root);
}

static void print_text(const fitting_choices *list, const t3r_config *config, const choice_limits *limits,
                       bool markdown)
{
    const bool timed = limits->prices != NULL;
    const uint32_t shown = list->count < SHOWN_MOST ? list->count : SHOWN_MOST;
    if (markdown) {
        printf("| head | gaussians | keep, %% | passes | loss, dB | arena, bytes |%s\n", timed ? " build, ms |" : "");
        printf("|---|---:|---:|---:|---:|---:|%s\n", timed ? "---:|" : "");
    } else {
        printf("head        gaussians  keep %%  passes  loss dB  arena bytes%s\n", timed ? "   build ms" : "");
    }
    for (uint32_t i = 0; i < shown; i++) {
        const choice *c = &list->items[i];
        printf(markdown ? "| %s | %" PRIu32 " | %.3g | %" PRIu32 " | %.1f | %zu |"
                        : "%-10s %10" PRIu32 " %7.3g %7" PRIu32 " %8.1f %12zu",
               c->head->name, c->gaussians, percent_of(c, config), c->refine, c->loss, c->full_bytes);
        if (timed) {
            printf(markdown ? " %.3g |" : " %10.3g", c->price * 1e-6);
        }
        putchar('\n');
    }
    if (list->count > shown && !markdown) {
        printf("and %" PRIu32 " more, which lose more (--json)\n", list->count - shown);
    }
}

static void print_origin(const fitting_options *o, const machine *m)
{
    if (o->machine != NULL) {
        printf("\nTimes are those of %s.\n", o->machine);
    } else {
        printf("\nTimes are those of this machine (%s), measured just now. trim3r bench --calibrate measures longer.\n",
               m->cpu);
    }
}

static int open_heads(fitting_choices *list, const char *head)
{
    int code = CLI_OK;
    for (uint32_t i = 0; i < (head != NULL ? 1 : HEADS) && code == CLI_OK; i++) {
        code = chosen_head_open(&list->heads[i], head != NULL ? head : every_head[i]);
        list->head_count += code == CLI_OK;
    }
    return code;
}

int fitting_list(const fitting_options *o, const t3r_config *config, const char *head, bool json, bool markdown)
{
    static fitting_choices list;
    machine m = {.threads = 1};
    const bool timed = o->nanoseconds != 0 || o->machine != NULL;
    const choice_limits limits = {
        .bytes = (size_t)o->bytes,
        .most = (double)o->nanoseconds,
        .prices = timed ? &m.prices : NULL,
        .gaussians = config->gaussians,
        .refine = config->refine,
    };
    int code = open_heads(&list, head);
    code = code == CLI_OK && timed ? fitting_machine(o, config->workers, &m) : code;
    code = code == CLI_OK ? find(&list, config, &limits) : code;
    if (code == CLI_OK && list.count == 0) {
        code = refuse(&list, config, &limits);
    } else if (code == CLI_OK && json) {
        print_json(&list, config, &limits);
    } else if (code == CLI_OK) {
        print_text(&list, config, &limits, markdown);
        if (timed && !markdown) {
            print_origin(o, &m);
        }
    }
    for (uint32_t i = 0; i < list.head_count; i++) {
        chosen_head_close(&list.heads[i]);
    }
    return code;
}
