/* SPDX-License-Identifier: Apache-2.0 */
/* Shared by writer and reader of MCAP files: the magic and the records' opcodes (mcap.dev/spec). */
#ifndef T3R_PLATFORM_MCAP_H
#define T3R_PLATFORM_MCAP_H

#define T3R_MCAP_MAGIC "\x89MCAP0\r\n"
#define T3R_MCAP_MAGIC_BYTES 8u
#define T3R_MCAP_RECORD_HEAD_BYTES 9u /* opcode, 64-bit length */

typedef enum t3r_mcap_opcode {
    T3R_MCAP_HEADER = 0x01,
    T3R_MCAP_FOOTER = 0x02,
    T3R_MCAP_SCHEMA = 0x03,
    T3R_MCAP_CHANNEL = 0x04,
    T3R_MCAP_MESSAGE = 0x05,
    T3R_MCAP_CHUNK = 0x06,
    T3R_MCAP_MESSAGE_INDEX = 0x07,
    T3R_MCAP_CHUNK_INDEX = 0x08,
    T3R_MCAP_ATTACHMENT = 0x09,
    T3R_MCAP_ATTACHMENT_INDEX = 0x0a,
    T3R_MCAP_STATISTICS = 0x0b,
    T3R_MCAP_METADATA = 0x0c,
    T3R_MCAP_METADATA_INDEX = 0x0d,
    T3R_MCAP_SUMMARY_OFFSET = 0x0e,
    T3R_MCAP_DATA_END = 0x0f
} t3r_mcap_opcode;

#endif
