/* SPDX-License-Identifier: Apache-2.0 */
#include "import/folders/folder_info.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>

#include "cli/cli.h"
#include "cli/tables/json_output.h"
#include "host/reason.h"
#include "import/folders/posed_folder.h"
#include "import/frames/frame.h"

#define ERROR_BYTES 1024

typedef struct folder_summary {
    uint32_t depth_frames, posed_frames, pointmaps;
    uint32_t width, height, depth_width, depth_height; /* of the first picture, and of the first depth */
    t3r_recorded_camera camera;                        /* of the first picture; fx 0: unknown */
} folder_summary;

/* Reads the sides of the first picture and of the first depth from their headers. */
static int summarise(const char *directory, const posed_folder *folder, folder_summary *out, char *error)
{
    *out = (folder_summary){0};
    const posed_frame *depth = NULL, *first = &folder->frames[0];
    for (uint32_t i = 0; i < folder->frame_count; i++) {
        const posed_frame *frame = &folder->frames[i];
        depth = depth == NULL && frame->depth != NULL ? frame : depth;
        out->depth_frames += frame->depth != NULL;
        out->posed_frames += frame->posed;
        out->pointmaps += frame->pointmap != NULL;
    }
    if (import_picture_size(directory, first, &out->width, &out->height, error, ERROR_BYTES) != 0 ||
        (depth != NULL &&
         import_depth_size(directory, depth, &out->depth_width, &out->depth_height, error, ERROR_BYTES) != 0)) {
        return -1;
    }
    return isnan(first->intrinsics.fx) && isnan(first->intrinsics.angle_x) && isnan(first->intrinsics.angle_y)
               ? 0
               : posed_frame_camera(first, out->width, out->height, &out->camera, error, ERROR_BYTES);
}

static const char *distortion_name(const t3r_recorded_camera *camera)
{
    return camera->distortion == T3R_DISTORTION_NONE     ? "none"
           : camera->distortion == T3R_DISTORTION_RADTAN ? "radtan"
                                                         : "fisheye";
}

static void add_json(cJSON *json, const posed_folder *folder, const folder_summary *s)
{
    cJSON_AddStringToObject(json, "kind", folder->kind);
    cJSON_AddNumberToObject(json, "frames", folder->frame_count);
    cJSON_AddNumberToObject(json, "depth_frames", s->depth_frames);
    cJSON_AddNumberToObject(json, "posed_frames", s->posed_frames);
    cJSON_AddNumberToObject(json, "pointmaps", s->pointmaps);
    cJSON_AddNumberToObject(json, "width", s->width);
    cJSON_AddNumberToObject(json, "height", s->height);
    cJSON_AddNumberToObject(json, "depth_width", s->depth_width);
    cJSON_AddNumberToObject(json, "depth_height", s->depth_height);
    cJSON_AddNumberToObject(json, "depth_unit", s->depth_frames > 0 ? folder->depth_unit : 0);
    if (s->camera.fx > 0) {
        cJSON_AddItemToObject(
            json, "intrinsics",
            cJSON_CreateDoubleArray((double[]){s->camera.fx, s->camera.fy, s->camera.cx, s->camera.cy}, 4));
        cJSON_AddStringToObject(json, "distortion", distortion_name(&s->camera));
    }
    cJSON_AddNumberToObject(json, "triplets", folder->triplet_count);
    left_out_add_json(&folder->left_out, json);
    text_list_add_json(&folder->remarks, json, "remarks");
}

static void print_text(const char *directory, const posed_folder *folder, const folder_summary *s)
{
    printf("%s: %s: %u frames, the first %ux%u\n", directory, folder->kind, folder->frame_count, s->width, s->height);
    if (s->camera.fx > 0) {
        printf("camera:   fx %.6g, fy %.6g, cx %.6g, cy %.6g, lens distortion %s\n", s->camera.fx, s->camera.fy,
               s->camera.cx, s->camera.cy, distortion_name(&s->camera));
    } else {
        printf("camera:   none: import needs --intrinsics fx,fy,cx,cy, or --poses estimate\n");
    }
    if (s->posed_frames > 0) {
        printf("poses:    %u of %u frames\n", s->posed_frames, folder->frame_count);
    } else {
        printf("poses:    none: import needs --poses estimate or --pointmaps\n");
    }
    if (s->depth_frames > 0) {
        printf("depth:    %u of %u frames, %ux%u, %.9g world units a step\n", s->depth_frames, folder->frame_count,
               s->depth_width, s->depth_height, folder->depth_unit);
    } else if (s->pointmaps > 0) {
        printf("depth:    pointmaps of %u of %u frames\n", s->pointmaps, folder->frame_count);
    } else {
        printf("depth:    none: build and replay need --depth stereo\n");
    }
    printf("triplets: %u\n", folder->triplet_count);
    left_out_print(&folder->left_out);
    text_list_print(&folder->remarks, "remark");
}

int folder_info(const char *directory, cJSON *json)
{
    const posed_folder_options how = posed_folder_look(directory);
    posed_folder folder;
    folder_summary summary;
    char error[ERROR_BYTES] = "", reason[ERROR_BYTES] = "";
    int status = posed_folder_open(directory, &how, &folder, error, sizeof error);
    if (status == 0 && summarise(directory, &folder, &summary, reason) != 0) {
        status = t3r_reason(error, sizeof error, "%.300s: %s: %.700s", directory, folder.kind, reason);
    }
    if (status != 0) {
        status = cli_error(CLI_BAD_INPUT, "%s", error);
    } else if (json != NULL) {
        add_json(json, &folder, &summary);
    } else {
        print_text(directory, &folder, &summary);
    }
    posed_folder_close(&folder);
    return status;
}
