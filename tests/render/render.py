#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""render.py TRIM3R: refusals and results of `trim3r render`."""
import json
import os
import struct

from program import check, expect, expect_full, expect_json, in_scratch, room, write


POSE = {"fl_x": 220, "w": 64, "h": 48, "transform_matrix": [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]}


def render():
    recording = room()
    expect(0, "build", recording, "--keep", 10, "-o", "scene.ply")
    write("pose.json", json.dumps(POSE))
    write("path.txt", "# stamp tx ty tz qx qy qz qw\n0 0 0 0 0 0 0 1\n1 0 0 0.1 0 0 0 1\n")
    expect(2, "render", err="SCENE")
    expect(2, "render", "scene.ply", recording, "--view", 1, err="-o")
    expect(2, "render", "scene.ply", "-o", "v.png", err="viewpoint")
    expect(2, "render", "scene.ply", recording, "-o", "v.png", err="--view")
    expect(2, "render", "scene.ply", "--view", 1, "-o", "v.png", err="REC.mcap")
    expect(2, "render", "scene.ply", recording, "--view", 1, "--pose", "pose.json", "-o", "v.png", err="more than one")
    expect(2, "render", "scene.ply", "--fov", 60, "-o", "v.png", err="--fov")
    expect(2, "render", "scene.ply", recording, "extra", "--view", 1, "-o", "v.png", err="too many")
    for option, values in {"--view": ["x", "-1"], "--size": ["9", "0x9", "5000x5"], "--fov": ["0", "180", "x"],
                           "--max-ms": ["0", "-1", "x"], "--tile-splats": ["-1", "16777217"], "--threads": ["0"], "--depth-unit": ["0", "x"], "--arena": ["big"]}.items():
        for value in values:
            expect(2, "render", "scene.ply", "-o", "v.png", f"{option}={value}", err=option)
    expect(1, "render", "scene.ply", recording, "--view", 99, "-o", "v.png", err="no frame 99")
    expect(1, "render", "absent.ply", recording, "--view", 1, "-o", "v.png", err="absent.ply")
    expect(1, "render", recording, recording, "--view", 1, "-o", "v.png", err="a recording, not a scene: trim3r scene")
    scene = open("scene.ply", "rb").read()
    write("cut.ply", scene[:-1])
    expect(1, "render", "cut.ply", recording, "--view", 1, "-o", "v.png", err="cut off")
    expect(1, "render", "scene.ply", "--pose", "absent.json", "-o", "v.png", err="absent.json")
    expect(1, "render", "scene.ply", "--pose", "path.txt", "-o", "v.png", err="JSON")
    expect(1, "render", "scene.ply", "--pose", "pose.json", "--trajectory", "pose.json", "-o", "v.png", err="line 1")
    expect(2, "render", "scene.ply", "--fov", 179.9, "--size", "64x64", "--trajectory", "path.txt", "-o", "v.png",
           err="focal")
    expect(1, "render", "scene.ply", recording, "--view", 1, "-o", "missing/v.png", err="missing/v.png")
    os.mkdir("flat")
    expect(1, "render", "scene.ply", recording, "--view", 1, "-o", "flat", err="flat: not a regular file")
    expect_full("full.png", "render", "scene.ply", recording, "--view", 1, "-o", "full.png")

    found = expect_json("render", "scene.ply", recording, "--view", 1, "--depth", "d.png", "--alpha", "a.png",
                        "-o", "view.png")
    check(found["gaussians"] > 0 and found["width"] == 64, "render --json lacks its keys")
    for name in ("view.png", "d.png", "a.png"):
        check(open(name, "rb").read(8) == b"\x89PNG\r\n\x1a\n", f"{name} is no PNG")
    for unit, warning in (("1e-6", "are farther than 65535 steps of 1e-06, and 0: raise"), ("1000", "are nearer than half a step of 1000, and 0: lower")):
        expect(0, "render", "scene.ply", recording, "--view", 1, "--depth", "d.png", "--depth-unit", unit, "-o", "view.png", err=warning)
    expect(0, "render", "scene.ply", "--pose", "pose.json", "-o", "p.png", err="no Gaussian is in front of it, from a distance of 0.")
    small = expect_json("render", "scene.ply", recording, "--view", 1, "--size", "100x50", "-o", "small.png")
    check((small["width"], small["height"]) == (100, 50), "--size does not set the size")
    found = expect_json("render", "scene.ply", "--pose", "pose.json", "-o", "p.png")
    check(found["height"] == 48, "--pose sets no size")
    expect(0, "render", "scene.ply", "--trajectory", "path.txt", "--pose", "pose.json", "-o", "t.png", out="2 views")
    expect(0, "render", "scene.ply", "--trajectory", "path.txt", "--fov", 60, "--size", "32x32", "-o", "f.png")
    check(all(os.path.exists(n) for n in ("t_0000.png", "t_0001.png", "f_0001.png")), "numbered pictures are missing")


def haze(path, count):
    """Writes a .ply of faint Gaussians, each wider than any picture."""
    names = ["x", "y", "z", "f_dc_0", "f_dc_1", "f_dc_2", "opacity", "scale_0", "scale_1", "scale_2", "rot_0", "rot_1",
             "rot_2", "rot_3"]
    header = "ply\nformat binary_little_endian 1.0\nelement vertex %d\n" % count
    header += "".join(f"property float {name}\n" for name in names) + "end_header\n"
    rows = (struct.pack("<14f", 0, 0, 2 + i / count, 1, 0, -1, -4.5, 2, 2, 2, 1, 0, 0, 0) for i in range(count))
    with open(path, "wb") as file:
        file.write(header.encode() + b"".join(rows))


def slow_scenes():
    haze("haze.ply", 20000)
    here = {**POSE, "transform_matrix": [[1, 0, 0, 0], [0, -1, 0, 0], [0, 0, -1, 0], [0, 0, 0, 1]]}
    write("here.json", json.dumps({**here, "w": 256, "h": 256}))
    view = ["render", "haze.ply", "--pose", "here.json", "-o", "haze.png"]
    expect(1, *view, "--max-ms", 50, err="--max-ms")
    check(not os.path.exists("haze.png"), "a view that was given up is written")
    # a bound on the splats in a tile bounds the time; at the list's length it changes nothing
    bounded = expect_json(*view, "--tile-splats", 20)
    check(bounded["render_ms"] < 1000, f"20 splats a tile take {bounded['render_ms']} ms")
    small = ["render", "haze.ply", "--pose", "here.json", "--size", "16x16", "-o", "small.png"]
    whole = expect_json(*small)["hash"]
    check(expect_json(*small, "--tile-splats", 20000)["hash"] == whole, "all of a list are not the list")
    check(expect_json(*small, "--tile-splats", 5)["hash"] != whole, "--tile-splats draws them all")


in_scratch(render, slow_scenes)
