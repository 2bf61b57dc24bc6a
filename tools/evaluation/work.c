/* SPDX-License-Identifier: Apache-2.0 */
#include "evaluation/work.h"

#include <stdlib.h>
#include <string.h>

#include "cli/cli.h"
#include "cli/jobs/process_pool.h"

/* With fewer cases per process than this, the contestants of a case are distributed as well, although each process
 * then makes what they share. */
#define CASES_ENOUGH 2u

#define REASON_BYTES 512

/* The current case, one per process. */
typedef struct desk {
    bool taken;
    uint32_t index;
    evaluation_entered entered;
    evaluation_views views;
    uint8_t *render;
} desk;

typedef struct worker {
    const evaluation_work *work;
    evaluation_report *report;
    desk desk;
    bool announced, refused; /* the case has been announced to the report, or refused */
    uint32_t announced_case, refused_case;
    uint32_t shares; /* items of work per case: 1, or its contestants */
} worker;

/* The message for a row; its render follows if the report shows pictures, or the reason if its case is refused. */
typedef struct made_row {
    uint32_t contestant, budget;
    bool known, refused;
    evaluation_row row;
} made_row;

static void clear_desk(desk *d)
{
    if (d->taken) {
        free(d->render);
        evaluation_views_free(&d->views);
        evaluation_case_leave(&d->entered);
    }
    *d = (desk){0};
}

/* Opens the case unless it is the current one. */
static int turn_to(worker *w, uint32_t index)
{
    desk *d = &w->desk;
    if (d->taken && d->index == index) {
        return CLI_OK;
    }
    clear_desk(d);
    int code = evaluation_case_enter(&d->entered, w->work->cases, index);
    if (code != CLI_OK) {
        return code;
    }
    code = evaluation_views_make(&d->views, &d->entered.what, w->work->settings);
    if (code != CLI_OK) {
        evaluation_case_leave(&d->entered);
        return code;
    }
    d->taken = true;
    d->index = index;
    d->render = malloc((size_t)d->views.width * d->views.height * 3);
    return d->render != NULL ? CLI_OK : cli_error(CLI_BAD_INPUT, "out of memory");
}

/* Measures the row unless it is known; the render goes to the desk. */
static int measure_row(worker *w, uint32_t index, made_row *made)
{
    const evaluation_work *work = w->work;
    const evaluation_contestant *it = &work->contestants->list[made->contestant];
    const evaluation_budget budget = work->budgets[made->budget];
    desk *d = &w->desk;
    int code = evaluation_name_row(&made->row, &work->cases->list[index], budget, &it->settings);
    made->row.ablation = it->ablation;
    if (code != CLI_OK) {
        return code;
    }
    const evaluation_row *known = evaluation_resume_find(work->resume, &made->row);
    if (known != NULL) {
        made->row = *known;
        made->known = true;
        return CLI_OK;
    }
    code = turn_to(w, index);
    if (code == CLI_OK) {
        code = evaluation_measure(&made->row, d->render, &d->views, &d->entered.what, budget, work->from_file,
                                  &it->settings);
        made->row.ablation = it->ablation;
    }
    return code;
}

/* One of several cases that cannot be made of its recording is a result; an error of the call or of the budget would
 * affect all cases and is returned. */
static int measure_or_refuse(worker *w, uint32_t index, made_row *made, char reason[REASON_BYTES])
{
    if (w->work->cases->count == 1) {
        return measure_row(w, index, made);
    }
    cli_keep_errors(reason, REASON_BYTES);
    int code = measure_row(w, index, made);
    cli_keep_errors(NULL, 0);
    if (code == CLI_BAD_INPUT && strcmp(reason, "out of memory") != 0) {
        made->refused = true;
        return CLI_OK;
    }
    return code == CLI_OK ? CLI_OK : cli_error(code, "%s", reason);
}

static int make_row(worker *w, uint32_t item, made_row *made, process_pool_line *line)
{
    char reason[REASON_BYTES] = "";
    const desk *d = &w->desk;
    int code = measure_or_refuse(w, item / w->shares, made, reason);
    if (code != CLI_OK) {
        return code;
    }
    if (made->refused) {
        return process_pool_send(line, made, sizeof *made, reason, sizeof reason);
    }
    bool shown = !made->known && evaluation_report_shows(w->report);
    return process_pool_send(line, made, sizeof *made, shown ? d->render : NULL,
                             (size_t)d->views.width * d->views.height * 3);
}

static int make_item(void *context, uint32_t item, process_pool_line *line)
{
    worker *w = context;
    const uint32_t count = w->work->contestants->count, each = count / w->shares, budgets = w->work->budget_count;
    const uint32_t first = item % w->shares * each * budgets;
    made_row made = {.refused = false};
    int code = CLI_OK;
    for (uint32_t i = first; i < first + each * budgets && code == CLI_OK && !made.refused; i++) {
        made = (made_row){.contestant = i / budgets, .budget = i % budgets};
        code = make_row(w, item, &made, line);
    }
    return code;
}

/* Announces a case, and a contestant, before its first row that is shown. */
static int announce(worker *w, uint32_t item, const made_row *made)
{
    const uint32_t index = item / w->shares;
    int code = turn_to(w, index);
    if (code == CLI_OK && (!w->announced || w->announced_case != index)) {
        code = evaluation_report_case(w->report, &w->desk.views, &w->desk.entered.what);
        w->announced = true;
        w->announced_case = index;
    }
    if (made->budget == 0) {
        evaluation_report_strip(w->report, w->work->contestants->list[made->contestant].label);
    }
    return code;
}

/* Refuses a case once, although every process that shares it finds it refused. */
static int refuse(worker *w, uint32_t index, const char *reason)
{
    if (w->refused && w->refused_case == index) {
        return CLI_OK;
    }
    w->refused = true;
    w->refused_case = index;
    evaluation_report_refuse(w->report, &w->work->cases->list[index], reason);
    return CLI_OK;
}

static int take_row(void *context, uint32_t item, const void *part, size_t bytes)
{
    worker *w = context;
    made_row made;
    memcpy(&made, part, sizeof made);
    if (made.refused) {
        return refuse(w, item / w->shares, (const char *)part + sizeof made);
    }
    if (w->refused && w->refused_case == item / w->shares) {
        return CLI_OK; /* a contestant for which the case was fit */
    }
    const bool shown = bytes > sizeof made;
    int code = shown ? announce(w, item, &made) : CLI_OK;
    if (code != CLI_OK) {
        return code;
    }
    if (shown) {
        memcpy(w->desk.render, (const uint8_t *)part + sizeof made, bytes - sizeof made);
    }
    return evaluation_report_row(w->report, made.known, &w->desk.views,
                                 w->work->contestants->list[made.contestant].label, &made.row, w->desk.render);
}

static void leave(void *context)
{
    clear_desk(&((worker *)context)->desk);
}

int evaluation_work_do(const evaluation_work *work, evaluation_report *report)
{
    worker w = {.work = work, .report = report, .shares = 1};
    if (work->processes > 1 && work->cases->count < CASES_ENOUGH * work->processes) {
        w.shares = work->contestants->count;
    }
    process_pool_job job = {
        .items = work->cases->count * w.shares,
        .processes = work->processes,
        .make = make_item,
        .take = take_row,
        .leave = leave,
        .context = &w,
    };
    int code = process_pool_run(&job);
    clear_desk(&w.desk);
    return code;
}
