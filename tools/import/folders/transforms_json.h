/* SPDX-License-Identifier: Apache-2.0 */
/* transforms.json, as instant-ngp, NeRFCapture and nerfstudio write it. */
#ifndef TRIM3R_TOOLS_TRANSFORMS_JSON_H
#define TRIM3R_TOOLS_TRANSFORMS_JSON_H

#include <stddef.h>

#include "import/frames/posed_frame.h"

/* Parses the text of a transforms.json without touching any other file; options may be NULL. Call posed_folder_close()
 * in either case. */
int transforms_json_parse(const char *text, size_t bytes, const posed_folder_options *options, posed_folder *out,
                          char *error, size_t error_bytes);

#endif
