/* SPDX-License-Identifier: Apache-2.0 */
/* Numbers as bytes: little-endian on every machine, and their hash. */
#include "unit/unit.h"

#include "core/hash.h"
#include "core/little_endian.h"

TEST(read)
{
    static const uint8_t bytes[] = {0x01, 0x82, 0x03, 0x84, 0x05, 0x86, 0x07, 0x88};
    assert_int_equal(t3r_load_le16(bytes), 0x8201);
    assert_int_equal(t3r_load_le16(bytes + 1), 0x0382);
    assert_int_equal(t3r_load_le32(bytes), 0x84038201);
    assert_int_equal(t3r_load_le64(bytes), UINT64_C(0x8807860584038201));
    static const uint8_t ones[] = {0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff};
    assert_int_equal(t3r_load_le16(ones), 0xffff);
    assert_int_equal(t3r_load_le32(ones), UINT32_MAX);
    assert_int_equal(t3r_load_le64(ones), UINT64_MAX);
}

TEST(write)
{
    uint8_t bytes[8] = {0};
    t3r_store_le16(bytes + 1, 0x8201);
    const uint8_t two[8] = {0, 0x01, 0x82};
    assert_memory_equal(bytes, two, sizeof two);
    t3r_store_le32(bytes + 3, 0x86058403);
    const uint8_t six[8] = {0, 0x01, 0x82, 0x03, 0x84, 0x05, 0x86};
    assert_memory_equal(bytes, six, sizeof six);
    t3r_store_le64(bytes, UINT64_C(0x8807860584038201));
    const uint8_t eight[8] = {0x01, 0x82, 0x03, 0x84, 0x05, 0x86, 0x07, 0x88};
    assert_memory_equal(bytes, eight, sizeof eight);
}

TEST(table_in_place)
{
    static _Alignas(int16_t) const uint8_t bytes[] = {0x01, 0x82, 0xfe, 0x7f};
    const t3r_le16 *table = (const void *)bytes;
    assert_int_equal(t3r_from_le16(table[0]), INT16_MIN + 0x201);
    assert_int_equal(t3r_from_le16(table[1]), 0x7ffe);
}

/* The vectors of FNV-1a's authors. */
TEST(hash_of_text)
{
    static const uint8_t text[] = "foobar";
    assert_int_equal(t3r_hash_bytes(T3R_HASH_START, text, 0), UINT64_C(0xcbf29ce484222325));
    assert_int_equal(t3r_hash_u8(T3R_HASH_START, 'a'), UINT64_C(0xaf63dc4c8601ec8c));
    assert_int_equal(t3r_hash_bytes(T3R_HASH_START, text, 1), UINT64_C(0xaf63db4c8601ead9));
    assert_int_equal(t3r_hash_bytes(T3R_HASH_START, text, 6), UINT64_C(0x85944171f73967e8));
}

/* A number is hashed as its bytes, lowest first. */
TEST(hash_of_numbers)
{
    static const uint8_t bytes[] = {0x01, 0x82, 0x03, 0x84, 0x05, 0x86, 0x07, 0x88};
    const uint16_t values[] = {0x8201, 0x8403, 0x8605, 0x8807};
    const uint64_t start = t3r_hash_u8(T3R_HASH_START, 7);
    for (size_t count = 0; count <= 4; count++) {
        assert_int_equal(t3r_hash_u16s(start, values, count), t3r_hash_bytes(start, bytes, 2 * count));
    }
    assert_int_equal(t3r_hash_u16(start, 0x8201), t3r_hash_bytes(start, bytes, 2));
    assert_int_equal(t3r_hash_u32(start, 0x84038201), t3r_hash_bytes(start, bytes, 4));
    assert_int_equal(t3r_hash_u64(start, UINT64_C(0x8807860584038201)), t3r_hash_bytes(start, bytes, 8));
}
