/* SPDX-License-Identifier: Apache-2.0 */
/* Stands for what a page's recordings do without: depth by stereo, folders and files on a disk. */
#include "host/reason.h"
#include "mcap/spill.h"
#include "reconstruction/context/context_depth.h"
#include "recording/recording_bytes.h"
#include "recording/recording_folder.h"

static const char *const in_memory = "a page reads recordings in memory only";

/* The page builds from measured depth alone. */
double context_depth_of_pair(const t3r_recording *recording, const char *path, const view_surface *first, uint32_t a,
                             uint32_t b)
{
    (void)recording;
    (void)path;
    (void)first;
    (void)a;
    (void)b;
    return 0;
}

int t3r_recording_files_of(const char *path, t3r_recording_files *files, char *error, size_t error_bytes)
{
    (void)files;
    return t3r_reason(error, error_bytes, "%s: %s", path, in_memory);
}

void t3r_recording_files_free(t3r_recording_files *files)
{
    (void)files;
}

const uint8_t *t3r_recording_bytes_read(t3r_recording_bytes *all, t3r_spill *spill, const char *path, size_t *count,
                                        size_t *stored, char *error, size_t error_bytes)
{
    (void)all;
    (void)spill;
    (void)count;
    (void)stored;
    (void)t3r_reason(error, error_bytes, "%s: %s", path, in_memory);
    return NULL;
}

void t3r_recording_bytes_free(t3r_recording_bytes *all)
{
    (void)all;
}

/* Only recordings in files spill. */
uint8_t *t3r_spill_take(t3r_spill *spill, size_t count)
{
    (void)spill;
    (void)count;
    return NULL;
}

void t3r_spill_return(t3r_spill *spill, size_t count)
{
    (void)spill;
    (void)count;
}

void t3r_spill_rest(const t3r_spill *spill)
{
    (void)spill;
}

void t3r_spill_free(t3r_spill *spill)
{
    (void)spill;
}
