#include "capture.h"

#include "capture_adapter.h"

int t3r_capture_next(t3r_capture *capture, t3r_capture_frame *frame)
{
    return capture->operations->next(capture, frame);
}

const char *t3r_capture_error(const t3r_capture *capture)
{
    return capture->error;
}

void t3r_capture_close(t3r_capture *capture)
{
    if (capture != NULL) {
        capture->operations->close(capture);
    }
}
