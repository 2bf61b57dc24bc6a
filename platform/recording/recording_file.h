/* A file that a recording grows in, fit for cutting at any moment: every whole message goes to the system as soon as it
 * is whole, so that a process that dies loses at most the message it was writing; with `sync` it goes to the disk. */
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
    size_t held; /* bytes of room[] that are not written yet */
    uint8_t room[T3R_RECORDING_FILE_ROOM];
} t3r_recording_file;

/* Makes or empties the file. 0, or -1 with "path: why" in error[]. */
int t3r_recording_file_open(t3r_recording_file *file, const char *path, bool sync, char *error, size_t error_bytes);
t3r_sink t3r_recording_file_sink(t3r_recording_file *file);
/* For t3r_recording_header.message_end. */
int t3r_recording_file_message_end(void *file);
/* 0, or the errno of the first failure. */
int t3r_recording_file_close(t3r_recording_file *file);

#endif
