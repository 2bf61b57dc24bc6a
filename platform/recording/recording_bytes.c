/* SPDX-License-Identifier: Apache-2.0 */
#include "recording_bytes.h"

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "host/file_bytes.h"
#include "host/grow.h"
#include "host/reason.h"
#include "mcap/chunk_codec.h"
#include "mcap/mcap_records.h"
#include "mcap/reader_limits.h"

#define FIRST_BYTES 8                  /* bytes that identify a file */
#define PIECE_BYTES ((size_t)16 << 20) /* bytes of a large file read at once */

static const char *const no_disk = "there is no room on the disk for a copy (TMPDIR names another)";

static const char *kind_error(const uint8_t *first, size_t count)
{
    return t3r_zstd_is(first, count) ? NULL : t3r_mcap_magic_error(first, count);
}

/* Whether a file of that size goes on the heap. */
static bool is_small(const t3r_recording_bytes *all, uint64_t bytes)
{
    return bytes <= T3R_LIMIT_UNPACKED_HEAP && all->heap_bytes <= T3R_LIMIT_UNPACKED_HEAP - bytes;
}

/* Keeps bytes of the heap. Frees them and returns NULL without memory. */
static uint8_t *keep(t3r_recording_bytes *all, uint8_t *bytes, size_t count)
{
    uint8_t **grown = bytes == NULL ? NULL : t3r_grow(all->heap, all->heap_count, &all->capacity, sizeof *grown);
    if (grown == NULL) {
        free(bytes);
        return NULL;
    }
    all->heap = grown;
    all->heap[all->heap_count++] = bytes;
    all->heap_bytes += count;
    return bytes;
}

/* Reads a large file into the spill, if its first bytes are those of a recording. Returns NULL with the reason on
 * failure. */
static const uint8_t *read_large(FILE *file, size_t count, t3r_spill *spill, size_t *got, const char **why)
{
    uint8_t first[FIRST_BYTES];
    *why = kind_error(first, fread(first, 1, sizeof first, file));
    uint8_t *bytes = *why == NULL ? t3r_spill_take(spill, count) : NULL;
    if (bytes == NULL) {
        *why = *why != NULL ? *why : no_disk;
        return NULL;
    }
    memcpy(bytes, first, sizeof first); /* the file is larger */
    *got = sizeof first;
    for (size_t some = 1; some > 0 && *got < count;) {
        some = fread(bytes + *got, 1, count - *got < PIECE_BYTES ? count - *got : PIECE_BYTES, file);
        *got += some;
        t3r_spill_rest(spill);
    }
    *why = ferror(file) ? "it cannot be read to its end" : NULL;
    return *why == NULL ? bytes : NULL;
}

/* Reads a file as it is. *heap: its bytes, if they are not in the spill. */
static const uint8_t *read_stored(const t3r_recording_bytes *all, t3r_spill *spill, const char *path, uint8_t **heap,
                                  size_t *count, char *error, size_t error_bytes)
{
    struct stat about;
    *heap = NULL;
    if (stat(path, &about) != 0 || !S_ISREG(about.st_mode) || about.st_size < 0 ||
        is_small(all, (uint64_t)about.st_size) || (uint64_t)about.st_size > SIZE_MAX / 2) {
        *heap = t3r_file_bytes_checked(path, SIZE_MAX, kind_error, count, error, error_bytes);
        return *heap;
    }
    FILE *file = t3r_file_open(path, error, error_bytes);
    if (file == NULL) {
        return NULL;
    }
    const char *why;
    const uint8_t *bytes = read_large(file, (size_t)about.st_size, spill, count, &why);
    if (bytes == NULL) {
        (void)t3r_reason(error, error_bytes, "%s: %s", path, why);
    }
    fclose(file);
    return bytes;
}

/* Unpacks a file of zstd. Returns NULL with the reason on failure. */
static const uint8_t *unpack(t3r_recording_bytes *all, t3r_spill *spill, const uint8_t *packed, size_t packed_bytes,
                             size_t *count, const char **why)
{
    const uint64_t bytes = t3r_zstd_bytes(packed, packed_bytes);
    if (bytes == 0 || bytes > t3r_limit_unpacked(packed_bytes) || bytes > SIZE_MAX / 2) {
        *why = bytes == 0 ? "packed with zstd, and its size is not stated: zstd -d unpacks it"
                          : "packed with zstd to a size that no recording has: zstd -d unpacks it";
        return NULL;
    }
    const bool small = is_small(all, bytes);
    uint8_t *out = small ? keep(all, malloc((size_t)bytes), (size_t)bytes) : t3r_spill_take(spill, (size_t)bytes);
    if (out == NULL) {
        *why = small ? "out of memory" : no_disk;
        return NULL;
    }
    *why = t3r_chunk_decompress(t3r_text_of("zstd"), packed, packed_bytes, out, (size_t)bytes, count);
    if (*why == NULL && *count != bytes) {
        *why = "its data are shorter than the size that it states";
    }
    if (!small) {
        t3r_spill_rest(spill);
    }
    return *why == NULL ? out : NULL;
}

const uint8_t *t3r_recording_bytes_read(t3r_recording_bytes *all, t3r_spill *spill, const char *path, size_t *count,
                                        size_t *stored, char *error, size_t error_bytes)
{
    uint8_t *heap;
    const uint8_t *bytes = read_stored(all, spill, path, &heap, stored, error, error_bytes);
    if (bytes == NULL) {
        return NULL;
    }
    *count = *stored;
    const char *why = "out of memory";
    if (t3r_zstd_is(bytes, *stored)) {
        bytes = unpack(all, spill, bytes, *stored, count, &why);
        free(heap);
    } else if (heap != NULL) {
        bytes = keep(all, heap, *stored);
    }
    if (bytes == NULL) {
        (void)t3r_reason(error, error_bytes, "%s: %s", path, why);
    }
    return bytes;
}

void t3r_recording_bytes_free(t3r_recording_bytes *all)
{
    for (size_t i = 0; i < all->heap_count; i++) {
        free(all->heap[i]);
    }
    free(all->heap);
    *all = (t3r_recording_bytes){0};
}
