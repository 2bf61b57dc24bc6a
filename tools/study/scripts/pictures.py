# SPDX-License-Identifier: Apache-2.0
"""PNG pictures as rows of bytes: read, made smaller, put side by side, written. It needs no package."""
import struct
import zlib

SIGNATURE = b"\x89PNG\r\n\x1a\n"
CHANNELS = {0: 1, 2: 3}  # by the colour type of PNG: grey and RGB


class Picture:
    """Rows of 8-bit samples."""

    def __init__(self, rows, channels=3):
        self.rows, self.channels = rows, channels
        self.width, self.height = len(rows[0]) // channels, len(rows)


def read_png(path):
    """Returns a picture of 8-bit RGB or grey without interlacing."""
    with open(path, "rb") as file:
        data = file.read()
    if data[:8] != SIGNATURE:
        raise ValueError(f"{path} is not a PNG")
    at, packed = 8, b""
    while at < len(data):
        size, kind = struct.unpack(">I4s", data[at:at + 8])
        body = data[at + 8:at + 8 + size]
        if kind == b"IHDR":
            width, height, bits, colour, _, _, interlace = struct.unpack(">IIBBBBB", body)
            if bits != 8 or interlace != 0 or colour not in CHANNELS:
                raise ValueError(f"{path} is not plain 8-bit RGB or grey")
        elif kind == b"IDAT":
            packed += body
        at += size + 12
    channels = CHANNELS[colour]
    return Picture(unfiltered(zlib.decompress(packed), width * channels, height, channels), channels)


def unfiltered(raw, stride, height, step):
    """Returns the rows, each row's filter undone; step: bytes of a pixel."""
    rows, above = [], bytes(stride)
    for y in range(height):
        kind, row = raw[y * (stride + 1)], bytearray(raw[y * (stride + 1) + 1:(y + 1) * (stride + 1)])
        for x in range(stride if kind else 0):
            left, corner = (row[x - step], above[x - step]) if x >= step else (0, 0)
            row[x] = (row[x] + predicted(kind, left, above[x], corner)) & 255
        rows.append(bytes(row))
        above = row
    return rows


def predicted(kind, left, up, corner):
    if kind == 4:
        guess = left + up - corner
        return min((left, up, corner), key=lambda value: abs(guess - value))
    return (0, left, up, (left + up) // 2)[kind]


def filtered(row, above, step):
    """Returns the row by the filter that leaves the smallest bytes: by then zlib packs it best."""
    left = bytes(step) + row[:-step]
    corner = bytes(step) + above[:-step]
    made = [bytes([kind]) + bytes((value - predicted(kind, *near)) & 255 for value, *near in zip(row, left, above, corner))
            for kind in (1, 2, 3, 4)]
    return min(made, key=lambda line: sum(min(value, 256 - value) for value in line[1:]))


def write_png(path, picture):
    def chunk(kind, body):
        return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))

    raw, above = b"", bytes(len(picture.rows[0]))
    for row in picture.rows:
        raw += filtered(row, above, picture.channels)
        above = row
    header = struct.pack(">IIBBBBB", picture.width, picture.height, 8, 2, 0, 0, 0)
    with open(path, "wb") as file:
        file.write(SIGNATURE + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(raw, 9)) + chunk(b"IEND", b""))


def smaller(picture, width):
    """Returns the picture at most so wide; each pixel is the mean of those that it replaces."""
    if picture.width <= width:
        return picture
    height = max(1, picture.height * width // picture.width)
    columns = [range(x * picture.width // width, (x + 1) * picture.width // width) for x in range(width)]
    rows = []
    for y in range(height):
        lines = picture.rows[y * picture.height // height:(y + 1) * picture.height // height]
        row = bytearray()
        for across in columns:
            for channel in range(picture.channels):
                values = [line[x * picture.channels + channel] for line in lines for x in across]
                row.append((sum(values) + len(values) // 2) // len(values))
        rows.append(bytes(row))
    return Picture(rows, picture.channels)


def coarser(picture, step):
    """Returns the picture with its samples rounded to multiples of a step."""
    rounded = bytes(min(255, (value + step // 2) // step * step) for value in range(256))
    return Picture([row.translate(rounded) for row in picture.rows], picture.channels)


def beside(pictures, gap):
    """Returns RGB pictures of one height side by side, white between them."""
    return Picture([(b"\xff" * 3 * gap).join(picture.rows[y] for picture in pictures) for y in range(pictures[0].height)])
