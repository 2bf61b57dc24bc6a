#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""diff.py TRIM3R: compares scenes and pictures, and reports their differences."""
import json
import struct

from program import check, expect, expect_json, in_scratch, room, run, write


def diff():
    recording = room()
    expect(0, "build", recording, "--keep", 10, "-o", "scene.ply")
    expect(0, "build", recording, "--gaussians", 777, "-o", "exact.ply")
    for view, size, name in ((1, "64x64", "view.png"), (1, "32x32", "small.png"), (0, "64x64", "first.png"),
                             (2, "64x64", "third.png")):
        expect(0, "render", "scene.ply", recording, "--view", view, "--size", size, "-o", name)
    expect(2, "diff", err="two files")
    expect(2, "diff", "scene.ply", err="two files")
    expect(2, "diff", "scene.ply", "exact.ply", "third.ply", err="too many")
    expect(2, "diff", "scene.ply", "view.png", err="cannot be compared")
    expect(1, "diff", "scene.ply", "absent.ply", err="absent.ply")
    expect(1, "diff", "view.png", "absent.png", err="absent.png")
    expect(1, "diff", "view.png", "small.png", err="64x64")
    expect(0, "diff", "scene.ply", "scene.ply", out="equal")
    expect(0, "diff", "view.png", "view.png", out="equal")
    check(expect_json("diff", "scene.ply", "scene.ply")["equal"] is True, "diff --json does not say equal")
    code, out, _ = run("diff", "scene.ply", "exact.ply", "--json")
    found = json.loads(out)
    check(code == 1 and found["gaussians"][1] == 777 and found["position"] > 0, "diff of scenes is wrong")
    # one opacity changed: one Gaussian differs, and its index is printed
    scene = bytearray(open("scene.ply", "rb").read())
    row = scene.index(b"end_header\n") + 11 + 5 * 17 * 4
    scene[row + 9 * 4:row + 10 * 4] = struct.pack("<f", -3.0)
    write("touched.ply", bytes(scene))
    code, out, _ = run("diff", "scene.ply", "touched.ply", "--json")
    found = json.loads(out)
    check(code == 1 and found["different"] == 1 and found["first"] == 5 and found["position"] == 0, f"diff names {out}")
    code, out, _ = run("diff", "first.png", "third.png", "--json")
    found = json.loads(out)
    check(code == 1 and found["psnr"] > 0 and found["first_tile"][0] % 16 == 0, "diff of views is wrong")


in_scratch(diff)
