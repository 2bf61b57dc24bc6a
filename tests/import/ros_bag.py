# SPDX-License-Identifier: Apache-2.0
"""Writes small bags: MCAP records and CDR messages as ROS 2 has them, and as it has not."""
import struct

import numpy as np

IMAGE, COMPRESSED, INFO = "sensor_msgs/msg/Image", "sensor_msgs/msg/CompressedImage", "sensor_msgs/msg/CameraInfo"
POSE, ODOMETRY, TF = "geometry_msgs/msg/PoseStamped", "nav_msgs/msg/Odometry", "tf2_msgs/msg/TFMessage"
WIDTH, HEIGHT, SECOND = 32, 24, 10**9
LENS = (30.0, 30.0, 15.5, 11.5)  # fx fy cx cy
UPRIGHT = (0, 0, 0, 1)  # x y z w


def text(words):
    data = words.encode()
    return struct.pack("<I", len(data)) + data


def record(opcode, body):
    return bytes([opcode]) + struct.pack("<Q", len(body)) + body


class Bag:
    """A file of one data section. Channels are made at their first message; `key` tells publishers of a topic apart."""

    def __init__(self, encoding="cdr"):
        self.encoding, self.records, self.schemas, self.channels = encoding, [], {}, {}

    def channel(self, topic, kind, key):
        if kind not in self.schemas:
            self.schemas[kind] = len(self.schemas) + 1
            self.records.append(record(3, struct.pack("<H", self.schemas[kind]) + text(kind) + text("ros2msg") + text("")))
        if (topic, key) not in self.channels:
            self.channels[topic, key] = len(self.channels) + 1
            self.records.append(record(4, struct.pack("<HH", self.channels[topic, key], self.schemas[kind]) + text(topic)
                                       + text(self.encoding) + bytes(4)))
        return self.channels[topic, key]

    def put(self, topic, kind, log_ns, message, key=0):
        self.records.append(record(5, struct.pack("<HIQQ", self.channel(topic, kind, key), 0, log_ns, log_ns) + message))

    def metadata(self, name, key, value):
        pairs = text(key) + text(value)
        self.records.append(record(12, text(name) + struct.pack("<I", len(pairs)) + pairs))

    def write(self, path):
        end = record(15, bytes(4)) + record(2, bytes(20)) + b"\x89MCAP0\r\n"
        with open(path, "wb") as file:
            file.write(b"\x89MCAP0\r\n" + record(1, text("ros2") + text("")) + b"".join(self.records) + end)


class Cdr:
    def __init__(self):
        self.data = b""

    def put(self, form, *values):
        for value in values:
            self.data += bytes(-len(self.data) % struct.calcsize(form)) + struct.pack("<" + form, value)
        return self

    def text(self, words):
        self.put("I", len(words) + 1).data += words.encode() + b"\0"
        return self

    def header(self, ns, frame):
        return self.put("i", ns // SECOND).put("I", ns % SECOND).text(frame)

    def rows(self, data):
        self.put("I", len(data)).data += data
        return self

    def done(self):
        return b"\0\1\0\0" + self.data


def image(ns, frame, encoding, rows, size=None):
    """rows: an array of bytes or numbers, whose first two sides are height and width unless `size` has these."""
    data = rows.tobytes()
    step = len(data) // rows.shape[0]
    return (Cdr().header(ns, frame).put("I", *(size or rows.shape[:2])).text(encoding).put("B", 0).put("I", step)
            .rows(data).done())


def compressed(ns, frame, form, data):
    return Cdr().header(ns, frame).text(form).rows(data).done()


def info(ns, frame, lens=LENS, size=(WIDTH, HEIGHT), d=(), model="plumb_bob", p=None):
    fx, fy, cx, cy = lens
    p = p or lens
    return (Cdr().header(ns, frame).put("I", size[1], size[0]).text(model).put("I", len(d)).put("d", *d)
            .put("d", fx, 0, cx, 0, fy, cy, 0, 0, 1).put("d", 1, 0, 0, 0, 1, 0, 0, 0, 1)
            .put("d", p[0], 0, p[2], 0, 0, p[1], p[3], 0, 0, 0, 1, 0).put("I", 0, 0, 0, 0, 0, 0).put("B", 0).done())


def pose(ns, frame, position, rotation=UPRIGHT):
    return Cdr().header(ns, frame).put("d", *position, *rotation).done()


def odometry(ns, frame, child, position):
    return Cdr().header(ns, frame).text(child).put("d", *position, *UPRIGHT, *[0] * 78).done()


def transforms(*edges):
    out = Cdr().put("I", len(edges))
    for ns, parent, child, position, rotation in edges:
        out.header(ns, parent).text(child).put("d", *position, *rotation)
    return out.done()


def colour(value):
    return np.full((HEIGHT, WIDTH, 3), value, np.uint8)


def steps(value, shape=(HEIGHT, WIDTH)):
    return np.full(shape, value, "<u2")
