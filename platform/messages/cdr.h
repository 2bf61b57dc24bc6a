/* SPDX-License-Identifier: Apache-2.0 */
/* CDR, the wire format of ROS 2 messages (XCDR version 1, plain): read in either byte order, written little-endian.
 *
 * Every number is aligned to its size, counted from the end of the 4-byte encapsulation header. */
#ifndef T3R_PLATFORM_CDR_H
#define T3R_PLATFORM_CDR_H

#include <stdbool.h>
#include <stdint.h>

#include "host/sink.h"
#include "host/text.h"

/* ---- reading: the first read past the end, or the first malformed field, sets `failed`; later reads give zeros */

typedef struct t3r_cdr_reader {
    const uint8_t *bytes;
    size_t count, at;
    bool big_endian, failed;
} t3r_cdr_reader;

/* Takes the encapsulation header; fails for anything but plain CDR. */
void t3r_cdr_open(t3r_cdr_reader *reader, const uint8_t *bytes, size_t count);
uint8_t t3r_cdr_get_u8(t3r_cdr_reader *reader);
uint32_t t3r_cdr_get_u32(t3r_cdr_reader *reader);
uint64_t t3r_cdr_get_u64(t3r_cdr_reader *reader);
/* Returns a string without its terminating zero byte, which must be present. */
t3r_text t3r_cdr_get_string(t3r_cdr_reader *reader);
/* Returns the bytes of a sequence<uint8>, inside the message. */
const uint8_t *t3r_cdr_get_bytes(t3r_cdr_reader *reader, uint32_t *count);

/* ---- writing: with sink.write == NULL it only counts, for a message's size */

typedef struct t3r_cdr_writer {
    t3r_sink sink;
    size_t at;   /* bytes so far, with the encapsulation header */
    bool failed; /* the sink failed */
} t3r_cdr_writer;

void t3r_cdr_begin(t3r_cdr_writer *writer, t3r_sink sink);
void t3r_cdr_put_u8(t3r_cdr_writer *writer, uint8_t x);
void t3r_cdr_put_u32(t3r_cdr_writer *writer, uint32_t x);
void t3r_cdr_put_u64(t3r_cdr_writer *writer, uint64_t x);
void t3r_cdr_put_string(t3r_cdr_writer *writer, t3r_text text);
/* Writes bytes without alignment or count: the content of a sequence<uint8> whose count has been written. bytes may be
 * NULL when only counting. */
void t3r_cdr_put_raw(t3r_cdr_writer *writer, const void *bytes, size_t count);

#endif
