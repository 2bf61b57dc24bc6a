/* SPDX-License-Identifier: Apache-2.0 */
/* runtime/head/weights.c on any bytes of any length up to 95: the checks before the table of layers. */
#include "head/weights.h"

#define ROOM 95

static uint8_t file[ROOM];

int main(void)
{
    for (uint32_t i = 0; i < ROOM; i++) {
        file[i] = (uint8_t)t3r_any(0, UINT8_MAX);
    }
    t3r_weights_check(file, (size_t)t3r_any(0, ROOM));
    return 0;
}
