/* SPDX-License-Identifier: Apache-2.0 */
/* Lists of cameras in JSON besides transforms.json: the camera path of nerfstudio, and cameras.json of 3D Gaussian
 * Splatting. */
#ifndef TRIM3R_TOOLS_CAMERA_LIST_H
#define TRIM3R_TOOLS_CAMERA_LIST_H

#include <stdbool.h>
#include <stddef.h>

#include <cjson/cJSON.h>

#include "import/frames/posed_frame.h"

/* Whether the text is one of these lists: an array, or an object with a camera_path. */
bool camera_list_is(const cJSON *root);
/* Reads the cameras into out->frames, without pictures; one that cannot be used is marked as rejected. *rate: pictures
 * a second that the file states; 0 = none. Returns 0, or -1 with "field: what" in error[]. Call posed_folder_close() in
 * either case. */
int camera_list_read(const cJSON *root, posed_folder *out, double *rate, char *error, size_t error_bytes);

#endif
