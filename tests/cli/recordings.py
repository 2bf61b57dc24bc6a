#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""recordings.py TRIM3R: files that are no recordings, truncated recordings, recordings without depth."""
import json
import os
import struct
import sys
import zlib

from program import expect, in_scratch, room, write


def png(width, height):
    """Returns a grey-brown RGB picture as PNG."""
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    rows = b"".join(b"\0" + bytes((120, 110, 100)) * width for _ in range(height))
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0))
            + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))


POSE = {"fl_x": 220, "w": 64, "h": 48, "transform_matrix": [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]}


def recordings():
    recording = room()
    expect(0, "build", recording, "--keep", 10, "-o", "scene.ply")
    whole = open(recording, "rb").read()
    bad = {
        "empty.mcap": b"",
        "magic.mcap": b"RIFF" + whole[4:],
        "text.mcap": b"hello, world\n" * 99,
        "short.mcap": whole[:7],
    }
    for name, content in bad.items():
        write(name, content)
        for command in (["build", name, "--keep", 10, "-o", "s.ply"], ["replay", name], ["info", name],
                        ["render", "scene.ply", name, "--view", 0, "-o", "v.png"]):
            expect(1, *command, err=name)
    for command in (["build", "absent.mcap", "--keep", 10, "-o", "s.ply"], ["replay", "absent.mcap"],
                    ["info", "absent.mcap"], ["eval", "absent.mcap", "--keep", 10]):
        expect(1, *command, err="absent.mcap")
    expect(1, "replay", ".", err=".")
    if os.geteuid() != 0:
        write("locked.mcap", whole)
        os.chmod("locked.mcap", 0)
        expect(1, "replay", "locked.mcap", err="locked.mcap")
    # a truncated recording holds fewer frames, and says so when asked for more
    write("cut.mcap", whole[:len(whole) // 2])
    expect(1, "build", "cut.mcap", "--keep", 10, "--context", "0,5", "-o", "s.ply", err="cut.mcap")
    os.mkdir("flat")
    write("flat/a.png", png(64, 48))
    write("flat/transforms.json", json.dumps({"frames": [dict(POSE, file_path="a.png")]}))
    expect(1, "import", "absent", "-o", "flat.mcap", err="absent")
    expect(0, "import", "flat", "-o", "flat.mcap")
    expect(1, "build", "flat.mcap", "--keep", 10, "-o", "s.ply", err="no depth")


sys.exit(in_scratch(recordings))
