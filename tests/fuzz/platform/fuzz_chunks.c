/* SPDX-License-Identifier: Apache-2.0 */
/* A recording with one compressed chunk: a byte names the codec, four bytes give the unpacked size, the rest is
 * compressed data. Gives an error, or frames that can be read. */
#include <stdlib.h>
#include <string.h>

#include "core/little_endian.h"
#include "mcap/mcap.h"
#include "recording/recording.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static size_t put(uint8_t *to, size_t at, const void *bytes, size_t count)
{
    memcpy(to + at, bytes, count);
    return at + count;
}

static size_t put_le(uint8_t *to, size_t at, uint64_t value, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        to[at + i] = (uint8_t)(value >> (8 * i));
    }
    return at + count;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    enum { CHOICE = 5, AROUND = 128 };
    if (size < CHOICE) {
        return 0;
    }
    const char *codec = data[0] % 2 == 0 ? "zstd" : "lz4";
    size_t packed = size - CHOICE, name = strlen(codec), at = 0;
    uint8_t *file = malloc(AROUND + size);
    at = put(file, at, T3R_MCAP_MAGIC, T3R_MCAP_MAGIC_BYTES);
    at = put_le(file, at, T3R_MCAP_HEADER, 1);
    at = put_le(file, at, 8, 8);
    at = put_le(file, at, 0, 8); /* two empty texts */
    at = put_le(file, at, T3R_MCAP_CHUNK, 1);
    at = put_le(file, at, 8 + 8 + 8 + 4 + 4 + name + 8 + packed, 8);
    at = put_le(file, at, 0, 8);
    at = put_le(file, at, 0, 8); /* times */
    at = put_le(file, at, t3r_load_le32(data + 1), 8);
    at = put_le(file, at, 0, 4); /* no CRC */
    at = put_le(file, at, name, 4);
    at = put(file, at, codec, name);
    at = put_le(file, at, packed, 8);
    at = put(file, at, data + CHOICE, packed);
    char error[256] = "";
    t3r_recording *recording = t3r_recording_parse(file, at, error, sizeof error);
    if ((recording == NULL) != (error[0] != '\0')) {
        abort();
    }
    for (uint32_t i = 0; recording != NULL && i < t3r_recording_frame_count(recording); i++) {
        t3r_capture_frame frame;
        if (t3r_recording_frame(recording, i, &frame, error, sizeof error) == T3R_CAPTURE_FRAME &&
            (frame.frame.width < 2 || frame.frame.planes[0] == NULL)) {
            abort();
        }
    }
    t3r_recording_close(recording);
    free(file);
    return 0;
}
