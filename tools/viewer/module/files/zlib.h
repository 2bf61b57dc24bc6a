/* SPDX-License-Identifier: Apache-2.0 */
/* The function of zlib that the reader of recordings calls, without the library. */
#ifndef TRIM3R_TOOLS_VIEWER_ZLIB_H
#define TRIM3R_TOOLS_VIEWER_ZLIB_H

#include "mcap/crc32.h"

static inline uint32_t crc32_z(uint32_t crc, const void *bytes, size_t count)
{
    return t3r_crc32(crc, bytes, count);
}

#endif
