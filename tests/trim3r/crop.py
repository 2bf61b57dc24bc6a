#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""crop.py TRIM3R: convert cuts a box and faint Gaussians out of a scene, in the same world for each format."""
import math
import struct

from program import check, expect, expect_json, in_scratch, run, write

NAMES = "x y z f_dc_0 f_dc_1 f_dc_2 opacity scale_0 scale_1 scale_2 rot_0 rot_1 rot_2 rot_3".split()
# a grid of 4 x 3 x 2 Gaussians, more opaque from left to right
GRID = [(x, y - 5, z + 100) for x in range(4) for y in range(3) for z in range(2)]


def opacity(x):
    return (x + 1) / 5


def grid(path):
    rows = [[*place, .1, .2, .3, math.log(opacity(place[0]) / (1 - opacity(place[0]))), -3, -3, -3, 1, 0, 0, 0] for place in GRID]
    head = "".join(f"property float {name}\n" for name in NAMES)
    write(path, f"ply\nformat binary_little_endian 1.0\nelement vertex {len(rows)}\n{head}end_header\n".encode()
          + b"".join(struct.pack("<14f", *row) for row in rows))


def places(path):
    with open(path, "rb") as file:
        head, body = file.read().split(b"end_header\n", 1)
    width = head.count(b"property")
    return sorted(tuple(round(x) for x in row[:3]) for row in struct.iter_unpack(f"<{width}f", body))


def cropped(source, *options, wanted):
    """Checks that these are the places that are left."""
    found = expect_json("convert", source, *options, "-o", "part.ply", "--force")
    wanted = sorted(place for place in GRID if wanted(*place))
    check(places("part.ply") == wanted, f"{source} {options}: {places('part.ply')}, not {wanted}")
    check((found["gaussians_read"], found["gaussians"]) == (len(GRID), len(wanted)), f"{source}, {options}: {found}")


def crop():
    grid("grid.ply")
    kinds = ["grid.ply"]
    for suffix in ("compressed.ply", "splat", "spz", "glb"):
        expect(0, "convert", "grid.ply", "-o", f"grid.{suffix}")
        kinds.append(f"grid.{suffix}")
    for source in kinds:
        cropped(source, "--crop", "0.5,-4.5,99,2.5,-2.5,100.5", wanted=lambda x, y, z: 1 <= x <= 2 and y >= -4 and z == 100)
        cropped(source, "--crop", ",,,,-4.5,", wanted=lambda x, y, z: y == -5)
        cropped(source, "--min-opacity", "0.5", wanted=lambda x, y, z: opacity(x) >= .5)
        cropped(source, "--crop", "1.5,,,,,", "--min-opacity", "0.7", wanted=lambda x, y, z: x == 3)
    cropped("grid.ply", "--crop", "1,-4,100,1,-4,100", wanted=lambda x, y, z: (x, y, z) == (1, -4, 100))
    cropped("grid.ply", "--min-opacity", "0", wanted=lambda *place: True)
    check("part.ply: 6 of 24 Gaussians" in run("convert", "grid.ply", "--crop", "3,,,,,", "-o", "part.ply")[1], "the count of both")
    for all_kept in (("--crop", ",,,9,9,999"), ("--min-opacity", "0")):
        expect(0, "convert", "grid.ply", *all_kept, "-o", "part.ply", "--force", out="part.ply: 24 of 24 Gaussians")
    expect(0, "convert", "grid.ply", "-o", "part.ply", "--force", out="part.ply: 24 Gaussians")
    for box in ("1,2,3", "1,2,3,4,5", "1,2,3,4,5,6,7", "1,1,1,0,2,2", "a,,,,,", "nan,,,,,", ",,,,,inf", "1 ,,,,,"):
        expect(2, "convert", "grid.ply", "--crop", box, "-o", "no.ply", err="--crop takes two corners")
    expect(2, "convert", "grid.ply", "--min-opacity", "20", "-o", "no.ply", err="--min-opacity")
    expect(1, "convert", "grid.ply", "--crop", "9,,,,,", "-o", "no.ply", err="grid.ply: none of its Gaussians is kept")


in_scratch(crop)
