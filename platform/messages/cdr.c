#include "cdr.h"

#include "core/little_endian.h"

#define ENCAPSULATION_BYTES 4u

/* Returns the `size` bytes at the next multiple of `size`, or NULL; size is a power of two. */
static const uint8_t *take_aligned(t3r_cdr_reader *reader, size_t size)
{
    size_t padding = (size - (reader->at - ENCAPSULATION_BYTES) % size) % size;
    if (reader->failed || reader->count - reader->at < padding + size) {
        reader->failed = true;
        return NULL;
    }
    const uint8_t *bytes = reader->bytes + reader->at + padding;
    reader->at += padding + size;
    return bytes;
}

static const uint8_t *take_raw(t3r_cdr_reader *reader, uint32_t count)
{
    if (reader->failed || reader->count - reader->at < count) {
        reader->failed = true;
        return NULL;
    }
    const uint8_t *bytes = reader->bytes + reader->at;
    reader->at += count;
    return bytes;
}

void t3r_cdr_open(t3r_cdr_reader *reader, const uint8_t *bytes, size_t count)
{
    /* Byte 0 is zero and byte 1 the representation: 0 = CDR big-endian, 1 = CDR little-endian. */
    bool plain = count >= ENCAPSULATION_BYTES && bytes[0] == 0 && bytes[1] <= 1;
    *reader = (t3r_cdr_reader){
        .bytes = bytes,
        .count = count,
        .at = plain ? ENCAPSULATION_BYTES : count,
        .big_endian = plain && bytes[1] == 0,
        .failed = !plain,
    };
}

uint8_t t3r_cdr_get_u8(t3r_cdr_reader *reader)
{
    const uint8_t *bytes = take_aligned(reader, 1);
    return bytes == NULL ? 0 : bytes[0];
}

uint32_t t3r_cdr_get_u32(t3r_cdr_reader *reader)
{
    const uint8_t *bytes = take_aligned(reader, 4);
    const uint32_t value = bytes == NULL ? 0 : t3r_load_le32(bytes);
    return reader->big_endian ? __builtin_bswap32(value) : value;
}

uint64_t t3r_cdr_get_u64(t3r_cdr_reader *reader)
{
    const uint8_t *bytes = take_aligned(reader, 8);
    const uint64_t value = bytes == NULL ? 0 : t3r_load_le64(bytes);
    return reader->big_endian ? __builtin_bswap64(value) : value;
}

t3r_text t3r_cdr_get_string(t3r_cdr_reader *reader)
{
    uint32_t count = t3r_cdr_get_u32(reader); /* includes the terminating zero */
    const uint8_t *bytes = take_raw(reader, count);
    if (bytes == NULL || count == 0) {
        return (t3r_text){"", 0};
    }
    if (bytes[count - 1] != 0) {
        reader->failed = true;
        return (t3r_text){"", 0};
    }
    return (t3r_text){(const char *)bytes, count - 1};
}

const uint8_t *t3r_cdr_get_bytes(t3r_cdr_reader *reader, uint32_t *count)
{
    uint32_t announced = t3r_cdr_get_u32(reader);
    const uint8_t *bytes = take_raw(reader, announced);
    *count = bytes == NULL ? 0 : announced;
    return bytes;
}

void t3r_cdr_put_raw(t3r_cdr_writer *writer, const void *bytes, size_t count)
{
    if (!writer->failed && writer->sink.write != NULL && count > 0) {
        writer->failed = writer->sink.write(writer->sink.user, bytes, count) != 0;
    }
    writer->at += count;
}

static void put_padding(t3r_cdr_writer *writer, size_t size)
{
    static const uint8_t zeros[8] = {0};
    t3r_cdr_put_raw(writer, zeros, (size - (writer->at - ENCAPSULATION_BYTES) % size) % size);
}

void t3r_cdr_begin(t3r_cdr_writer *writer, t3r_sink sink)
{
    static const uint8_t little_endian[ENCAPSULATION_BYTES] = {0, 1, 0, 0};
    *writer = (t3r_cdr_writer){.sink = sink};
    t3r_cdr_put_raw(writer, little_endian, sizeof little_endian);
}

void t3r_cdr_put_u8(t3r_cdr_writer *writer, uint8_t x)
{
    t3r_cdr_put_raw(writer, &x, 1);
}

void t3r_cdr_put_u32(t3r_cdr_writer *writer, uint32_t x)
{
    uint8_t bytes[4];
    t3r_store_le32(bytes, x);
    put_padding(writer, 4);
    t3r_cdr_put_raw(writer, bytes, 4);
}

void t3r_cdr_put_u64(t3r_cdr_writer *writer, uint64_t x)
{
    uint8_t bytes[8];
    t3r_store_le64(bytes, x);
    put_padding(writer, 8);
    t3r_cdr_put_raw(writer, bytes, 8);
}

void t3r_cdr_put_string(t3r_cdr_writer *writer, t3r_text text)
{
    t3r_cdr_put_u32(writer, (uint32_t)text.count + 1);
    t3r_cdr_put_raw(writer, text.chars, text.count);
    t3r_cdr_put_u8(writer, 0);
}
