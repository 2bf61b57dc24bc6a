/* SPDX-License-Identifier: Apache-2.0 */
#include "crc32.h"

#include "core/little_endian.h"

/* The remainder of a byte is the exclusive or of its bits' remainders. */
#define SUM(x, a, b, c, d, e, f, g, h)                                                                                 \
    (((x)&1 ? a : 0u) ^ ((x)&2 ? b : 0u) ^ ((x)&4 ? c : 0u) ^ ((x)&8 ? d : 0u) ^ ((x)&16 ? e : 0u) ^                   \
     ((x)&32 ? f : 0u) ^ ((x)&64 ? g : 0u) ^ ((x)&128 ? h : 0u))
#define BYTE_0(x)                                                                                                      \
    SUM(x, 0x77073096u, 0xee0e612cu, 0x076dc419u, 0x0edb8832u, 0x1db71064u, 0x3b6e20c8u, 0x76dc4190u, 0xedb88320u)
#define BYTE_1(x)                                                                                                      \
    SUM(x, 0x191b3141u, 0x32366282u, 0x646cc504u, 0xc8d98a08u, 0x4ac21251u, 0x958424a2u, 0xf0794f05u, 0x3b83984bu)
#define BYTE_2(x)                                                                                                      \
    SUM(x, 0x01c26a37u, 0x0384d46eu, 0x0709a8dcu, 0x0e1351b8u, 0x1c26a370u, 0x384d46e0u, 0x709a8dc0u, 0xe1351b80u)
#define BYTE_3(x)                                                                                                      \
    SUM(x, 0xb8bc6765u, 0xaa09c88bu, 0x8f629757u, 0xc5b428efu, 0x5019579fu, 0xa032af3eu, 0x9b14583du, 0xed59b63bu)
#define FOUR(of, x) of(x), of((x) + 1), of((x) + 2), of((x) + 3)
#define SIXTEEN(of, x) FOUR(of, x), FOUR(of, (x) + 4), FOUR(of, (x) + 8), FOUR(of, (x) + 12)
#define SIXTY_FOUR(of, x) SIXTEEN(of, x), SIXTEEN(of, (x) + 16), SIXTEEN(of, (x) + 32), SIXTEEN(of, (x) + 48)
#define ALL(of) SIXTY_FOUR(of, 0), SIXTY_FOUR(of, 64), SIXTY_FOUR(of, 128), SIXTY_FOUR(of, 192)

/* Remainders of one-byte messages before 0 to 3 bytes of 0, polynomial 0xedb88320: four bytes a step (Kounavis and
 * Berry, "A systematic approach to building high performance software-based CRC generators", 2005). */
static const uint32_t remainders[4][256] = {{ALL(BYTE_0)}, {ALL(BYTE_1)}, {ALL(BYTE_2)}, {ALL(BYTE_3)}};

uint32_t t3r_crc32(uint32_t crc, const void *bytes, size_t count)
{
    const uint8_t *b = bytes;
    size_t i = 0;
    crc = ~crc;
    for (; count - i >= 4; i += 4) {
        crc ^= t3r_load_le32(b + i);
        crc = remainders[3][crc & 0xff] ^ remainders[2][crc >> 8 & 0xff] ^ remainders[1][crc >> 16 & 0xff] ^
              remainders[0][crc >> 24];
    }
    for (; i < count; i++) {
        crc = remainders[0][(crc ^ b[i]) & 0xff] ^ (crc >> 8);
    }
    return ~crc;
}
