#include "marks.h"

/* No instructions are counted here. */

void mark_stage(t3r_stage stage)
{
    (void)stage;
}

void mark_other(void)
{
}
