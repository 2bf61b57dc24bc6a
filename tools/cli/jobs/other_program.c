/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/jobs/other_program.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "cli/cli.h"
#include "host/reason.h"

extern char **environ;

/* Returns 0, or an errno. */
static int start(const char *path, char *const arguments[], int output, pid_t *child)
{
    posix_spawn_file_actions_t actions;
    int failed = posix_spawn_file_actions_init(&actions);
    if (failed != 0) {
        return failed;
    }
    failed = posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    failed = failed != 0 ? failed : posix_spawn_file_actions_adddup2(&actions, output, STDOUT_FILENO);
    failed = failed != 0 ? failed : posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
    failed = failed != 0 ? failed : posix_spawn(child, path, &actions, NULL, arguments, environ);
    posix_spawn_file_actions_destroy(&actions);
    return failed;
}

/* Waits for the child. Returns its exit status; -1: it took too long. */
static int wait_for(pid_t child, double seconds_most)
{
    const struct timespec while_waiting = {0, 5000000};
    const double end = cli_now() + seconds_most;
    int status;
    pid_t ended;
    while ((ended = waitpid(child, &status, WNOHANG)) == 0 && cli_now() < end) {
        nanosleep(&while_waiting, NULL);
    }
    if (ended == 0) {
        kill(child, SIGKILL);
        waitpid(child, &status, 0);
        return -1;
    }
    return ended < 0 ? -1 : WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

static char *read_back(FILE *file)
{
    char *text = calloc(OTHER_PROGRAM_BYTES_MOST + 1, 1);
    if (text != NULL) {
        rewind(file);
        text[fread(text, 1, OTHER_PROGRAM_BYTES_MOST, file)] = '\0';
    }
    return text;
}

int other_program_run(const char *path, char *const arguments[], double seconds_most, char **text, char *error,
                      size_t error_bytes)
{
    *text = NULL;
    FILE *output = tmpfile();
    pid_t child;
    const int failed = output == NULL ? errno : start(path, arguments, fileno(output), &child);
    int status = -1;
    if (failed != 0) {
        t3r_reason(error, error_bytes, "%s: %s", path, strerror(failed));
    } else {
        status = wait_for(child, seconds_most);
        *text = status >= 0 ? read_back(output) : NULL;
        if (*text == NULL) {
            t3r_reason(error, error_bytes, "%s: %s", path,
                       status >= 0 ? "out of memory" : "it does not end, and was stopped");
            status = -1;
        }
    }
    if (output != NULL) {
        fclose(output);
    }
    return status;
}
