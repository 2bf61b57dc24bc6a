/* A progressive JPEG may have thousands of scans, each a pass over the whole picture. libjpeg's progress monitor counts
 * them and stops the reading. */
#ifndef T3R_PLATFORM_JPEG_SCANS_H
#define T3R_PLATFORM_JPEG_SCANS_H

#include <stdio.h>

#include <jpeglib.h>

#include "mcap/reader_limits.h"

#define T3R_JPEG_SCANS_REASON T3R_LIMIT_TEXT("more than ", T3R_LIMIT_JPEG_SCANS, " scans")

typedef struct t3r_jpeg_scans {
    struct jpeg_progress_mgr progress; /* first: the library hands back a pointer to it */
    /* Does not return. */
    void (*refuse)(j_common_ptr jpeg, const char *reason);
} t3r_jpeg_scans;

static inline void t3r_jpeg_count_scans(j_common_ptr jpeg)
{
    if (jpeg->is_decompressor && ((j_decompress_ptr)jpeg)->input_scan_number > T3R_LIMIT_JPEG_SCANS) {
        ((t3r_jpeg_scans *)jpeg->progress)->refuse(jpeg, T3R_JPEG_SCANS_REASON);
    }
}

/* Watches a decompressor that has been created; `scans` must live as long as the decompressor. */
static inline void t3r_jpeg_watch_scans(j_decompress_ptr jpeg, t3r_jpeg_scans *scans,
                                        void (*refuse)(j_common_ptr jpeg, const char *reason))
{
    *scans = (t3r_jpeg_scans){.progress = {.progress_monitor = t3r_jpeg_count_scans}, .refuse = refuse};
    jpeg->progress = &scans->progress;
}

#endif
