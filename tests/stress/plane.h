/* SPDX-License-Identifier: Apache-2.0 */
/* A small plane of squares, for measurements of single cells. */
#ifndef TRIM3R_TESTS_STRESS_PLANE_H
#define TRIM3R_TESTS_STRESS_PLANE_H

#include <stdint.h>
#include <stdlib.h>

#include "cli/cli.h"
#include "study/stress/measure.h"
#include "study/stress/scene.h"

enum { SIDE = 48, METHODS = 3 };

typedef struct plane {
    stress_contest contest;
    stress_case c;
    stress_row rows[METHODS];
    uint8_t *renders;
} plane;

/* For cmocka: `contest` names methods and captures. */
static inline int plane_open(void **state, stress_contest contest)
{
    plane *p = calloc(1, sizeof *p);
    if (p == NULL) {
        return -1;
    }
    contest.keep[0] = 20;
    contest.keep_count = contest.seed = 1;
    reconstruction_defaults(&contest.settings);
    contest.settings.config.width = contest.settings.config.height = SIDE;
    contest.settings.head = "analytic";
    contest.settings.config.refine = contest.settings.config.rim = 0;
    p->contest = contest;
    p->c = (stress_case){.name = "plane", .context = "0,1", .target = "2"};
    p->renders = malloc(METHODS * SIDE * SIDE * 3);
    *state = p;
    return p->renders != NULL && stress_scene_draw(&p->c.base, stress_scene_at(0), 8, SIDE, SIDE) &&
                   stress_case_open(&p->c, &p->contest) == CLI_OK
               ? 0
               : -1;
}

static inline int plane_close(void **state)
{
    plane *p = *state;
    stress_case_close(&p->c);
    stress_capture_free(&p->c.base);
    free(p->renders);
    free(p);
    return 0;
}

#endif
