/* SPDX-License-Identifier: Apache-2.0 */
#include "ram.h"

extern uint8_t data_begin_at[], zero_end_at[], memory_begin_at[], memory_end_at[], stack_bottom_at[], stack_top_at[];

ram_part ram_data(void)
{
    return (ram_part){data_begin_at, zero_end_at};
}

ram_part ram_free(void)
{
    return (ram_part){memory_begin_at, memory_end_at};
}

ram_part ram_stack(void)
{
    return (ram_part){stack_bottom_at, stack_top_at};
}
