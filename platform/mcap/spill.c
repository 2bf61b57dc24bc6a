#define _GNU_SOURCE /* O_TMPFILE */
#include "spill.h"

#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/mman.h>
#include <unistd.h>

#include "host/grow.h"

enum { ALIGNMENT = 16 };
#define PART_BYTES ((size_t)64 << 20) /* large, so that mappings stay far below the system's limit */

/* Opens a nameless or already unlinked file in the folder; -1 on failure. */
static int open_in(const char *folder)
{
    int file = open(folder, O_TMPFILE | O_RDWR | O_CLOEXEC | O_EXCL, 0600);
    char path[4096];
    if (file < 0 && (size_t)snprintf(path, sizeof path, "%s/trim3r-XXXXXX", folder) < sizeof path) {
        file = mkostemp(path, O_CLOEXEC);
        if (file >= 0) {
            unlink(path);
        }
    }
    return file;
}

static int open_file(t3r_spill *spill)
{
    if (spill->file == 0) {
        const char *folder = getenv("TMPDIR");
        spill->file = open_in(folder != NULL && folder[0] == '/' ? folder : "/var/tmp") + 1;
    }
    return spill->file - 1;
}

/* Adds a part. Its disk space is reserved first: otherwise, on a full disk, a write to its pages would end the
 * process. */
static int add_part(t3r_spill *spill, size_t count)
{
    const size_t bytes = count > PART_BYTES ? (count + 65535) / 65536 * 65536 : PART_BYTES; /* whole pages */
    t3r_spill_part *grown = t3r_grow(spill->parts, spill->part_count, &spill->part_capacity, sizeof *grown);
    spill->parts = grown != NULL ? grown : spill->parts;
    const int file = open_file(spill);
    if (grown == NULL || file < 0 || bytes < count ||
        posix_fallocate(file, (off_t)spill->file_bytes, (off_t)bytes) != 0) {
        return -1;
    }
    void *mapped = mmap(NULL, bytes, PROT_READ | PROT_WRITE, MAP_SHARED, file, (off_t)spill->file_bytes);
    if (mapped == MAP_FAILED) {
        return -1;
    }
    spill->file_bytes += bytes;
    spill->parts[spill->part_count++] = (t3r_spill_part){.bytes = mapped, .count = bytes};
    return 0;
}

static size_t aligned(size_t count)
{
    return (count + ALIGNMENT - 1) / ALIGNMENT * ALIGNMENT;
}

uint8_t *t3r_spill_take(t3r_spill *spill, size_t count)
{
    const t3r_spill_part *last = spill->part_count > 0 ? &spill->parts[spill->part_count - 1] : NULL;
    if (count > SIZE_MAX / 2 ||
        ((last == NULL || last->count - last->used < aligned(count)) && add_part(spill, aligned(count)) != 0)) {
        return NULL;
    }
    t3r_spill_part *part = &spill->parts[spill->part_count - 1];
    uint8_t *bytes = part->bytes + part->used;
    part->used += aligned(count);
    return bytes;
}

void t3r_spill_return(t3r_spill *spill, size_t count)
{
    spill->parts[spill->part_count - 1].used -= aligned(count);
}

void t3r_spill_rest(const t3r_spill *spill)
{
    for (size_t i = 0; i < spill->part_count; i++) {
        (void)madvise(spill->parts[i].bytes, spill->parts[i].count, MADV_DONTNEED); /* the file keeps the pages */
    }
}

void t3r_spill_free(t3r_spill *spill)
{
    for (size_t i = 0; i < spill->part_count; i++) {
        munmap(spill->parts[i].bytes, spill->parts[i].count);
    }
    free(spill->parts);
    if (spill->file > 0) {
        close(spill->file - 1);
    }
    *spill = (t3r_spill){0};
}
