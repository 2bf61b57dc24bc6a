/* SPDX-License-Identifier: Apache-2.0 */
#include "reconstruction/colmap/colmap_start.h"

#include <stdlib.h>

#include "cli/cli.h"
#include "reconstruction/colmap/colmap_folder.h"
#include "reconstruction/developed_frame.h"

#define ERROR_BYTES 512

int colmap_start_write(const colmap_start *start, whole_folder *folder, const char *name)
{
    const reconstruction_account *account = start->account;
    colmap_view views[T3R_MAX_VIEWS] = {0};
    char error[ERROR_BYTES] = "";
    int code = CLI_OK;
    for (uint32_t v = 0; v < account->context_count && code == CLI_OK; v++) {
        views[v] = (colmap_view){.frame = account->context[v], .width = account->width, .height = account->height};
        views[v].rgb = malloc((size_t)account->width * account->height * 3);
        code = views[v].rgb == NULL
                   ? cli_error(CLI_BAD_INPUT, "out of memory")
                   : developed_frame(start->recording, start->path, account->context[v], account->width,
                                     account->height, views[v].rgb, NULL, &views[v].camera);
        if (account->has_cameras) { /* the points were computed with the aligned poses */
            views[v].camera = account->camera[v];
        }
    }
    colmap_model model = {.views = views,
                          .view_count = account->context_count,
                          .scene = start->scene,
                          .local = start->local,
                          .sourced = start->sourced};
    if (code == CLI_OK && (colmap_folder_write(folder, &model, error, sizeof error) != 0 ||
                           whole_folder_commit(folder, error, sizeof error) != 0)) {
        code = cli_error(CLI_BAD_INPUT, "--colmap %s: %s", name, error);
    }
    for (uint32_t v = 0; v < account->context_count; v++) {
        free(views[v].rgb);
    }
    return code;
}
