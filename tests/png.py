# SPDX-License-Identifier: Apache-2.0
"""PNG files, made of their rows."""
import struct
import zlib


def chunk(kind, data, crc=None):
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data) if crc is None else crc)


def png(rows, bits=8, channels=3, level=-1):
    """A picture of grey, of red, green and blue, or of these and alpha, whose rows are bytes."""
    rows = list(rows)
    head = struct.pack(">IIBBBBB", len(rows[0]) * 8 // (bits * channels), len(rows), bits, {1: 0, 3: 2, 4: 6}[channels], 0, 0, 0)
    data = zlib.compress(b"".join(b"\0" + row for row in rows), level)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", data) + chunk(b"IEND", b"")
