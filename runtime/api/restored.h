/* SPDX-License-Identifier: Apache-2.0 */
/* Checks an arena that was copied or restored from bytes, once, for everything that the stages rely on. */
#ifndef T3R_RESTORED_H
#define T3R_RESTORED_H

#include <stdbool.h>

#include "state/state.h"

/* Whether everything in the arena that a stage uses as an index, a count, a shift or a divisor is in range, and
 * redundant values agree: every call that the interface allows is then safe. The configuration must be in range and
 * the layout bound. Reads each plane of depth, validity and labels once, and the scene. */
bool t3r_is_restored(const t3r_runtime *rt);

#endif
