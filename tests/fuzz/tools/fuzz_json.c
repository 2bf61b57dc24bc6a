/* SPDX-License-Identifier: Apache-2.0 */
/* Any text for --expect and --pose: an error, or hashes, and cameras that the runtime accepts. */
#define _GNU_SOURCE /* memfd_create() */
#include <string.h>

#include "cli/cli.h"
#include "core/camera.h"
#include "fuzz/memory_file.h"
#include "import/viewpoint.h"
#include "reconstruction/replay/replay_expectation.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char path[MEMORY_FILE_PATH_BYTES], error[512] = "";
    int descriptor = memory_file(data, size, path);
    viewpoint_list list;
    int status = viewpoint_read_pose(path, 0, 0, &list, error, sizeof error);
    if ((status != 0) != (error[0] != '\0')) {
        abort();
    }
    for (uint32_t i = 0; status == 0 && i < list.count; i++) {
        const t3r_camera *camera = &list.items[i];
        if (t3r_camera_check(camera, camera->width, camera->height) != T3R_OK) {
            abort();
        }
    }
    viewpoint_list_free(&list);
    expectation expected;
    error[0] = '\0';
    cli_keep_errors(error, sizeof error);
    if ((expectation_read(&expected, path) != CLI_OK) != (error[0] != '\0')) {
        abort();
    }
    expectation_free(&expected);
    close(descriptor);
    return 0;
}
