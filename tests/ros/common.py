# SPDX-License-Identifier: Apache-2.0
"""Shared by the scripts of this folder."""
import json
import math
import os
import re
import struct
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
from checks import check, done, near, run, skip  # noqa: E402, F401

SIDE, FRAMES, GAUSSIANS = 64, 10, 1000
EVERY = 1  # with frames between keyframes, `replay` draws these, and its hashes cover the pictures
FIELDS = ("x", "y", "z", "rgb", "opacity", "scale_0", "scale_1", "scale_2", "rot_0", "rot_1", "rot_2", "rot_3")
FLOAT32 = 7


def walk(trim3r, folder):
    """Makes a recording of the built-in room and runs `replay --stream` on it."""
    recording = f"{folder}/walk.mcap"
    run(trim3r, "room", "--size", f"{SIDE}x{SIDE}", "--frames", FRAMES, "-o", recording)
    told = run(trim3r, "replay", recording, "--stream", "--every", EVERY, "--gaussians", GAUSSIANS, "--json").stdout
    return recording, json.loads(told)


def hashes(log):
    """Returns the keyframes' hashes in a node's log."""
    return re.findall(r"keyframe \d+: .* hash ([0-9a-f]{16})", log)


def check_hashes(log, replayed, name):
    check(hashes(log) == [k["hash"] for k in replayed["keyframes"]],
          f"{name}: all stages as `replay --stream` has them: {hashes(log)}, {replayed['keyframes']}")


def check_lines(path, replayed, name):
    """Checks that the lines are the rows of a replay, but for times, stamps and what is measured for lines alone."""
    own = ("ms", "stages_ms", "stamp_ns", "psnr_before")
    with open(path) as file:
        rows = [json.loads(line) for line in file]
    check([{key: row[key] for key in row if key not in own} for row in rows] ==
          [{key: row[key] for key in row if key not in own} for row in replayed["keyframes"]], f"{name}: a line a keyframe")
    check(all(row["psnr_before"] > 15 for row in rows[1:]), f"{name}: the map is scored before each keyframe")


def ply_rows(path):
    """Returns rows of x y z nx ny nz f_dc_0..2 opacity scale_0..2 rot_0..3, floats."""
    with open(path, "rb") as file:
        data = file.read()
    head, body = data.split(b"end_header\n", 1)
    names = re.findall(rb"property float (\w+)", head)
    step = 4 * len(names)
    return [dict(zip((n.decode() for n in names), struct.unpack_from(f"<{len(names)}f", body, at)))
            for at in range(0, len(body), step)]


def check_clouds(lines, replayed, name):
    """Checks that there is one cloud per keyframe, and the clouds' fields, sizes, frame and stamps."""
    clouds = [json.loads(line) for line in lines]
    check([c["cloud"] for c in clouds] == [k["gaussians"] for k in replayed["keyframes"]], f"{name}: a cloud a keyframe")
    for cloud in clouds:
        fields = [[field, 4 * at, FLOAT32, 1] for at, field in enumerate(FIELDS)]
        check(cloud["fields"] == fields, f"{name}: {cloud['fields']}")
        check((cloud["height"], cloud["step"], cloud["row"], cloud["bytes"]) ==
              (1, 48, 48 * cloud["cloud"], 48 * cloud["cloud"]), f"{name}: its sizes: {cloud}")
        check((cloud["big"], cloud["dense"], cloud["frame"]) == (0, 1, "world"), f"{name}: its frame: {cloud}")
    stamps = [c["stamp_ns"] for c in clouds]
    check(stamps == sorted(set(stamps)), f"{name}: the stamps of the frames: {stamps}")


def check_points(cloud_path, scene_path, name):
    """Compares the last cloud with the scene that the node saved as .ply, Gaussian for Gaussian."""
    rows = ply_rows(scene_path)
    with open(cloud_path, "rb") as file:
        data = file.read()
    check(len(data) == 48 * len(rows) > 0, f"{name}: as many points as the scene has Gaussians: {len(data)}, {len(rows)}")
    for at, row in enumerate(rows):
        x, y, z = struct.unpack_from("<3f", data, at * 48)
        blue, green, red, none = data[at * 48 + 12:at * 48 + 16]
        opacity, *shape = struct.unpack_from("<8f", data, at * 48 + 16)
        check((x, y, z) == (row["x"], row["y"], row["z"]), f"{name}: the position of {at}: {x, y, z}, {row}")
        for channel, seen in enumerate((red, green, blue)):
            near(seen / 255, 0.5 + 0.28209479 * row[f"f_dc_{channel}"], 0.6 / 255, f"{name}: the colour of {at}")
        near(opacity, 1 / (1 + math.exp(-row["opacity"])), 1e-4, f"{name}: the opacity of {at}")
        for i in range(3):
            near(shape[i] / math.exp(row[f"scale_{i}"]), 1, 1e-4, f"{name}: the scale of {at}")
        for i in range(4):
            near(shape[3 + i], row[f"rot_{i}"], 1e-6, f"{name}: the rotation of {at}")
        check(none == 0, f"{name}: four bytes of colour")
