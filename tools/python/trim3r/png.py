# SPDX-License-Identifier: Apache-2.0
"""Pictures as PNG, for notebooks."""
import struct
import zlib

import numpy as np
from numpy.typing import NDArray

_COLOUR_TYPES = {2: 0, 3: 2}  # of PNG, by the dimensions of an array: grey, RGB


def png_of(colour: "NDArray[np.uint8]") -> bytes:
    """The file of a picture of (H, W, 3) or (H, W)."""
    height, width = colour.shape[:2]
    rows = np.zeros((height, 1 + colour[0].size), dtype=np.uint8) # each after a byte of 0: no filter
    rows[:, 1:] = colour.reshape(height, -1)
    header = struct.pack(">IIBBBBB", width, height, 8, _COLOUR_TYPES[colour.ndim], 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + _chunk(b"IHDR", header) + _chunk(b"IDAT", zlib.compress(rows.tobytes())) + _chunk(b"IEND", b"")


def _chunk(kind: bytes, data: bytes) -> bytes:
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
