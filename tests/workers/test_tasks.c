/* SPDX-License-Identifier: Apache-2.0 */
/* Tasks: their workers, and the part of the work that each does. */
#include "unit/unit.h"

#include "core/workers.h"

enum { MOST = 64 };

typedef struct notes {
    uint32_t calls, numbers[MOST], workers[MOST];
    uint32_t begin[MOST], end[MOST];
} notes;

static void note_task(void *context, uint32_t index, uint32_t worker)
{
    notes *noted = context;
    assert_true(noted->calls < MOST);
    noted->numbers[noted->calls] = index;
    noted->workers[noted->calls++] = worker;
}

static void note_rows(void *context, uint32_t begin, uint32_t end, uint32_t worker)
{
    notes *noted = context;
    assert_true(noted->calls < MOST);
    noted->begin[noted->calls] = begin;
    noted->end[noted->calls] = end;
    noted->workers[noted->calls++] = worker;
}

/* A caller's hook: runs the last task first, all by worker 3. */
static void backwards(void *user, uint32_t count, void (*task)(void *context, uint32_t index, uint32_t worker),
                      void *context)
{
    *(uint32_t *)user += 1;
    while (count > 0) {
        task(context, --count, 3);
    }
}

static void expect_in_order(const t3r_workers *workers, uint32_t count)
{
    notes noted = {0};
    t3r_run_tasks(workers, count, note_task, &noted);
    assert_int_equal(noted.calls, count);
    for (uint32_t i = 0; i < count; i++) {
        assert_int_equal(noted.numbers[i], i);
        assert_int_equal(noted.workers[i], 0);
    }
}

TEST(without_a_hook)
{
    uint32_t hooked = 0;
    const t3r_hooks none = {.user = &hooked}, hooks = {.user = &hooked, .parallel_for = backwards};
    const t3r_workers alone[] = {{NULL, 1}, {NULL, 4}, {&none, 4}, {&hooks, 1}};
    for (size_t i = 0; i < sizeof alone / sizeof alone[0]; i++) {
        assert_false(t3r_is_parallel(&alone[i]));
        expect_in_order(&alone[i], 0);
        expect_in_order(&alone[i], 5);
        notes noted = {0};
        t3r_run_rows(&alone[i], 37, note_rows, &noted);
        assert_true(noted.calls == 1 && noted.begin[0] == 0 && noted.end[0] == 37 && noted.workers[0] == 0);
    }
    assert_int_equal(hooked, 0);
}

/* A single task does not use the hook; two do. */
TEST(by_a_hook)
{
    uint32_t hooked = 0;
    const t3r_hooks hooks = {.user = &hooked, .parallel_for = backwards};
    for (uint32_t count = 2; count <= T3R_MAX_WORKERS; count++) {
        const t3r_workers workers = {&hooks, count};
        assert_true(t3r_is_parallel(&workers));
        hooked = 0;
        expect_in_order(&workers, 1);
        assert_int_equal(hooked, 0);
        notes noted = {0};
        t3r_run_tasks(&workers, 2, note_task, &noted);
        assert_int_equal(hooked, 1);
        assert_true(noted.calls == 2 && noted.numbers[0] == 1 && noted.numbers[1] == 0 && noted.workers[1] == 3);
    }
}

/* Two bands per worker, and none without a row unless there is no row at all. */
TEST(rows_by_a_hook)
{
    uint32_t hooked = 0;
    const t3r_hooks hooks = {.user = &hooked, .parallel_for = backwards};
    for (uint32_t count = 2; count <= T3R_MAX_WORKERS; count++) {
        for (uint32_t rows = 0; rows <= 70; rows++) {
            const t3r_workers workers = {&hooks, count};
            notes noted = {0};
            t3r_run_rows(&workers, rows, note_rows, &noted);
            assert_int_equal(noted.calls, rows == 0 ? 1 : rows < 2 * count ? rows : 2 * count);
            assert_int_equal(noted.end[0], rows);
            assert_int_equal(noted.begin[noted.calls - 1], 0);
            for (uint32_t i = 1; i < noted.calls; i++) {
                assert_int_equal(noted.end[i], noted.begin[i - 1]);
            }
        }
    }
}

TEST(shares)
{
    const uint32_t totals[] = {0, 1, 31, 32, 33, 1000, (1u << 26) - 1};
    for (size_t i = 0; i < sizeof totals / sizeof totals[0]; i++) {
        for (uint32_t tasks = 1; tasks <= 2 * T3R_MAX_WORKERS; tasks++) {
            uint32_t reached = 0;
            for (uint32_t index = 0; index < tasks; index++) {
                const t3r_share share = t3r_share_of(totals[i], index, tasks);
                assert_int_equal(share.begin, reached);
                assert_true(share.end - share.begin - totals[i] / tasks <= 1);
                reached = share.end;
            }
            assert_int_equal(reached, totals[i]);
        }
    }
}
