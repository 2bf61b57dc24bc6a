/* SPDX-License-Identifier: Apache-2.0 */
/* interface_driver: prints the status of each call with which a program starts, whether it wrote anything, and why the
 * library refuses the program. */
#include <stdio.h>
#include <string.h>

#include "trim3r.h"

enum { SIDE = 16, BUDGET = 16, ROOM = 512 };

/* All arguments of the calls, surrounded by memory that no call may write. */
typedef struct world {
    uint8_t before[ROOM];
    union {
        t3r_config config;
        t3r_plan_info plan;
        size_t sums[2];
    } at;
    uint8_t behind[ROOM];
    _Alignas(T3R_ARENA_ALIGN) uint8_t arena[T3R_ARENA_BYTES(SIDE, SIDE, 1, BUDGET)];
} world;

static world now, was;

static void print_call(const char *name, t3r_status status)
{
    printf("%s: %d, %s\n", name, (int)status, memcmp(&now, &was, sizeof now) == 0 ? "nothing written" : "written");
    was = now;
}

int main(void)
{
    t3r_runtime *rt = NULL;
    const t3r_config config = t3r_default_config(SIDE, SIDE, 1, BUDGET);
    const t3r_config zeros = {0};
    printf("default_config: %s\n", memcmp(&config, &zeros, sizeof config) == 0 ? "zeros" : "defaults");
    print_call("plan", t3r_plan(&config, &now.at.plan));
    memset(&now.at, 0, sizeof now.at); /* the sums are written again */
    was = now;
    print_call("plan_bytes", t3r_plan_bytes(&config, &now.at.sums[0], &now.at.sums[1]));
    was.at.config = now.at.config = config;
    print_call("plan_within", t3r_plan_within(sizeof now.arena, &now.at.config));
    print_call("init", t3r_init(&rt, now.arena, sizeof now.arena, &config));
    print_call("attach", t3r_attach(&rt, now.arena, sizeof now.arena));
    char text[T3R_ERROR_BYTES];
    printf("reason: %s\n", t3r_plan_error(t3r_plan(&config, &now.at.plan), &config, &now.at.plan, text, sizeof text));
    return 0;
}
