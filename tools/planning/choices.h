/* SPDX-License-Identifier: Apache-2.0 */
/* The settings that fit an arena and a time, those of the least expected loss first. */
#ifndef TRIM3R_TOOLS_CHOICES_H
#define TRIM3R_TOOLS_CHOICES_H

#include <stddef.h>
#include <stdint.h>

#include "planning/work.h"
#include "reconstruction/chosen_head.h"
#include "trim3r.h"

#define CHOICES_MOST 48u /* of one head */
#define CHOICES_ANY_REFINE UINT32_MAX

/* Limits of a build, and settings that are fixed. */
typedef struct choice_limits {
    size_t bytes;              /* bytes of the arena; 0 = any */
    double most;               /* price of a build; 0 = any */
    const work_prices *prices; /* NULL = not known, with which `most` is 0 */
    uint32_t gaussians;        /* budget; 0 = each of some shares of the points */
    uint32_t refine;           /* passes; CHOICES_ANY_REFINE = each of some */
} choice_limits;

typedef struct choice {
    const chosen_head *head;
    uint32_t gaussians, refine;
    size_t min_bytes, full_bytes; /* least bytes of its arena, and bytes for full speed */
    double price;                 /* of a build, in an arena of the limits; 0 without prices */
    double loss;                  /* expected against the best settings known, in dB of PSNR (docs/study/cost.md) */
} choice;

/* Adds the settings with this head that fit to a list, which has room for CHOICES_MOST more. Of equal loss the lowest
 * price comes first. Settings that others in the list match or beat in loss, bytes and price are left out or dropped.
 * Budget and passes of the configuration are not read; its head is this one. Returns the configuration's error, if any,
 * with the list as before. */
t3r_status choices_add(const t3r_config *config, const chosen_head *head, const choice_limits *limits, choice *choices,
                       uint32_t *count);

#endif
