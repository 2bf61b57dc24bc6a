/* SPDX-License-Identifier: Apache-2.0 */
/* The camera's faults and their times: the number of the stream, and of the frame in it. */
#ifndef T3R_TESTS_USB_FAULTS_H
#define T3R_TESTS_USB_FAULTS_H

#include <stdint.h>

#define FAULTS_MOST 16u

typedef enum fault_kind {
    FAULT_NONE,
    FAULT_ERROR,  /* the frame carries the error bit (UVC 1.0, 2.4.3.3) */
    FAULT_CUT,    /* the frame ends after half of its bytes */
    FAULT_STALL,  /* the stream stalls from this frame on */
    FAULT_UNPLUG, /* unplugged within the frame, and plugged in again later */
    FAULT_LEAVE,  /* unplugged within the frame for good */
} fault_kind;

typedef struct planned_fault {
    uint32_t stream, frame; /* both from 0 */
    fault_kind kind;
} planned_fault;

typedef struct faults {
    planned_fault list[FAULTS_MOST];
    uint32_t count;
} faults;

/* Adds "STREAM.FRAME=error", likewise cut, stall, unplug, leave. Returns 0, or -1 if the fault is unknown or there are
 * too many. */
int faults_add(faults *self, const char *text);
fault_kind faults_at(const faults *self, uint32_t stream, uint32_t frame);

#endif
