/* SPDX-License-Identifier: Apache-2.0 */
/* A file that a recording grows in and that may be cut off at any moment. It grows as "path.part" until it has a frame,
 * so that a recording without one replaces nothing. No two processes write to one path. Every message is passed to the
 * system as soon as it is complete, so that a process that dies loses at most the message in progress; with `sync` it
 * also goes to the disk. */
#ifndef T3R_PLATFORM_RECORDING_FILE_H
#define T3R_PLATFORM_RECORDING_FILE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "recording.h"

#define T3R_RECORDING_FILE_ROOM 65536u
#define T3R_RECORDING_PATH_BYTES 400u

typedef struct t3r_recording_file {
    int fd; /* -1: closed */
    bool sync;
    bool placed; /* it has its own name */
    char path[T3R_RECORDING_PATH_BYTES];
    size_t held; /* bytes of room[] not yet written */
    uint8_t room[T3R_RECORDING_FILE_ROOM];
} t3r_recording_file;

/* Creates the part, or opens a device. Returns 0, or -1 with "path: why" in error[]; EBUSY's text if another process
 * records to this path. */
int t3r_recording_file_open(t3r_recording_file *file, const char *path, bool sync, char *error, size_t error_bytes);
t3r_sink t3r_recording_file_sink(t3r_recording_file *file);
/* For t3r_recording_header.message_end. */
int t3r_recording_file_message_end(void *file);
/* Gives the part its own name, on the disk, too; nothing if it has it. Returns 0, or -1 with errno. */
int t3r_recording_file_place(t3r_recording_file *file);
/* Removes a part. Returns 0, or the errno of the first failure. */
int t3r_recording_file_close(t3r_recording_file *file);

#endif
