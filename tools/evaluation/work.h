/* SPDX-License-Identifier: Apache-2.0 */
/* Makes the rows of an evaluation: every case with every contestant at every budget, in one process or several. */
#ifndef TRIM3R_TOOLS_EVALUATION_WORK_H
#define TRIM3R_TOOLS_EVALUATION_WORK_H

#include "evaluation/cases.h"
#include "evaluation/contestant.h"
#include "evaluation/report.h"
#include "evaluation/resume.h"

typedef struct evaluation_work {
    const evaluation_cases *cases;
    const evaluation_contestants *contestants;
    const reconstruction_options *settings;
    const evaluation_budget *budgets;
    uint32_t budget_count;
    bool from_file;
    uint32_t processes;
    evaluation_resume *resume; /* rows that need not be made again; empty: none */
} evaluation_work;

static inline uint32_t evaluation_work_rows_each(const evaluation_work *work)
{
    return work->contestants->count * work->budget_count;
}

/* Passes rows to the report as they are made, in the order case, contestant, budget for any number of processes. Of
 * several cases, those with refused frames (CLI_BAD_INPUT) go there too, with the reason; a single refused case is
 * an error. Returns an exit status of cli.h. */
int evaluation_work_do(const evaluation_work *work, evaluation_report *report);

#endif
