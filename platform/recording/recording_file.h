/* SPDX-License-Identifier: Apache-2.0 */
/* A growing file of a recording that may be cut off at any moment. Every message is passed to the system as soon as it
 * is complete, so that a process that dies loses at most the message in progress; with `sync` it also goes to the
 * disk. */
#ifndef T3R_PLATFORM_RECORDING_FILE_H
#define T3R_PLATFORM_RECORDING_FILE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "recording.h"

#define T3R_RECORDING_FILE_ROOM 65536u

typedef struct t3r_recording_file {
    int fd; /* -1: closed */
    bool sync;
    size_t held; /* bytes of room[] not yet written */
    uint8_t room[T3R_RECORDING_FILE_ROOM];
} t3r_recording_file;

/* Creates or empties the file. Returns 0, or -1 with "path: why" in error[]. */
int t3r_recording_file_open(t3r_recording_file *file, const char *path, bool sync, char *error, size_t error_bytes);
t3r_sink t3r_recording_file_sink(t3r_recording_file *file);
/* For t3r_recording_header.message_end. */
int t3r_recording_file_message_end(void *file);
/* Returns 0, or the errno of the first failure. */
int t3r_recording_file_close(t3r_recording_file *file);

#endif
