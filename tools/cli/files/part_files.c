/* The state here is the process's own: its parts. A handler of signals reads it, so it consists of atomic pointers. */
#include "cli/files/part_files.h"

#include <signal.h>
#include <stdatomic.h>
#include <stddef.h>
#include <sys/types.h>
#include <unistd.h>

static _Atomic(char *) parts[PART_FILES_MOST];
static pid_t owner; /* a worker, forked since, has no parts of its own */

static const int deadly[] = {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGPIPE};
enum { DEADLY = sizeof deadly / sizeof deadly[0] };

/* Async-signal-safe: unlink(), rmdir(), sigaction(), raise(). Backwards: a folder comes before what is in it. */
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
    pthread_sigmask(SIG_UNBLOCK, &blocked, NULL); /* ends here */
}

/* Signals that are ignored, or caught by others, stay theirs. */
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
            atomic_store(&parts[i], NULL); /* the parts of the process that this one was forked from */
        }
        owner = getpid();
        catch_signals();
    }
    /* behind all others, so that the order holds */
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
