/* The report of `trim3r capture` at the end of a capture. */
#ifndef TRIM3R_TOOLS_CAPTURE_RESULT_H
#define TRIM3R_TOOLS_CAPTURE_RESULT_H

#include "capture/options.h"
#include "capture/run.h"
#include "capture/clock_offset.h"

/* Prints the report on stdout, as lines or with --json as one object. name: the source's, without passwords. */
void capture_result_print(const capture_options *o, const char *name, const t3r_capture *capture,
                          const capture_account *a, const clock_offset *offset);

#endif
