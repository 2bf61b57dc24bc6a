/* SPDX-License-Identifier: Apache-2.0 */
/* Numbers in USB's order (USB 2.0, 8.1): the least significant byte first. */
#ifndef T3R_TESTS_USB_LITTLE_ENDIAN_H
#define T3R_TESTS_USB_LITTLE_ENDIAN_H

#include <stdint.h>

static inline void put_le(uint8_t *bytes, uint32_t value, unsigned count)
{
    for (unsigned i = 0; i < count; i++) {
        bytes[i] = (uint8_t)(value >> 8 * i);
    }
}

static inline uint32_t get_le(const uint8_t *bytes, unsigned count)
{
    uint32_t value = 0;
    for (unsigned i = 0; i < count; i++) {
        value |= (uint32_t)bytes[i] << 8 * i;
    }
    return value;
}

#endif
