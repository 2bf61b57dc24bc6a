/* SPDX-License-Identifier: Apache-2.0 */
/* Preloaded into a program: its allocation number FAIL_AT, counted from 1, fails. Those of its libraries before main()
 * are not counted. */
#include <stddef.h>
#include <stdlib.h>

extern void *__libc_malloc(size_t bytes);
extern void *__libc_calloc(size_t count, size_t bytes);
extern void *__libc_realloc(void *old, size_t bytes);

static int begun;

/* Runs after the constructors of all other libraries, as this one is preloaded. */
static __attribute__((constructor)) void begin(void)
{
    begun = 1;
}

static int fails(void)
{
    static long count, at = -1;
    if (!begun) {
        return 0;
    }
    if (at < 0) {
        const char *text = getenv("FAIL_AT");
        at = text != NULL ? strtol(text, NULL, 10) : 0;
    }
    return ++count == at;
}

void *malloc(size_t bytes)
{
    return fails() ? NULL : __libc_malloc(bytes);
}

void *calloc(size_t count, size_t bytes)
{
    return fails() ? NULL : __libc_calloc(count, bytes);
}

void *realloc(void *old, size_t bytes)
{
    return fails() ? NULL : __libc_realloc(old, bytes);
}
