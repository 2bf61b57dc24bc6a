/* SPDX-License-Identifier: Apache-2.0 */
/* The report of `trim3r scene`: what was done, and how well each picture is drawn. */
#ifndef TRIM3R_TOOLS_SCENE_REPORT_H
#define TRIM3R_TOOLS_SCENE_REPORT_H

#include "import/frames/posed_frame.h"
#include "posing/estimate.h"
#include "trim3r/scene/drawn_pictures.h"
#include "trim3r/scene/scene_source.h"

typedef struct scene_report {
    const char *input, *output;
    scene_source source;
    bool estimated;         /* the poses */
    uint32_t frames, posed; /* of the recording that the scene was made of */
    char **names;           /* of the pictures, a frame each; NULL for a bag or a recording */
    uint32_t name_count;
    pose_account *accounts; /* likewise; NULL unless poses of pictures were estimated */
    char focal[128];        /* as in posed_folder */
    uint32_t left_out;      /* pictures that cannot be read */
    uint32_t gaussians, valid_points, width, height;
    const char *depth; /* "sensor" or "stereo" */
    drawn_picture drawn[DRAWN_MOST];
    uint32_t drawn_count;
    double seconds;
} scene_report;

/* Keeps what the report says about a folder. Returns 0, or -1 when out of memory. */
int scene_report_keep(scene_report *report, const posed_folder *folder, const pose_account *accounts);
void scene_report_free(scene_report *report);

void scene_report_print(const scene_report *report);
void scene_report_print_json(const scene_report *report);

#endif
