/* SPDX-License-Identifier: Apache-2.0 */
#include "guarded.h"

#include <setjmp.h>
#include <signal.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

enum { SLOTS = 24, SLOT_BYTES = 1 << 16, BESIDE = 0xa5 };

typedef struct slot {
    uint8_t *pages, *begin;
    size_t bytes;
} slot;

static slot slots[SLOTS];
static uint32_t taken;
static uint64_t random_state;
static sigjmp_buf back;

static void *allocated(void)
{
    const size_t page = (size_t)sysconf(_SC_PAGESIZE);
    uint8_t *memory = mmap(NULL, SLOT_BYTES + 2 * page, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (memory == MAP_FAILED || mprotect(memory, page, PROT_NONE) != 0 ||
        mprotect(memory + page + SLOT_BYTES, page, PROT_NONE) != 0) {
        perror("guarded pages");
        exit(EXIT_FAILURE);
    }
    return memory + page;
}

void guarded_begin(uint64_t seed)
{
    taken = 0;
    random_state = seed * UINT64_C(0x9e3779b97f4a7c15) + 1;
}

void *guarded_take(size_t bytes, size_t align)
{
    slot *s = &slots[taken++];
    if (taken > SLOTS || bytes > SLOT_BYTES - 64 * align) {
        fprintf(stderr, "too many guarded buffers, or one too large\n");
        exit(EXIT_FAILURE);
    }
    if (s->pages == NULL) {
        s->pages = allocated();
    }
    random_state = random_state * UINT64_C(6364136223846793005) + 1442695040888963407;
    const uint64_t random = random_state >> 33;
    const size_t from_begin = (size_t)(random / 2 % 33) * align;
    const size_t from_end = SLOT_BYTES - (bytes + align - 1) / align * align;
    s->begin = s->pages + (random % 2 == 0 ? from_begin : from_end);
    s->bytes = bytes;
    memset(s->pages, BESIDE, SLOT_BYTES);
    return s->begin;
}

const char *guarded_broken(void)
{
    for (uint32_t i = 0; i < taken; i++) {
        const slot *s = &slots[i];
        for (const uint8_t *p = s->pages; p < s->pages + SLOT_BYTES; p++) {
            const bool is_inside = p >= s->begin && p < s->begin + s->bytes;
            if (!is_inside && *p != BESIDE) {
                return "wrote beside a buffer";
            }
        }
    }
    return NULL;
}

static void leave(int number)
{
    (void)number;
    siglongjmp(back, 1);
}

const char *guarded_run(const char *(*function)(void *context), void *context)
{
    struct sigaction action = {.sa_handler = leave}, segv, bus;
    const char *found;
    sigaction(SIGSEGV, &action, &segv);
    sigaction(SIGBUS, &action, &bus);
    if (sigsetjmp(back, 1) == 0) {
        found = function(context);
    } else {
        found = "touched a page beyond a buffer";
    }
    sigaction(SIGSEGV, &segv, NULL);
    sigaction(SIGBUS, &bus, NULL);
    return found;
}
