#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""eval_scene.py TRIM3R: `trim3r eval --scene` gives a file the scores of the views that `render` draws from it, with
its harmonics."""
import json
import os
import struct
import sys
import tempfile

from checks import check, done, near, run

trim3r = os.path.abspath(sys.argv[1])
ONE = ("--context", "0,2", "--target", "1")
CASES = 3  # of the room


def rows(*options):
    return json.loads(run(trim3r, "eval", "room.mcap", *options, "--json").stdout)["rows"]


def drawn(scene, frame):
    """Returns the PSNR over all pixels of a view that `render` draws."""
    run(trim3r, "render", scene, "room.mcap", "--view", frame, "-o", "view.png")
    return json.loads(run(trim3r, "diff", "view.png", f"pictures/{frame}/target.png", "--json", expect=1).stdout)["psnr"]


def with_harmonics(path, out):
    """Writes the scene with colours of degree 1 that change from view to view."""
    with open(path, "rb") as file:
        header, body = file.read().split(b"end_header\n", 1)
    names = [line.split()[-1] for line in header.split(b"\n") if line.startswith(b"property")]
    at, size = names.index(b"f_dc_2") + 1, len(names)
    floats = struct.unpack(f"<{len(body) // 4}f", body)
    more = [value for i in range(0, len(floats), size)
            for value in (*floats[i:i + at], *((-1) ** (i // size) * 0.4 for _ in range(9)), *floats[i + at:i + size])]
    lines = b"".join(b"property float f_rest_%d\n" % k for k in range(9))
    with open(out, "wb") as file:
        file.write(header.replace(b"property float f_dc_2\n", b"property float f_dc_2\n" + lines) + b"end_header\n" +
                   struct.pack(f"<{len(more)}f", *more))


def scored():
    built = rows(*ONE, "--gaussians", "500", "--refine", "0")[0]
    run(trim3r, "build", "room.mcap", "--context", "0,2", "--gaussians", "500", "--refine", "0", "-o", "mine.ply")
    found = rows(*ONE, "--scene", "mine.ply", "--images", "pictures")[0]
    check((found["method"], found["gaussians"], found["scene_bytes"]) == ("scene", 500, 22000), f"the row: {found}")
    check(all(found[key] is None for key in ("head", "refine", "keep", "requested", "build_ms")), f"the row: {found}")
    check(os.path.exists(f"pictures/{found['picture']}"), "no picture")
    for key, bound in (("psnr", 0.01), ("context_psnr", 0.01), ("ssim", 0.001), ("holes", 0.001)):
        near(found[key], built[key], bound, key)
    near(found["psnr_all"], drawn("mine.ply", "1"), 1e-3, "render draws another view")
    run(trim3r, "eval", "room.mcap", "--scene", "mine.ply", "--csv", "rows.csv")
    with open("rows.csv", encoding="utf-8") as file:
        table = file.read()
    check(len(table.splitlines()) == 1 + CASES, table)
    run(trim3r, "eval", "room.mcap", "--scene", "mine.ply", "--csv", "rows.csv", "--resume")
    with open("rows.csv", encoding="utf-8") as file:
        check(file.read() == table, "rows of a scene are made again")
    with_harmonics("mine.ply", "theirs.ply")
    run(trim3r, "convert", "theirs.ply", "-o", "theirs.spz")
    for name in ("theirs.ply", "theirs.spz"):
        cases = rows("--scene", name, "--images", "pictures")
        check(len(cases) == CASES, f"{name}: {cases}")
        check(abs(cases[0]["psnr_all"] - found["psnr_all"]) > 0.5, f"{name}: no harmonics are drawn")
        for row in cases[:2]:
            near(row["psnr_all"], drawn(name, row["target"]), 1e-3, f"{name}: harmonics of target {row['target']}")


def refused():
    line = (trim3r, "eval", "room.mcap", "--scene")
    for more in ("--keep=5", "--gaussians=5", "--planar", "--auto"):
        said = run(*line, "mine.ply", more, expect=2).stderr
        check("--scene is scored as it is" in said, f"--scene with {more}: {said}")
    check("room.mcap" in run(*line, "room.mcap", expect=1).stderr, "a recording is no scene")


with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    run(trim3r, "room", "--size", "64x64", "-o", "room.mcap")
    scored()
    refused()
done()
