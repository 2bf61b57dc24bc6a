/* SPDX-License-Identifier: Apache-2.0 */
/* A fuzzer's bytes as a file, for readers that take a path. */
#ifndef T3R_FUZZ_MEMORY_FILE_H
#define T3R_FUZZ_MEMORY_FILE_H

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/mman.h>
#include <unistd.h>

#define MEMORY_FILE_PATH_BYTES 64

/* Returns a descriptor; the path is valid until it is closed with close(). */
static inline int memory_file(const uint8_t *data, size_t size, char path[MEMORY_FILE_PATH_BYTES])
{
    int descriptor = memfd_create("fuzz", 0);
    if (descriptor < 0 || write(descriptor, data, size) != (ssize_t)size) {
        abort();
    }
    snprintf(path, MEMORY_FILE_PATH_BYTES, "/proc/%ld/fd/%d", (long)getpid(), descriptor);
    return descriptor;
}

#endif
