/* SPDX-License-Identifier: Apache-2.0 */
/* Names of heads for the command line and the tables. */
#include "head.h"

#define NAME_OF(HEAD, name, function) [HEAD] = (name),

const char *t3r_head_name(t3r_head head)
{
    static const char *const names[] = {T3R_HEADS(NAME_OF)}; /* none for T3R_HEAD_CONFIGURED */
    return (uint32_t)head < sizeof names / sizeof names[0] ? names[head] : NULL;
}
