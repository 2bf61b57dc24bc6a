/* SPDX-License-Identifier: Apache-2.0 */
/* Writes sentences about errors into the caller's memory. */
#ifndef T3R_SENTENCE_H
#define T3R_SENTENCE_H

#include <stddef.h>

#include "core/fault.h"
#include "trim3r.h"

/* Writes the fault's sentence if the checks found the status that the call returned, else the words of
 * t3r_error_text(). Cuts at `bytes`, the end of the text included. Returns `text`, or a constant text without memory.
 */
const char *t3r_sentence(t3r_status status, t3r_status found, const t3r_fault *fault, char *text, size_t bytes);

#endif
