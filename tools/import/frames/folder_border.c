/* SPDX-License-Identifier: Apache-2.0 */
#include "import/frames/folder_border.h"

#include "cli/cli.h"
#include "import/frames/frame.h"

picture_inner folder_border_find(const char *directory, posed_folder *folder)
{
    border_search search;
    border_search_begin(&search);
    for (uint32_t i = 0; i < folder->frame_count && search.possible; i++) {
        char reason[512];
        picture p = {0};
        cli_progress("looking for a border", i, folder->frame_count);
        if (import_picture_upright(directory, &folder->frames[i], &p, reason, sizeof reason) == 0 &&
            border_search_add(&search, &p) != 0) {
            search.possible = false;
        }
        picture_free(&p);
    }
    const picture_inner inner = border_search_end(&search);
    for (uint32_t i = 0; i < folder->frame_count; i++) {
        folder->frames[i].inner = inner;
    }
    return inner;
}
