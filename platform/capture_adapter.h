/* What an adapter implements: its state starts with a t3r_capture whose operations point back to it. */
#ifndef T3R_PLATFORM_CAPTURE_ADAPTER_H
#define T3R_PLATFORM_CAPTURE_ADAPTER_H

#include "capture.h"

typedef struct t3r_capture_operations {
    /* As t3r_capture_next(); the reason of a failure goes into capture->error. */
    int (*next)(t3r_capture *capture, t3r_capture_frame *frame);
    /* Frees everything, the capture included. */
    void (*close)(t3r_capture *capture);
} t3r_capture_operations;

struct t3r_capture {
    const t3r_capture_operations *operations;
    char error[256]; /* "" until something goes wrong */
};

#endif
