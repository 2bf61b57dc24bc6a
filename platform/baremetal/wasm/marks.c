/* SPDX-License-Identifier: Apache-2.0 */
#include "marks.h"

#include "host.h"

void mark_stage(t3r_stage stage)
{
    host_mark((int32_t)stage);
}

void mark_other(void)
{
    host_mark(-1);
}
