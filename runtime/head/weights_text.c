/* SPDX-License-Identifier: Apache-2.0 */
/* Texts of the faults of weight files. */
#include "trim3r.h"
#include "weights.h"

#define TEXT_OF(NAME, text) [T3R_FAULT_##NAME] = text,

const char *t3r_weights_error(const void *weights, size_t bytes)
{
    static const char *const texts[] = {T3R_WEIGHTS_FAULTS(TEXT_OF)};
    return texts[t3r_weights_fault_of(weights, bytes)]; /* sound: no text */
}
