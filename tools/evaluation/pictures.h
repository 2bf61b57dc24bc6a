/* SPDX-License-Identifier: Apache-2.0 */
/* Pictures of an evaluation: PNG files in a folder for each case, and an HTML page. */
#ifndef TRIM3R_TOOLS_EVALUATION_PICTURES_H
#define TRIM3R_TOOLS_EVALUATION_PICTURES_H

#include "evaluation/evaluation.h"
#include "pictures/html_page.h"

/* Writes FOLDER/target.png, mask.png, context_a.png, ... of a case (planar: only target.png); shown.png if the recorded
 * picture does not reach all pixels. */
int evaluation_write_views(const char *folder, const evaluation_views *views, const evaluation_case *what);
/* Writes the row's `picture` in FOLDER. */
int evaluation_write_render(const char *folder, const evaluation_views *views, const evaluation_row *row,
                            uint8_t *render);

/* Writes a section for a case: context views, target, mask. */
void evaluation_page_views(html_page *page, const evaluation_views *views, const evaluation_case *what);
/* Writes a render below its scores. */
void evaluation_page_render(html_page *page, const evaluation_views *views, const evaluation_row *row,
                            const uint8_t *render);

#endif
