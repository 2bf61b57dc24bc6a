/* The limits of all readers: what import takes, build, eval and replay can use, and no file asks for more work or
 * memory than its frames justify. SECURITY.md lists them by reader. Plain integers, so that messages name them, too. */
#ifndef T3R_PLATFORM_READER_LIMITS_H
#define T3R_PLATFORM_READER_LIMITS_H

#include <stdint.h>

#include "trim3r.h"

#define T3R_LIMIT_TEXT_OF(number) #number
#define T3R_LIMIT_TEXT(before, number, behind) before T3R_LIMIT_TEXT_OF(number) behind

/* ---- of what the runtime takes: cameras and depth in its fixed point ---- */

#define T3R_LIMIT_FOCAL_LEAST 8 /* pixels: focal lengths are from here ... */
#define T3R_LIMIT_PIXELS 16384  /* ... to below this, |cx| and |cy| below it */
#define T3R_LIMIT_DISTORTION 128
#define T3R_LIMIT_TANGENTIAL 16    /* |p1|, |p2| of radial-tangential distortion */
#define T3R_LIMIT_POSITION_LOG2 30 /* |x|, |y|, |z| below 2^30 world units */
#define T3R_LIMIT_DEPTH_UNIT 128   /* world units a step: below it, and 2^-40 or more */

/* ---- of how many ---- */

#define T3R_LIMIT_FRAMES 100000         /* of a folder */
#define T3R_LIMIT_TRIPLETS 1048576      /* of a folder or a recording */
#define T3R_LIMIT_POSES 2097152         /* of a trajectory */
#define T3R_LIMIT_PICTURES 1000000      /* lines of a list of pictures */
#define T3R_LIMIT_JSON_VALUES 3000000   /* of a JSON text: each takes up to 144 bytes of memory with its key and text */
#define T3R_LIMIT_JPEG_SCANS 32         /* cameras and programs write 10 or so */
#define T3R_LIMIT_VIEWS_OF_POINTS 1000  /* pointmaps in a file */
#define T3R_LIMIT_TRANSFORM_FRAMES 1024 /* frames that the transforms of a bag name ... */
#define T3R_LIMIT_TRANSFORM_DEPTH 64    /* ... and of these one above the other */

/* ---- of bytes ---- */

#define T3R_LIMIT_TEXT_BYTES (UINT32_C(64) << 20) /* of transforms.json, a list, a trajectory, a table */

#define T3R_LIMIT_MODEL_BYTES (256 << 20) /* of a text of COLMAP, which is read line by line */

/* Compressed data may become this many bytes, whatever they are, and this many for each of theirs. Pictures of cameras
 * become at most ten times smaller without loss; what packs better is worth no more memory. */
#define T3R_LIMIT_UNPACKED_FREE (UINT64_C(128) << 20)
#define T3R_LIMIT_UNPACKED_RATIO 32

/* A recording with compressed chunks that is not read from a file, but from memory, is held to this many bytes in
 * memory, its own among them. Each message in those chunks counts for more than its data: its entry in the index, once
 * more while that is sorted, and what links it to its frame. */
#define T3R_LIMIT_UNPACKED_WHOLE (UINT64_C(320) << 20)
#define T3R_LIMIT_MESSAGE_BYTES 160

/* A recording in a file keeps this much of what its chunks unpack to in memory, and this much of its index; what goes
 * beyond the first lies on the disk (spill.h), where it is held to T3R_LIMIT_UNPACKED_RATIO alone. So does a file that
 * is larger than the first. */
#define T3R_LIMIT_UNPACKED_HEAP (UINT64_C(128) << 20)
#define T3R_LIMIT_INDEX_BYTES (UINT64_C(192) << 20)

/* A compressed scene may hold this many Gaussians, whatever its size, and beyond that one for so many of its bytes.
 * Real ones take ten bytes and more. */
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

/* Of a file that stays in memory as a whole, packed and unpacked. */
static inline uint64_t t3r_limit_unpacked_whole(uint64_t packed_bytes)
{
    const uint64_t left = packed_bytes < T3R_LIMIT_UNPACKED_WHOLE ? T3R_LIMIT_UNPACKED_WHOLE - packed_bytes : 0;
    const uint64_t most = t3r_limit_unpacked(packed_bytes);
    return most < left ? most : left;
}

#endif
