# SPDX-License-Identifier: Apache-2.0
"""Recordings that import accepts work in build, replay and eval: values on both sides of every limit of
platform/mcap/reader_limits.h, through the program.

limits.py TRIM3R
"""
import json
import math
import os
import struct
import tempfile

from checks import check, done
from png import png
from program import run

UNIT = [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]


def below(value):
    return math.nextafter(value, 0)


def slope(width, height, depth=False):
    """Returns a slope in grey steps, or of depth around 1000 steps."""
    row = b"".join(struct.pack(">H", 1000 + x % 64) if depth else bytes([x * 7 % 256, x * 3 % 256, 90])
                   for x in range(width))
    return png([row] * height, 16, 1) if depth else png([row] * height)


def folder(name, width=16, height=16, position=0.0, top=None):
    path = f"{work}/{name}"
    os.makedirs(path)
    with open(f"{path}/c.png", "wb") as file:
        file.write(slope(width, height))
    with open(f"{path}/d.png", "wb") as file:
        file.write(slope(width, height, depth=True))
    frames = []
    for i in range(3):
        pose = [row[:] for row in UNIT]
        pose[0][3] = position
        frames.append({"file_path": "c.png", "depth_path": "d.png", "transform_matrix": pose})
    lens = {"fl_x": 40, "cx": width / 2, "cy": height / 2, "integer_depth_scale": 0.001,
            "trim3r_triplets": [{"context": [0, 1], "target": 2}]}
    with open(f"{path}/transforms.json", "w", encoding="utf-8") as file:
        json.dump({**lens, **(top or {}), "frames": frames}, file)
    return path


def taken(what, path, *options):
    """Imports, and then runs every command that uses the recording."""
    recording, scene = f"{path}.mcap", f"{path}.ply"
    for command in (["import", path, "-o", recording, *options], ["info", recording],
                    ["build", recording, "--context", "0,1", "--gaussians", "20", "-o", scene],
                    ["replay", recording, "--context", "0,1", "--gaussians", "20"],
                    ["eval", recording, "--keep", "50"]):
        status, _, error = run(*command)
        check(status == 0, f"{what}: {command[0]} gave {status}: {error.strip()}")


def refused(what, path, why, *options):
    status, out, error = run("import", path, "-o", f"{path}.mcap", *options)
    check(status == 1 and out == "" and why in error, f"{what}: status {status}, '{error.strip()}' does not say '{why}'")
    check(not os.path.exists(f"{path}.mcap"), f"{what}: a recording was left behind")


def test_positions():
    far = 2.0**30
    for i, x in enumerate((below(far), -below(far), far / 2 + 0.3)):
        taken(f"position {x!r}", folder(f"position{i}", position=x))
    for i, x in enumerate((far, -far, 2.0**31 - 1, 1e300)):
        refused(f"position {x!r}", folder(f"far{i}", position=x), "a position is 2^30 or more")


def test_lenses():
    # the last value that rounds to a number below the limit: half a step of 2^-16, or 2^-24, below it
    pixels, coefficient, tangential = 16384 - 2**-16, 128 - 2**-24, 16 - 2**-24
    good = [{"fl_x": 8}, {"fl_x": pixels}, {"cx": pixels, "w": 16, "h": 16}, {"cy": 1 - pixels, "w": 16, "h": 16}, {"k1": 1e-9}, {"k1": coefficient},
            {"k2": coefficient}, {"k3": coefficient}, {"p1": tangential}, {"p2": -tangential},
            {"camera_model": "OPENCV_FISHEYE", "k4": coefficient}]
    bad = [({"fl_x": 8 - 2**-15}, "8 to 16384 pixels"), ({"fl_x": 16384}, "8 to 16384 pixels"),
           ({"fl_x": below(16384)}, "8 to 16384 pixels"), ({"fl_x": 40, "fl_y": 7}, "8 to 16384 pixels"),
           ({"cx": 16385, "w": 16, "h": 16}, "cx, cy"), ({"cy": -16385, "w": 16, "h": 16}, "cx, cy"), ({"cx": 17}, "outside"),
           ({"k2": -coefficient}, "fold"), ({"k1": -20}, "fold"), ({"k1": -1e5}, "fold"), ({"k1": 128}, "out of view"),
           ({"p1": 16}, "out of view"), ({"camera_model": "OPENCV_FISHEYE", "k1": 1000}, "out of view")]
    # beyond the runtime's range: import draws what a pinhole sees
    good += [{"k1": 128, "fl_x": 400}, {"k1": below(128), "fl_x": 400}, {"k1": 1000, "fl_x": 4000}, {"k4": 0.5, "k5": -0.1},
             {"k2": -128.1}, {"p2": -16, "fl_x": 400}, {"k3": 500, "k6": 500},
             {"camera_model": "OPENCV_FISHEYE", "k4": 128}]
    for i, lens in enumerate(good):
        taken(f"{lens}", folder(f"lens{i}", top=lens))
    for i, (lens, why) in enumerate(bad):
        refused(f"{lens}", folder(f"badlens{i}", top=lens), why)


def test_depth_units():
    for i, unit in enumerate((2.0**-30, 100, 128 - 2**-40)):
        taken(f"unit {unit!r}", folder(f"unit{i}", top={"integer_depth_scale": unit}))
    for i, unit in enumerate((2.0**-42, 0, -1, below(128), 128, 70000)):
        refused(f"unit {unit!r}", folder(f"badunit{i}", top={"integer_depth_scale": unit}), "not between 1e-12 and 128")


def test_sides():
    for width, height in ((8, 8), (9, 8), (8, 11), (4096, 8), (8, 4096)):
        taken(f"{width}x{height}", folder(f"side{width}x{height}", width, height))
    for width, height in ((7, 8), (8, 7), (2, 64)):
        path = folder(f"side{width}x{height}", width, height)
        refused(f"{width}x{height}", path, "sides of 8 and more")
        taken(f"{width}x{height} resized", path, "--size", "8x8")
    for width, height in ((4097, 8), (8, 4097)):
        refused(f"{width}x{height}", folder(f"side{width}x{height}", width, height), "c.png: ")


def test_counts():
    path = folder("count")
    frame = {"file_path": "c.png", "transform_matrix": UNIT}
    with open(f"{path}/transforms.json", "w", encoding="utf-8") as file:
        json.dump({"fl_x": 40, "frames": [frame] * 100001}, file)
    refused("100001 frames", path, "more than 100000")


with tempfile.TemporaryDirectory() as work:
    test_positions()
    test_lenses()
    test_depth_units()
    test_sides()
    test_counts()
done()
