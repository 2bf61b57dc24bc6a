/* SPDX-License-Identifier: Apache-2.0 */
/* Names, colours and shapes that distinguish series and points. */
#ifndef TRIM3R_TOOLS_CHART_NAMES_H
#define TRIM3R_TOOLS_CHART_NAMES_H

#include <stddef.h>
#include <stdint.h>

#include "study/chart/points.h"

#define CHART_NAME_BYTES 2048u /* more than all settings together */
#define CHART_COLOURS 8u
#define CHART_SHAPES 6u

typedef struct chart_name {
    char text[CHART_NAME_BYTES]; /* the method, and its settings that differ from those of most series */
    uint32_t colour;             /* of the method and its head; 0..CHART_COLOURS - 1, reused when there are more */
    uint32_t shape;              /* of the other settings, including fine-tuning; 0..CHART_SHAPES - 1 */
} chart_name;

typedef struct chart_names {
    chart_name *series;            /* one per series; NULL when memory ran out */
    char common[CHART_NAME_BYTES]; /* settings that names omit: "small, 8 bits, refine 4, ..."; may be "" */
} chart_names;

/* Returns 0, or -1 if out of memory. */
int chart_names_make(chart_names *names, const chart_points *points);
void chart_names_free(chart_names *names);

/* Writes a setting's value for readers; "" where the table does not give it. */
void chart_setting_text(const chart_points *points, uint32_t point, chart_setting setting, char *text, size_t bytes);

/* SVG path data of each shape, about (0, 0), each about as large as a disc of radius 1. */
extern const char *const chart_shapes[CHART_SHAPES];
extern const char *const chart_colours_light[CHART_COLOURS], *const chart_colours_dark[CHART_COLOURS];

#endif
