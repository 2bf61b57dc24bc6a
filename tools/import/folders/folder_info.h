/* SPDX-License-Identifier: Apache-2.0 */
/* Describes a folder as import reads it, without decoding its pictures. */
#ifndef TRIM3R_TOOLS_FOLDER_INFO_H
#define TRIM3R_TOOLS_FOLDER_INFO_H

#include <cjson/cJSON.h>

/* Prints the kind of the folder, its frames, the camera and size of the first one, and what import would leave out; or
 * adds it to `json`, if that is not NULL. Returns an exit status of cli.h: an error with its remedy where import would
 * refuse the folder. */
int folder_info(const char *directory, cJSON *json);

#endif
