/* SPDX-License-Identifier: Apache-2.0 */
/* Leaves out the border of one colour that all pictures of a folder have (picture_border.h). */
#ifndef TRIM3R_TOOLS_FOLDER_BORDER_H
#define TRIM3R_TOOLS_FOLDER_BORDER_H

#include "import/frames/posed_frame.h"

/* Sets what is used of each picture, and returns it; width 0: there is no border, or memory is out. Pictures that
 * cannot be read do not count. */
picture_inner folder_border_find(const char *directory, posed_folder *folder);

#endif
