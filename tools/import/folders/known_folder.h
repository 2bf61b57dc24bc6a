/* SPDX-License-Identifier: Apache-2.0 */
/* Folders of other programs and data sets, which import does not read as they are. */
#ifndef TRIM3R_TOOLS_KNOWN_FOLDER_H
#define TRIM3R_TOOLS_KNOWN_FOLDER_H

#include <stddef.h>

/* Writes "KIND is not read as it is: REMEDY" for a folder that is recognised by its entries. Returns text[], or NULL
 * for other folders. */
const char *known_folder_advice(const char *directory, char *text, size_t bytes);

#endif
