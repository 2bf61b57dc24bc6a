/* SPDX-License-Identifier: Apache-2.0 */
/* A folder for one test, removed with its contents. */
#ifndef T3R_TESTS_SCRATCH_H
#define T3R_TESTS_SCRATCH_H

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

typedef struct scratch {
    char directory[256];
    char path[600]; /* path of the last name given to scratch_path() */
} scratch;

static inline int scratch_open(scratch *s)
{
    const char *base = getenv("TMPDIR");
    snprintf(s->directory, sizeof s->directory, "%s/trim3r-test-XXXXXX", base != NULL ? base : P_tmpdir);
    return mkdtemp(s->directory) != NULL ? 0 : -1;
}

static inline const char *scratch_path(scratch *s, const char *name)
{
    snprintf(s->path, sizeof s->path, "%s/%s", s->directory, name);
    return s->path;
}

static inline int scratch_write(scratch *s, const char *name, const void *bytes, size_t count)
{
    FILE *file = fopen(scratch_path(s, name), "wb");
    size_t written = file == NULL ? 0 : fwrite(bytes, 1, count, file);
    return file != NULL && fclose(file) == 0 && written == count ? 0 : -1;
}

static inline void scratch_close(scratch *s)
{
    DIR *all = opendir(s->directory);
    struct dirent *entry;
    while (all != NULL && (entry = readdir(all)) != NULL) {
        remove(scratch_path(s, entry->d_name));
    }
    if (all != NULL) {
        closedir(all);
    }
    rmdir(s->directory);
}

/* For cmocka: *state is the folder. */
static inline int scratch_setup(void **state)
{
    *state = malloc(sizeof(scratch));
    return *state == NULL ? -1 : scratch_open(*state);
}

static inline int scratch_teardown(void **state)
{
    scratch_close(*state);
    free(*state);
    return 0;
}

#endif
