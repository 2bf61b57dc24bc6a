/* The state here is per process: its unfinished files. A signal handler reads it, so it consists of atomic pointers. */
#include "cli/files/part_files.h"

#include <signal.h>
#include <stdatomic.h>
#include <stddef.h>
#include <sys/types.h>
#include <unistd.h>

static _Atomic(char *) parts[PART_FILES_MOST];
static pid_t owner; /* a worker forked since then has no parts of its own */

static const int deadly[] = {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGPIPE};
enum { DEADLY = sizeof deadly / sizeof deadly[0] };

/* Removes the parts in a signal handler. Async-signal-safe: unlink(), rmdir(), sigaction(), raise(). Goes backwards,
 * since a folder was added before its contents. */
void part_files_end(int signal_number)
{
    for (int i = PART_FILES_MOST - 1; i >= 0 && getpid() == owner; i--) {
        const char *path = atomic_load(&parts[i]);
        if (path != NULL && unlink(path) != 0) {
            (void)rmdir(path);
        }
    }
    struct sigaction action = {.sa_handler = SIG_DFL};
    sigemptyset(&action.sa_mask);
    sigaction(signal_number, &action, NULL);
    sigset_t blocked;
    sigemptyset(&blocked);
    sigaddset(&blocked, signal_number);
    raise(signal_number);
    pthread_sigmask(SIG_UNBLOCK, &blocked, NULL); /* the process ends here */
}

/* Catches the signals that are neither ignored nor caught by others. */
static void catch_signals(void)
{
    struct sigaction action = {.sa_handler = part_files_end}, before;
    sigemptyset(&action.sa_mask);
    for (int i = 0; i < DEADLY; i++) {
        if (sigaction(deadly[i], NULL, &before) == 0 && before.sa_handler == SIG_DFL) {
            sigaction(deadly[i], &action, NULL);
        }
    }
}

bool part_files_add(char *path)
{
    if (owner != getpid()) {
        for (int i = 0; i < PART_FILES_MOST; i++) {
            atomic_store(&parts[i], NULL); /* parts of the parent process */
        }
        owner = getpid();
        catch_signals();
    }
    /* after all others, to keep the order */
    int free_place = 0;
    for (int i = 0; i < PART_FILES_MOST; i++) {
        free_place = atomic_load(&parts[i]) != NULL ? i + 1 : free_place;
    }
    if (free_place == PART_FILES_MOST) {
        return false;
    }
    atomic_store(&parts[free_place], path);
    return true;
}

void part_files_forget(const char *path)
{
    for (int i = 0; i < PART_FILES_MOST && path != NULL; i++) {
        if (atomic_load(&parts[i]) == path) {
            atomic_store(&parts[i], NULL);
            return;
        }
    }
}
