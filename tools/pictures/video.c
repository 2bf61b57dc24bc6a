/* SPDX-License-Identifier: Apache-2.0 */
#include "pictures/video.h"

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <signal.h>
#include <spawn.h>
#include <string.h>
#include <strings.h>
#include <sys/wait.h>
#include <unistd.h>

#include "host/reason.h"

#define PROGRAM "ffmpeg"
#define EVEN_SIDES "pad=ceil(iw/2)*2:ceil(ih/2)*2" /* which yuv420p needs */

extern char **environ;

static const struct {
    const char *suffix, *format;
} formats[] = {{".mp4", "mp4"}, {".mkv", "matroska"}, {".mov", "mov"}, {".webm", "webm"}};

/* Returns ffmpeg's name of the format, or NULL. */
static const char *format_of(const char *path)
{
    const char *dot = strrchr(path, '.');
    for (size_t i = 0; i < sizeof formats / sizeof *formats && dot != NULL; i++) {
        if (strcasecmp(dot, formats[i].suffix) == 0) {
            return formats[i].format;
        }
    }
    return NULL;
}

bool video_is_named(const char *path)
{
    return format_of(path) != NULL;
}

/* Starts ffmpeg, which reads from `input`. Returns 0, or an errno. */
static int start(video *v, const char *format, const char *size, const char *rate, int input)
{
    const char *const line[] = {PROGRAM,           "-nostdin", "-y",       "-loglevel", "error",   "-f", "rawvideo",
                                "-pix_fmt",        "rgb24",    "-s",       size,        "-r",      rate, "-i",
                                "pipe:0",          "-vf",      EVEN_SIDES, "-pix_fmt",  "yuv420p", "-f", format,
                                v->file.temporary, NULL};
    posix_spawn_file_actions_t actions;
    int failed = posix_spawn_file_actions_init(&actions);
    if (failed != 0) {
        return failed;
    }
    failed = posix_spawn_file_actions_adddup2(&actions, input, STDIN_FILENO);
    failed = failed != 0 ? failed : posix_spawn_file_actions_adddup2(&actions, STDERR_FILENO, STDOUT_FILENO);
    /* the arguments are not changed: POSIX only lacks the const */
    failed = failed != 0 ? failed
                         : posix_spawnp(&v->encoder, PROGRAM, &actions, NULL, (char *const *)(uintptr_t)line, environ);
    posix_spawn_file_actions_destroy(&actions);
    return failed;
}

/* Opens the pipe, and starts ffmpeg at its other end. Returns 0, or an errno. */
static int open_pipe(video *v, const char *format, const char *size, const char *rate)
{
    int ends[2];
    if (pipe(ends) != 0) {
        return errno;
    }
    fcntl(ends[1], F_SETFD, FD_CLOEXEC);
    int failed = start(v, format, size, rate, ends[0]);
    close(ends[0]);
    v->pictures = failed == 0 ? fdopen(ends[1], "wb") : NULL;
    if (v->pictures == NULL) {
        close(ends[1]);
        failed = failed != 0 ? failed : ENOMEM;
    }
    return failed;
}

int video_begin(video *v, const char *path, uint32_t width, uint32_t height, double rate, char *error,
                size_t error_bytes)
{
    char size[32], number[32];
    *v = (video){.picture_bytes = (size_t)width * height * 3};
    if (whole_file_begin(&v->file, path, error, error_bytes) != 0) {
        return -1;
    }
    snprintf(size, sizeof size, "%" PRIu32 "x%" PRIu32, width, height);
    snprintf(number, sizeof number, "%g", rate);
    signal(SIGPIPE, SIG_IGN);
    const int failed = open_pipe(v, format_of(path), size, number);
    if (failed == 0) {
        return 0;
    }
    t3r_whole_file_abandon(&v->file);
    return failed == ENOENT ? t3r_reason(error, error_bytes,
                                         "%s: the program " PROGRAM " makes videos, and is not installed; -o NAME.png "
                                         "writes numbered pictures",
                                         path)
                            : t3r_reason(error, error_bytes, PROGRAM ": %s", strerror(failed));
}

int video_add(video *v, const uint8_t *rgb)
{
    return fwrite(rgb, 1, v->picture_bytes, v->pictures) == v->picture_bytes ? 0 : -1;
}

int video_end(video *v, bool whole, char *error, size_t error_bytes)
{
    if (v->pictures == NULL) {
        return 0;
    }
    int status = 0;
    const bool sent = fclose(v->pictures) == 0;
    v->pictures = NULL;
    while (waitpid(v->encoder, &status, 0) < 0 && errno == EINTR) {
    }
    if (whole && sent && WIFEXITED(status) && WEXITSTATUS(status) == 0) {
        return t3r_whole_file_commit(&v->file, NULL, error, error_bytes);
    }
    t3r_reason(error, error_bytes, "%s: " PROGRAM " failed", v->file.path);
    t3r_whole_file_abandon(&v->file);
    return whole ? -1 : 0;
}
