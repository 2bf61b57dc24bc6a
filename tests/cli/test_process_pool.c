/* SPDX-License-Identifier: Apache-2.0 */
/* The process pool: order, equal results with one process and several, failures, a worker that dies. */
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "cli/cli.h"
#include "cli/jobs/process_pool.h"
#include "test.h"

#define ITEMS 23u
#define LARGE 300000u /* bytes: more than a pipe holds */
#define NONE UINT32_MAX

typedef struct plan {
    uint32_t fails, dies, refused; /* items */
    uint32_t taken[3 * ITEMS], count;
    uint32_t ended; /* parts whose large tail was complete */
} plan;

static void wait_ms(long ms)
{
    nanosleep(&(struct timespec){.tv_nsec = ms * 1000000}, NULL);
}

/* Sends item % 3 parts; early items take longest. */
static int make(void *context, uint32_t item, process_pool_line *line)
{
    plan *p = context;
    wait_ms(item < 4 ? 20 : 1);
    if (item == p->fails) {
        return CLI_BAD_USAGE;
    }
    uint8_t *tail = malloc(LARGE);
    assert_non_null(tail);
    memset(tail, (int)item, LARGE);
    int code = CLI_OK;
    for (uint32_t part = 0; part < item % 3 && code == CLI_OK; part++) {
        uint32_t value = item * 3 + part;
        code = process_pool_send(line, &value, sizeof value, part == 1 ? tail : NULL, LARGE);
    }
    free(tail);
    if (item == p->dies) {
        raise(SIGKILL);
    }
    return code;
}

static int take(void *context, uint32_t item, const void *part, size_t bytes)
{
    plan *p = context;
    uint32_t value;
    memcpy(&value, part, sizeof value);
    assert_int_equal(value / 3, item);
    p->taken[p->count++] = value;
    if (bytes > sizeof value) {
        assert_int_equal(bytes, sizeof value + LARGE);
        const uint8_t *tail = (const uint8_t *)part + sizeof value;
        assert_int_equal(tail[0], item);
        assert_int_equal(tail[LARGE - 1], item);
        p->ended++;
    }
    return item == p->refused ? CLI_BUDGET_TOO_SMALL : CLI_OK;
}

static plan run(uint32_t processes, plan p, int *code)
{
    process_pool_job job = {.items = ITEMS, .processes = processes, .make = make, .take = take, .context = &p};
    *code = process_pool_run(&job);
    return p;
}

static const plan plain = {.fails = NONE, .dies = NONE, .refused = NONE};

TEST(test_order)
{
    static const uint32_t processes[] = {1, 2, 5, 64};
    for (int i = 0; i < 4; i++) {
        int code;
        plan p = run(processes[i], plain, &code);
        assert_int_equal(code, CLI_OK);
        assert_int_equal(p.count, 22); /* 8 items of one part, 7 of two */
        assert_int_equal(p.ended, 7);
        for (uint32_t k = 1; k < p.count; k++) {
            assert_true(p.taken[k - 1] < p.taken[k]);
        }
    }
}

TEST(test_a_failing_item)
{
    for (uint32_t processes = 1; processes < 5; processes++) {
        plan wanted = plain;
        wanted.fails = 10;
        int code;
        plan p = run(processes, wanted, &code);
        assert_int_equal(code, CLI_BAD_USAGE);
        assert_int_equal(p.count, 9); /* of the items 0 to 9 */
    }
}

TEST(test_a_part_that_is_not_taken)
{
    for (uint32_t processes = 1; processes < 5; processes++) {
        plan wanted = plain;
        wanted.refused = 8;
        int code;
        plan p = run(processes, wanted, &code);
        assert_int_equal(code, CLI_BUDGET_TOO_SMALL);
        assert_int_equal(p.taken[p.count - 1], 24);
    }
}

TEST(test_a_worker_that_dies)
{
    plan wanted = plain;
    wanted.dies = 5;
    int code;
    plan p = run(3, wanted, &code);
    assert_int_equal(code, CLI_BAD_INPUT);
    for (uint32_t k = 0; k < p.count; k++) {
        assert_true(p.taken[k] / 3 <= 5);
    }
}

TEST(test_nothing_to_do)
{
    process_pool_job job = {.items = 0, .processes = 4, .make = make, .take = take};
    assert_int_equal(process_pool_run(&job), CLI_OK);
    assert_true(process_pool_processors() >= 1);
}
