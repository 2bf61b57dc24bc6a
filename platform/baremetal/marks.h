/* Where a stage begins, as something outside can see: a function of its own for each stage, at a place that the symbol
 * table names. tools/boards counts instructions between them. A profiler or a pin may stand there as well. */
#ifndef T3R_BAREMETAL_MARKS_H
#define T3R_BAREMETAL_MARKS_H

#include "trim3r.h"

/* Calls mark_<stage>(). */
void mark_stage(t3r_stage stage);
/* What follows belongs to no stage. */
void mark_other(void);

#endif
