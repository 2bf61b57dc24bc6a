/* SPDX-License-Identifier: Apache-2.0 */
/* Tables of `trim3r eval`, of this version or an older one, as rows of settings and measures. */
#ifndef TRIM3R_TOOLS_CHART_TABLE_H
#define TRIM3R_TOOLS_CHART_TABLE_H

#include <stddef.h>
#include <stdint.h>

#include "study/chart/texts.h"

#define CHART_FILE_BYTES_MOST (16u << 20)
#define CHART_SETTING_BYTES_MOST 160u
#define CHART_ROWS_MOST 500000u /* in all tables together */

/* The settings that distinguish ways of building a scene. */
typedef enum chart_setting {
    CHART_METHOD,
    CHART_HEAD,
    CHART_BITS,
    CHART_REFINE,
    CHART_ALLOCATE,
    CHART_DEPTH,
    CHART_WAVELET,
    CHART_LEVELS,
    CHART_CLUSTERS,
    CHART_ELSE, /* settings without a column of their own */
    CHART_ABLATION,
    CHART_KEEP,
    CHART_SETTINGS
} chart_setting;

typedef enum chart_measure {
    CHART_PSNR,
    CHART_SSIM,
    CHART_PERCEPTUAL,
    CHART_PLANAR_PSNR,
    CHART_PSNR_ALL, /* of the whole picture, as the next two; after the others, so that none is the default */
    CHART_SSIM_ALL,
    CHART_PERCEPTUAL_ALL,
    CHART_QUALITIES,
    CHART_BUILD_MS = CHART_QUALITIES,
    CHART_RENDER_MS,
    CHART_ARENA_BYTES,
    CHART_SCENE_BYTES,
    CHART_COSTS_END,
    CHART_GAUSSIANS = CHART_COSTS_END, /* shown, but not an axis */
    CHART_MEASURES
} chart_measure;

typedef struct chart_setting_about {
    const char *column;
    const char *before, *behind; /* text around the value: "K 300", "8 bits" */
} chart_setting_about;

typedef enum chart_unit { CHART_PLAIN, CHART_DECIBELS, CHART_MILLISECONDS, CHART_BYTES } chart_unit;

typedef struct chart_measure_about {
    const char *column, *title;
    chart_unit unit;
    int decimals;       /* decimals shown */
    int less_is_better; /* true for all costs and for the perceptual measure */
} chart_measure_about;

extern const chart_setting_about chart_settings[CHART_SETTINGS];
extern const chart_measure_about chart_measures[CHART_MEASURES];

typedef struct chart_row {
    uint32_t setting[CHART_SETTINGS]; /* numbers in `texts`; "" where a table lacks it */
    uint32_t scene_case;              /* number in `cases` */
    uint32_t picture;                 /* number in `texts` */
    uint32_t file;                    /* number of the table */
    double value[CHART_MEASURES];     /* NaN = not given */
} chart_row;

typedef struct chart_case {
    uint32_t scene;           /* number in `scenes` */
    uint32_t context, target; /* numbers in `texts` */
} chart_case;

typedef struct chart_table {
    chart_texts texts, scenes, case_keys;
    chart_case *cases; /* case_keys.count entries */
    size_t case_room;
    chart_row *rows;
    uint32_t row_count;
    size_t row_room;
    uint32_t file_count;
    int has_pictures; /* whether a table names pictures */
} chart_table;        /* all zeros: empty */

/* Adds a file's rows. Returns 0, or -1 with "path:line: why" in error[]. A column that a table lacks is empty in all
 * its rows; columns with other names are ignored. Refuses tables without a quality or a cost, rows whose number of
 * cells differs from the heading's, cells that are not finite numbers, costs below 0, settings of more than
 * CHART_SETTING_BYTES_MOST bytes, and picture paths that are absolute or have a part "..". */
int chart_table_read(chart_table *table, const char *path, char *error, size_t error_bytes);
int chart_table_parse(chart_table *table, const char *name, const char *text, size_t bytes, char *error,
                      size_t error_bytes);
void chart_table_free(chart_table *table);

#endif
