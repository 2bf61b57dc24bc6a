/* What `trim3r capture` tells of a capture when it has ended. */
#ifndef TRIM3R_TOOLS_CAPTURE_RESULT_H
#define TRIM3R_TOOLS_CAPTURE_RESULT_H

#include "capture/options.h"
#include "capture/run.h"
#include "capture/clock_offset.h"

/* name: the source's, without passwords. On stdout, as lines or with --json as one object. */
void capture_result_print(const capture_options *o, const char *name, const t3r_capture *capture,
                          const capture_account *a, const clock_offset *offset);

#endif
