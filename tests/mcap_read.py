# SPDX-License-Identifier: Apache-2.0
"""Reads MCAP records and the few ROS 2 messages that these tests need; written from the formats' documentation."""
import struct


def whole_records(data, at):
    """Yields (opcode, content) of whole records from `at` on, including those in uncompressed chunks."""
    while at + 9 <= len(data) and data[at:at + 8] != b"\x89MCAP0\r\n":
        opcode, size = struct.unpack_from("<BQ", data, at)
        content = data[at + 9:at + 9 + size]
        if opcode == 0x06:
            assert content[28:32] == bytes(4), "compressed"
            yield from whole_records(content, 40)
        elif at + 9 + size <= len(data):
            yield opcode, content
        at += 9 + size


def records(data):
    """Yields (opcode, content) of whole records; a file may be truncated."""
    assert data[:8] == b"\x89MCAP0\r\n"
    return whole_records(data, 8)


def text(data, at):
    count, = struct.unpack_from("<I", data, at)
    return data[at + 4:at + 4 + count].decode(), at + 4 + count


def messages(data):
    """Yields (topic, log time, message) in the file's order."""
    topics = {}
    for opcode, content in records(data):
        if opcode == 0x04:
            number, _ = struct.unpack_from("<HH", content)
            topics[number] = text(content, 4)[0]
        elif opcode == 0x05:
            number, _, log_ns, _ = struct.unpack_from("<HIQQ", content)
            yield topics[number], log_ns, content[22:]


class Cdr:
    def __init__(self, data):
        self.data, self.at = data[4:], 0

    def number(self, kind):
        size = struct.calcsize(kind)
        self.at = (self.at + size - 1) // size * size
        value, = struct.unpack_from("<" + kind, self.data, self.at)
        self.at += size
        return value

    def string(self):
        count = self.number("I")
        value = self.data[self.at:self.at + count - 1].decode()
        self.at += count
        return value


def stamp(cdr):
    return cdr.number("i") * 10**9 + cdr.number("I")


def pose(message):
    """stamp in ns, [x y z qx qy qz qw]"""
    cdr = Cdr(message)
    when = stamp(cdr)
    cdr.string()
    return when, [cdr.number("d") for _ in range(7)]


def log(message):
    """stamp in ns, level, text"""
    cdr = Cdr(message)
    when, level = stamp(cdr), cdr.number("B")
    cdr.string()
    return when, level, cdr.string()


def image(message):
    """height, width, encoding, samples"""
    cdr = Cdr(message)
    stamp(cdr)
    cdr.string()
    height, width, encoding = cdr.number("I"), cdr.number("I"), cdr.string()
    cdr.number("B")
    cdr.number("I")
    count = cdr.number("I")
    return height, width, encoding, cdr.data[cdr.at:cdr.at + count]
