/* SPDX-License-Identifier: Apache-2.0 */
/* Writes frames and events into recordings that roll over: a file ends before it would exceed its size, and the next
 * one begins. */
#ifndef TRIM3R_TOOLS_CAPTURE_RECORD_H
#define TRIM3R_TOOLS_CAPTURE_RECORD_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "cli/options/recording_options.h"
#include "recording/recording_file.h"
#include "trim3r_capture.h"

typedef struct capture_record {
    const char *path;   /* of the first file; the n-th after it has -n before its suffix */
    uint64_t max_bytes; /* per file; 0 = no limit */
    bool sync;
    t3r_recording_header header;
    t3r_recording_file file;
    _Alignas(uint64_t) uint8_t recorder[T3R_RECORDER_BYTES];
    uint32_t files;
    uint64_t bytes;  /* in all files; the open one counts without its end */
    uint64_t frames; /* in the open file */
    char error[512];
} capture_record;

/* Opens the first file. Texts and paths must outlive the record. Returns 0, or -1 with a reason in record->error, as
 * all functions here. */
int capture_record_begin(capture_record *record, const char *path, uint64_t max_bytes, bool sync, const char *source,
                         const char *clock, uint64_t depth_unit_q40, const recording_options *how);
int capture_record_frame(capture_record *record, const t3r_capture_frame *frame);
int capture_record_event(capture_record *record, const t3r_capture_event *event);
int capture_record_end(capture_record *record);
/* Writes the name of file `number`: "rec.mcap", "rec-1.mcap"... */
void capture_record_name(const char *path, uint32_t number, char *name, size_t bytes);

#endif
