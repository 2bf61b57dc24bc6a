/* SPDX-License-Identifier: Apache-2.0 */
/* The limits of all readers. Build, eval and replay can use whatever import accepts, and no file demands more work or
 * memory than its frames justify. SECURITY.md lists the limits by reader. They are plain integers, so that messages can
 * print them. */
#ifndef T3R_PLATFORM_READER_LIMITS_H
#define T3R_PLATFORM_READER_LIMITS_H

#include <stdint.h>

#include "trim3r.h"

#define T3R_LIMIT_TEXT_OF(number) #number
#define T3R_LIMIT_TEXT(before, number, behind) before T3R_LIMIT_TEXT_OF(number) behind

/* ---- ranges of the runtime's fixed point: cameras and depth ---- */

#define T3R_LIMIT_FOCAL_LEAST 8 /* pixels: least focal length */
#define T3R_LIMIT_PIXELS 16384  /* pixels: focal lengths, |cx| and |cy| are below it */
#define T3R_LIMIT_DISTORTION 128
#define T3R_LIMIT_TANGENTIAL 16    /* |p1|, |p2| of radial-tangential distortion */
#define T3R_LIMIT_POSITION_LOG2 30 /* |x|, |y|, |z| below 2^30 world units */
#define T3R_LIMIT_DEPTH_UNIT 128   /* world units per step: below it, and at least 2^-40 */

/* ---- counts ---- */

#define T3R_LIMIT_FRAMES 100000         /* in a folder */
#define T3R_LIMIT_TRIPLETS 1048576      /* in a folder or a recording */
#define T3R_LIMIT_POSES 2097152         /* in a trajectory */
#define T3R_LIMIT_PICTURES 1000000      /* lines in a list of pictures */
#define T3R_LIMIT_JSON_VALUES 3000000   /* in a JSON text; each takes up to 144 bytes of memory with its key and text */
#define T3R_LIMIT_JPEG_SCANS 32         /* cameras and programs write about 10 */
#define T3R_LIMIT_VIEWS_OF_POINTS 1000  /* pointmaps in a file */
#define T3R_LIMIT_TRANSFORM_FRAMES 1024 /* frames named by the transforms of a bag */
#define T3R_LIMIT_TRANSFORM_DEPTH 64    /* longest chain of such transforms */

/* ---- bytes ---- */

#define T3R_LIMIT_TEXT_BYTES (UINT32_C(64) << 20) /* transforms.json, a list, a trajectory, a table */

#define T3R_LIMIT_MODEL_BYTES (256 << 20) /* a text file of COLMAP, which is read line by line */

/* Compressed data may decompress to this many bytes, plus this many per compressed byte. Camera pictures shrink at most
 * tenfold without loss, so a higher ratio deserves no more memory. */
#define T3R_LIMIT_UNPACKED_FREE (UINT64_C(128) << 20)
#define T3R_LIMIT_UNPACKED_RATIO 32

/* A recording with compressed chunks that is read from memory, not from a file, may take this many bytes of memory,
 * including its own. A message in such chunks counts for its data, its entry in the index, once more while that is
 * sorted, and its link to its frame. */
#define T3R_LIMIT_UNPACKED_WHOLE (UINT64_C(320) << 20)
#define T3R_LIMIT_MESSAGE_BYTES 160

/* A recording in a file keeps this much of its decompressed chunks in memory, and this much of its index. Chunks beyond
 * that go to the disk (spill.h), limited by T3R_LIMIT_UNPACKED_RATIO only; so does a file that is larger than the first
 * limit. */
#define T3R_LIMIT_UNPACKED_HEAP (UINT64_C(128) << 20)
#define T3R_LIMIT_INDEX_BYTES (UINT64_C(192) << 20)

/* A compressed scene of any size may hold this many Gaussians, and beyond that one per this many bytes. Real ones take
 * ten bytes and more each. */
#define T3R_LIMIT_GAUSSIANS_FREE 524288
#define T3R_LIMIT_GAUSSIAN_BYTES 4

static inline uint64_t t3r_limit_gaussians(uint64_t packed_bytes)
{
    const uint64_t most = T3R_LIMIT_GAUSSIANS_FREE + packed_bytes / T3R_LIMIT_GAUSSIAN_BYTES;
    return most < T3R_MAX_GAUSSIANS ? most : T3R_MAX_GAUSSIANS;
}

static inline uint64_t t3r_limit_unpacked(uint64_t packed_bytes)
{
    return packed_bytes > (UINT64_MAX - T3R_LIMIT_UNPACKED_FREE) / T3R_LIMIT_UNPACKED_RATIO
               ? UINT64_MAX
               : T3R_LIMIT_UNPACKED_FREE + T3R_LIMIT_UNPACKED_RATIO * packed_bytes;
}

/* Returns the limit for a file that is held in memory as a whole, both compressed and decompressed. */
static inline uint64_t t3r_limit_unpacked_whole(uint64_t packed_bytes)
{
    const uint64_t left = packed_bytes < T3R_LIMIT_UNPACKED_WHOLE ? T3R_LIMIT_UNPACKED_WHOLE - packed_bytes : 0;
    const uint64_t most = t3r_limit_unpacked(packed_bytes);
    return most < left ? most : left;
}

#endif
