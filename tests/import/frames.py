# SPDX-License-Identifier: Apache-2.0
"""Frames of a recording as arrays, and pictures as files, for the scripts of this folder. Needs numpy."""

import struct

import numpy as np

import mcap_read
from png import png


class Cdr:
    def __init__(self, data):
        self.data, self.at = data[4:], 0

    def take(self, form):
        size = struct.calcsize("<" + form)
        self.at += -self.at % size
        self.at += size
        return struct.unpack_from("<" + form, self.data, self.at - size)[0]

    def text(self):
        length = self.take("I")
        self.at += length
        return self.data[self.at - length:self.at - 1].decode()

    def header(self):
        self.take("i"), self.take("I"), self.text()


def image(data):
    c = Cdr(data)
    c.header()
    height, width = c.take("I"), c.take("I")
    encoding = c.text()
    c.take("B"), c.take("I")
    length = c.take("I")
    raw = c.data[c.at:c.at + length]
    if encoding == "16UC1":
        return np.frombuffer(raw, "<u2").reshape(height, width)
    return np.frombuffer(raw, np.uint8).reshape(height, width, 3)


def pose(data):
    c = Cdr(data)
    c.header()
    x, y, z, qx, qy, qz, qw = (c.take("d") for _ in range(7))
    return matrix((qw, qx, qy, qz), (x, y, z))


def intrinsics(data):
    c = Cdr(data)
    c.header()
    c.take("I"), c.take("I"), c.text()
    for _ in range(c.take("I")):
        c.take("d")
    return np.array([c.take("d") for _ in range(9)]).reshape(3, 3)


def matrix(q, t):
    w, x, y, z = np.array(q) / np.linalg.norm(q)
    m = np.eye(4)
    m[:3, :3] = [[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                 [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                 [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]]
    m[:3, 3] = t
    return m


def read(path):
    """Returns {topic: [message, ...]} of a recording without compression."""
    with open(path, "rb") as file:
        data = file.read()
    out, readers = {}, {"image": image, "depth": image, "pose": pose, "camera_info": intrinsics}
    for topic, _, message in mcap_read.messages(data):
        name = topic.split("/")[-1]
        if name in readers:
            out.setdefault(name, []).append(readers[name](message))
    return out


def picture(pixels):
    """8-bit RGB or 16-bit grey as a PNG."""
    if pixels.ndim == 2:
        return png([row.astype(">u2").tobytes() for row in pixels], 16, 1)
    return png([row.tobytes() for row in pixels])


def exr(numbers):
    """Writes OpenEXR of one channel, half or float like the array, as lines without compression."""
    height, width = numbers.shape
    half = numbers.dtype == np.float16

    def attribute(name, kind, content):
        return name.encode() + b"\0" + kind.encode() + b"\0" + struct.pack("<I", len(content)) + content

    window = struct.pack("<4i", 0, 0, width - 1, height - 1)
    header = (b"\x76\x2f\x31\x01\x02\0\0\0"
              + attribute("channels", "chlist", b"R\0" + struct.pack("<iIii", 1 if half else 2, 0, 1, 1) + b"\0")
              + attribute("compression", "compression", b"\0") + attribute("dataWindow", "box2i", window)
              + attribute("displayWindow", "box2i", window) + attribute("lineOrder", "lineOrder", b"\0")
              + attribute("pixelAspectRatio", "float", struct.pack("<f", 1))
              + attribute("screenWindowCenter", "v2f", bytes(8)) + attribute("screenWindowWidth", "float", struct.pack("<f", 1))
              + b"\0")
    lines = [struct.pack("<iI", y, row.nbytes) + row.tobytes() for y, row in enumerate(numbers)]
    first = len(header) + 8 * height
    return header + struct.pack(f"<{height}Q", *(first + y * len(lines[0]) for y in range(height))) + b"".join(lines)
