#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""diff.py TRIM3R: compares scenes and pictures, and reports their differences."""
import json
import math
import struct

from program import check, expect, expect_json, in_scratch, room, run, write


# kinds of scene files, and whether they keep the order of Gaussians
KINDS = {"ply": True, "compressed.ply": False, "spz": True, "glb": True, "sog": False}
FLOATS = ("x", "y", "z", "f_dc_0", "f_dc_1", "f_dc_2", *(f"f_rest_{i}" for i in range(45)), "opacity",
          "scale_0", "scale_1", "scale_2", "rot_0", "rot_1", "rot_2", "rot_3")
TOUCHED = 5  # the Gaussian that is changed


def with_harmonics(path, **changes):
    """Writes 20 Gaussians with harmonics of degree 3, one of them with changed numbers."""
    rows = b""
    for i in range(20):
        row = dict.fromkeys(FLOATS, 0.0) | {"x": math.sin(i), "y": math.cos(2 * i), "z": 2 + i / 10, "rot_0": 1.0}
        row |= {f"scale_{axis}": -3.0 - axis for axis in range(3)} | {f"f_rest_{k}": math.sin(i + k) / 2 for k in range(45)}
        rows += struct.pack(f"<{len(FLOATS)}f", *(row | changes if i == TOUCHED else row).values())
    head = "".join(f"property float {name}\n" for name in FLOATS)
    write(path, f"ply\nformat binary_little_endian 1.0\nelement vertex 20\n{head}end_header\n".encode() + rows)


def differing(a, b):
    code, out, err = run("diff", a, b, "--json")
    found = json.loads(out)
    check(code == 1 and found["equal"] is False, f"{a} and {b} differ: {out} {err}")
    return found


def diff_of_one_number():
    """A single number of a single Gaussian is a difference, in each kind of file and however large it is."""
    with_harmonics("plain.ply")
    with_harmonics("other.ply", f_rest_44=1.5)
    for kind, ordered in KINDS.items():
        for name in ("plain", "other"):
            if kind != "ply":
                expect(0, "convert", f"{name}.ply", "-o", f"{name}.{kind}")
        expect(0, "diff", f"plain.{kind}", f"plain.{kind}", out="equal")
        found = differing(f"plain.{kind}", f"other.{kind}")
        check(found["harmonics"] > 0.5 and found["colour"] == found["position"] == 0 and found["degree"] == [3, 3],
              f"{kind}: the harmonics alone differ: {found}")
        check(not ordered or (found["different"], found["first"]) == (1, TOUCHED), f"{kind}: that one Gaussian: {found}")
    for kind in ("ply", "glb"):
        for number, what, values, least in (("f_rest_0", "harmonics", (9.0, 9.5), 0.4), ("f_dc_1", "colour", (4.0, 5.0), 70),
                                            ("x", "position", (1e7, 2e7), 9e6)):
            for name, value in zip(("low", "high"), values):
                with_harmonics(f"{name}.ply", **{number: value})
                expect(0, "convert", f"{name}.ply", "-o", f"{name}.glb")
            found = differing(f"low.{kind}", f"high.{kind}")
            check(found["different"] == 1 and found["first"] == TOUCHED and found[what] > least, f"{kind}, {number}: {found}")
    expect(0, "convert", "plain.ply", "-o", "plain.splat")
    check(differing("plain.ply", "plain.splat")["degree"] == [3, 0], "a file without harmonics differs from one with them")
    marked = bytearray(open("plain.spz", "rb").read())
    marked[14] |= 1  # antialiased
    write("marked.spz", bytes(marked))
    check(differing("plain.spz", "marked.spz")["mip"] == [False, True], "the mark of mip-splatting is a difference")
    check("the second scene alone is marked for mip-splatting" in run("diff", "plain.spz", "marked.spz")[1], "text of the mark")
    check("opacity 0, harmonics " in run("diff", "plain.ply", "other.ply")[1], "text of the harmonics")


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


in_scratch(diff, diff_of_one_number)
