/* SPDX-License-Identifier: Apache-2.0 */
/* How series and points are told apart: by words, colours and shapes. */
#ifndef TRIM3R_TOOLS_CHART_NAMES_H
#define TRIM3R_TOOLS_CHART_NAMES_H

#include <stddef.h>
#include <stdint.h>

#include "study/chart/points.h"

#define CHART_NAME_BYTES 2048u /* more than all settings together */
#define CHART_COLOURS 8u
#define CHART_SHAPES 6u

typedef struct chart_name {
    char text[CHART_NAME_BYTES]; /* the method, and those of its settings that most series have otherwise */
    uint32_t colour;             /* the method and its head; 0..CHART_COLOURS - 1, over again when there are more */
    uint32_t shape;              /* the rest, fine-tuning too; 0..CHART_SHAPES - 1 */
} chart_name;

typedef struct chart_names {
    chart_name *series;            /* one a series; NULL without memory */
    char common[CHART_NAME_BYTES]; /* what names leave out: "small, 8 bits, refine 4, ..."; may be "" */
} chart_names;

/* 0, or -1 without memory. */
int chart_names_make(chart_names *names, const chart_points *points);
void chart_names_free(chart_names *names);

/* The value of a setting as a person reads it; "" where the table does not tell. */
void chart_setting_text(const chart_points *points, uint32_t point, chart_setting setting, char *text, size_t bytes);

/* Path data of a shape about (0, 0), about as large as a disc of radius 1 each. */
extern const char *const chart_shapes[CHART_SHAPES];
extern const char *const chart_colours_light[CHART_COLOURS], *const chart_colours_dark[CHART_COLOURS];

#endif
