#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""eval_refused.py TRIM3R: of several cases those with refused frames are omitted, reported with their reason and
counted, with one process and with several; alone each is an error; if none is left the exit status is 1."""
import csv
import json
import os
import pathlib
import struct
import sys
import tempfile
import zlib

from checks import check, done, run
from png import png

trim3r = os.path.abspath(sys.argv[1])
SIDE = 64
UNLIKE = ("scene", "build_ms", "render_ms")  # columns that differ between runs on two recordings
NO_DEPTH, IN_PLACE, BESIDE = 3, 4, 5  # frames: without depth; where frame 0 was; where NO_DEPTH was
MEASURED = [((0, 2), 1), ((1, BESIDE), 2)]
NO_PAIR = ((0, IN_PLACE), 1)  # not for stereo


def wall(shift):
    """Colours of a wall two units away, whose pattern does not repeat, seen `shift` pixels further to the right."""
    def sample(x, y):
        return zlib.crc32(bytes([(x // 3) & 255, y // 3])) & 0xffffff

    return [b"".join(sample(x + shift, y).to_bytes(3, "little") for x in range(SIDE)) for y in range(SIDE)]


def recorded(name, triplets):
    """Records frames side by side, at multiples of the wall's pixel."""
    frames = []
    os.makedirs("wall", exist_ok=True)
    for i, place in enumerate([0, 2, 4, 6, 0, 6]):
        pathlib.Path(f"wall/{i}.png").write_bytes(png(wall(place)))
        pathlib.Path(f"wall/d{i}.png").write_bytes(png([struct.pack(">H", 2000) * SIDE] * SIDE, 16, 1))
        frames.append({"file_path": f"{i}.png", "w": SIDE, "h": SIDE, "fl_x": SIDE, "fl_y": SIDE, "cx": SIDE / 2,
                       "cy": SIDE / 2, "transform_matrix": [[1, 0, 0, place * 2 / SIDE], [0, -1, 0, 0], [0, 0, -1, 0],
                                                            [0, 0, 0, 1]]})
        if i != NO_DEPTH:
            frames[-1]["depth_path"] = f"d{i}.png"
    with open("wall/transforms.json", "w", encoding="utf-8") as file:
        json.dump({"integer_depth_scale": 0.001, "frames": frames,
                   "trim3r_triplets": [{"context": list(c), "target": t} for c, t in triplets]}, file)
    run(trim3r, "import", "wall", "-o", name)
    return name


def rows_of(path):
    with open(path, newline="", encoding="utf-8") as file:
        return [{k: v for k, v in row.items() if k not in UNLIKE} for row in csv.DictReader(file)]


def named(case):
    return ",".join(map(str, case[0])), str(case[1])


def goes_on(recording, alone, refused, reasons, *options):
    """Checks the refused cases, in order; all other cases are as without them."""
    options = ["--keep", "40,10", "--refine", 1, *options]
    call = [trim3r, "eval", recording, *options]
    plain = json.loads(run(trim3r, "eval", alone, *options, "--csv", "alone.csv", "--json").stdout)
    for jobs in (1, 5):
        ended = run(*call, "--csv", "rows.csv", "--jobs", jobs, "--html", "page.html")
        told = [line for line in ended.stderr.splitlines() if "left out" in line]
        check(len(told) == len(refused), f"{jobs} jobs: {ended.stderr}")
        for line, case, reason in zip(told, refused, reasons):
            context, target = named(case)
            check(f"left out: context {context}, target {target}: " in line and reason in line, line)
        check(f"{len(refused)} of {len(refused) + len(MEASURED)} cases were refused" in ended.stderr, ended.stderr)
        check(rows_of("rows.csv") == rows_of("alone.csv") != [], f"{jobs} jobs: rows of the others")
        with open("page.html", encoding="utf-8") as file:
            page = file.read()
        check("Refused" in page and all(reason in page for reason in reasons), "the page tells what is missing")
    found = json.loads(run(*call, "--json").stdout)
    check([(r["context"], r["target"]) for r in found["refused"]] == list(map(named, refused)), found["refused"])
    check(all(reason in r["reason"] for r, reason in zip(found["refused"], reasons)), found["refused"])
    check(plain["refused"] == [] and [r["psnr"] for r in found["means"]] == [r["psnr"] for r in plain["means"]] and
          len(found["means"]) == len(plain["means"]) > 0, "the means are those of the cases measured")
    stood = rows_of("rows.csv")
    ended = run(*call, "--csv", "rows.csv", "--resume")
    check(rows_of("rows.csv") == stood and "left out" in ended.stderr, "refused cases are tried again, no row twice")


with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    no_depth = [((0, NO_DEPTH), 1), ((NO_DEPTH, BESIDE), 2)]
    fit = recorded("fit.mcap", MEASURED)
    mixed = recorded("mixed.mcap", [no_depth[0], *MEASURED, no_depth[1]])
    goes_on(mixed, fit, no_depth, ["frame 3 has no depth"] * 2)
    goes_on(mixed, fit, no_depth, ["frame 3 has no depth"] * 2, "--methods", "trim3r,random,eagles")
    odd = recorded("odd.mcap", [MEASURED[0], NO_PAIR, MEASURED[1]])
    goes_on(odd, fit, [NO_PAIR], ["frames 0 and 4 give no depth: "], "--depth", "stereo")
    blind = recorded("blind.mcap", [((NO_DEPTH, BESIDE), 1), *MEASURED])
    goes_on(blind, fit, [((NO_DEPTH, BESIDE), 1)], ["frames 3 and 5 give no depth: "], "--depth", "stereo",
            "--views", 3)

    run(trim3r, "eval", odd, "--keep", 10, "--csv", "whole.csv")
    check(len(rows_of("whole.csv")) == 3, "with its depth the same case is measured")
    for recording, context, options, words in ((mixed, "0,3", [], "frame 3 has no depth"),
                                               (odd, "0,4", ["--depth", "stereo"], "frames 0 and 4")):
        ended = run(trim3r, "eval", recording, "--context", context, "--target", 1, "--keep", 10, *options, expect=1)
        check(words in ended.stderr and "left out" not in ended.stderr, f"alone it is an error: {ended.stderr}")
    bad = recorded("bad.mcap", no_depth)
    ended = run(trim3r, "eval", bad, "--keep", 10, "--json", "--html", "none.html", expect=1)
    check("every case was refused" in ended.stderr and ended.stdout == "", ended.stderr)
    check(not os.path.exists("none.html"), "no page of nothing")
    ended = run(trim3r, "eval", mixed, "--keep", 10, "--arena", 1000, expect=3)
    check("too small" in ended.stderr and "of 4 cases" not in ended.stderr, "a budget is too small for every case")
    run(trim3r, "eval", mixed, "--keep", 10, "--csv", "/dev/full", expect=1)
    os.mkdir("pictures")
    with open("pictures/0.png", "wb"):
        pass
    ended = run(trim3r, "eval", "--planar", "wall/0.png", "pictures/0.png", "--size", "32x32", "--keep", 10)
    check("left out: " in ended.stderr and "1 of 2 cases" in ended.stderr, f"a picture that is none: {ended.stderr}")
done()
