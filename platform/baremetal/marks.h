/* SPDX-License-Identifier: Apache-2.0 */
/* Marks the beginning of a stage, visibly from outside: a function for each stage, at an address in the symbol table.
 * tools/boards counts instructions between the marks; a profiler or a pin may use them, too. */
#ifndef T3R_BAREMETAL_MARKS_H
#define T3R_BAREMETAL_MARKS_H

#include "trim3r.h"

/* Calls mark_<stage>(). */
void mark_stage(t3r_stage stage);
/* Marks the start of code outside all stages. */
void mark_other(void);

#endif
