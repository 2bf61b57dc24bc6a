/* SPDX-License-Identifier: Apache-2.0 */
/* The worst cases as pictures: one HTML page. */
#ifndef TRIM3R_TOOLS_STRESS_PAGE_H
#define TRIM3R_TOOLS_STRESS_PAGE_H

#include <stdio.h>

#include "study/stress/measure.h"

#define STRESS_WORST_MOST 64u

/* A measured cell with its pictures; for each perturbation the cell in which the first method lost most. */
typedef struct stress_picture {
    stress_row *rows; /* stress_row_count() */
    uint8_t *renders; /* one for each row */
    uint8_t *plain;   /* renders of the unperturbed cell; NULL for synthetic scenes */
    uint8_t *target;
    uint8_t *context[T3R_MAX_VIEWS]; /* perturbed */
    uint8_t *depth[T3R_MAX_VIEWS];   /* the same, in grey: 0 = none, near is bright */
    uint32_t views, width, height;
} stress_picture;

typedef struct stress_album {
    stress_picture pictures[STRESS_WORST_MOST];
    uint32_t count;
} stress_album;

/* Keeps the cell if it is worse than the one kept for its perturbation. `plain`: renders of the unperturbed cell, or
 * NULL. False if out of memory. */
bool stress_album_offer(stress_album *album, const stress_row *rows, const uint8_t *renders, const uint8_t *plain,
                        const stress_case *c, const stress_contest *contest, const perturbation *p);
/* Writes the `worst` cells, the worst first, below the tables of all rows and of refused or broken ones. Returns 0, or
 * -1 if out of memory. */
int stress_album_write(stress_album *album, uint32_t worst, const stress_row *rows, uint32_t count,
                       const stress_contest *contest, FILE *out);
void stress_album_free(stress_album *album);

#endif
