/* SPDX-License-Identifier: Apache-2.0 */
#include "study/chart/raster.h"

#include <errno.h>
#include <spawn.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "cli/files/whole_file.h"
#include "host/reason.h"

/* A program instead of its library: linking the library would load it and its dependencies at every start of trim3r. */
#define RASTERIZER "rsvg-convert"

extern char **environ;

/* Runs the rasterizer with these descriptors as standard input and output. Returns its exit status; -1 with errno
 * set if it cannot be started. */
static int convert(int svg, int png, double scale)
{
    char zoom[32];
    snprintf(zoom, sizeof zoom, "--zoom=%g", scale);
    char *arguments[] = {RASTERIZER, "--format=png", zoom, NULL};
    posix_spawn_file_actions_t actions;
    pid_t child;
    int failed = posix_spawn_file_actions_init(&actions);
    if (failed == 0) {
        failed = posix_spawn_file_actions_adddup2(&actions, svg, STDIN_FILENO);
        failed = failed != 0 ? failed : posix_spawn_file_actions_adddup2(&actions, png, STDOUT_FILENO);
        failed = failed != 0 ? failed : posix_spawnp(&child, RASTERIZER, &actions, NULL, arguments, environ);
        posix_spawn_file_actions_destroy(&actions);
    }
    if (failed != 0) {
        errno = failed;
        return -1;
    }
    int status;
    while (waitpid(child, &status, 0) < 0) {
        if (errno != EINTR) {
            return -1;
        }
    }
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

static bool store(FILE *file, const char *text, size_t bytes)
{
    return fwrite(text, 1, bytes, file) == bytes && fflush(file) == 0 && fseek(file, 0, SEEK_SET) == 0;
}

int chart_raster_png(const char *path, const char *svg, size_t bytes, double scale, char *error, size_t error_bytes)
{
    t3r_whole_file png;
    if (whole_file_begin(&png, path, error, error_bytes) != 0) {
        return -1;
    }
    FILE *text = tmpfile();
    int status = text != NULL && store(text, svg, bytes) ? convert(fileno(text), fileno(png.stream), scale) : -1;
    int reason = errno;
    if (text != NULL) {
        fclose(text);
    }
    if (status == 0) {
        return t3r_whole_file_commit(&png, NULL, error, error_bytes);
    }
    t3r_whole_file_abandon(&png);
    if (status > 0) {
        return t3r_reason(error, error_bytes, "%s: %s ended with status %d", path, RASTERIZER, status);
    }
    return t3r_reason(error, error_bytes, "%s: %s%s", path, strerror(reason),
                      reason == ENOENT ? ": " RASTERIZER ", of the package librsvg2-bin, draws it" : "");
}
