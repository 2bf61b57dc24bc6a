#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""build.py TRIM3R: refusals and results of `trim3r build`."""
import csv
import os
import struct

from hostile import formats
from program import check, expect, expect_full, expect_json, in_scratch, room, run


def refused():
    room()
    expect(2, "build", err="REC.mcap is missing")
    expect(2, "build", "room.mcap", "--keep", 10, err="-o")
    expect(2, "build", "room.mcap", "room.mcap", "--keep", 10, "-o", "s.ply", err="too many")
    expect(2, "build", "room.mcap", "--keep", 10, "-o", "s.obj", err=".ply")
    expect(2, "build", "room.mcap", "-o", "s.ply", err="budget")
    expect(2, "build", "room.mcap", "--keep", 10, "--gaussians", 5, "-o", "s.ply", err="exclude")
    for option, values in {
        "--keep": ["0", "101", "x", "-3", "10,20", ""],
        "--gaussians": ["0", "x", "-1", "16777217", "1.5"],
        "--context": ["", "a", "0,", "-1", ",".join(map(str, range(17)))],
        "--allocate": ["evenly", ""],
        "--head": ["big", "", "learned", ".t3w", "small.c"],
        "--wavelet": ["db9"],
        "--levels": ["0", "6"],
        "--clusters": ["513"],
        "--gamma": ["-1", "2.1", "x", "nan"],
        "--keep-percent": ["101"],
        "--fill-radius": ["9"],
        "--bridge-radius": ["256"],
        "--rim": ["1", ""],
        "--backdrop": ["1", ""],
        "--flying": ["1", ""],
        "--redundancy": ["yes"],
        "--exposure": ["On"],
        "--seed": ["-1", "4294967296"],
        "--working": ["64", "4x64", "64x5000"],
        "--arena": ["x", "-1", "1x", "1KB", "K", ""],
        "--threads": ["0", "65"],
        "--cpu-mask": ["every", "avx2,", ",avx2", "0x", "-1", "4294967296", ""],
        "--depth": ["Stereo", "radar", ""],
        "--refine": ["33", "x"],
    }.items():
        for value in values:
            expect(2, "build", "room.mcap", "-o", "s.ply", f"{option}={value}", err=option)
    for loss in ("0", "0.001", "11", "-1", "x", "1e3", ""):
        expect(2, "build", "room.mcap", "--auto", f"--max-loss={loss}", "-o", "s.ply", err="--max-loss")
    expect(2, "build", "room.mcap", "--keep", 10, "--max-loss", 1, "-o", "s.ply", err="belongs to --auto")
    expect(2, "build", "room.mcap", "--auto", "--refine", 0, "-o", "s.ply", err="--refine 1 or more")
    expect(2, "build", "room.mcap", "--keep", 10, "--context", "1,1", "-o", "s.ply", err="twice")
    expect(1, "build", "room.mcap", "--keep", 10, "--context", "0,99", "-o", "s.ply", err="no frame 99")
    expect(1, "build", "room.mcap", "--keep", 10, "-o", "missing/s.ply", err="missing/s.ply")
    os.mkdir("folder.ply")
    expect(1, "build", "room.mcap", "--keep", 10, "-o", "folder.ply", err="folder.ply: not a regular file")
    expect_full("full.ply", "build", "room.mcap", "--keep", 10, "-o", "full.ply")


def built():
    found = expect_json("build", "room.mcap", "--context", "0,2", "--keep", "10%", "-o", "scene.ply")
    check(found["head"] == "small" and found["head_bits"] == "8", "small is not the head unless another is named")
    for key in ("gaussians", "arena_bytes", "hash", "valid_points", "bits_epoch", "origin", "exponent"):
        check(key in found, f"build --json has no {key}")
    check(found["gaussians"] == (found["valid_points"] * 10 + 50) // 100, "--keep 10% is not a tenth")
    exact = expect_json("build", "room.mcap", "--gaussians", 777, "-o", "exact.ply")
    check(exact["gaussians"] == 777, "--gaussians is not met exactly")
    auto = ["build", "room.mcap", "--context", "0,2", "--working", "64x64", "--auto"]
    few = expect_json(*auto, "--max-loss", 3, "-o", "few.ply")
    more = expect_json(*auto, "--max-loss", 2, "-o", "more.ply")
    some = expect_json(*auto, "-o", "some.ply")
    check(some["max_loss"] == 0.5, "--auto has another loss than 0.5 dB")
    counts = [found["gaussians"] for found in (few, more, some)]
    check(0 < counts[0] < counts[1] < counts[2] <= some["valid_points"], f"--auto takes no fewer for more loss: {counts}")
    check(0 <= some["loss"] <= 0.5 < few["loss"] <= 3 and 2 <= few["builds"] <= 8 and 50 < few["held_percent"] <= 100,
          f"--auto measures no loss: {some}, {few}")
    expect(0, "eval", "room.mcap", "--working", "64x64", "--context", "0,2", "--target", 1, "--auto", "--csv", "auto.csv")
    with open("auto.csv", newline="") as table:
        row = next(csv.DictReader(table))
    check(row["settings"] == "max-loss-0.5 working-64x64" and int(row["gaussians"]) == some["gaussians"] and
          row["loss"] == f"{some['loss']:.4f}", "eval --auto does not take what build --auto takes")
    expect(0, *auto, "-o", "some.ply", out=f"new views lose {some['loss']:.2f} dB against all points")
    most = expect_json(*auto, "--gaussians", 50, "-o", "most.ply")
    check(most["gaussians"] == 50 and most["loss"] > 0.5, "--gaussians is not the most of --auto")
    expect(0, *auto, "--gaussians", 50, "-o", "most.ply", out="warning: that is more than --max-loss 0.5")
    alone = ["build", "room.mcap", "--context", "0", "--working", "64x64", "--auto"]
    check(expect_json(*alone, "-o", "alone.ply")["loss"] is None, "--auto measures a loss of one view")
    expect(0, *alone, "-o", "alone.ply", out="share a surface to measure the loss on: it is predicted")
    least = ["build", "room.mcap", "--context", "0,2", "--working", "64x64", "--min-psnr"]
    dull, sharp = (expect_json(*least, psnr, "-o", "least.ply") for psnr in (20, 26))
    check(20 <= dull["context_psnr"] and 26 <= sharp["context_psnr"] and dull["gaussians"] < sharp["gaussians"],
          f"--min-psnr: {dull['gaussians']}, {sharp['gaussians']}")
    expect(0, *least, 26, "--gaussians", 40, "-o", "least.ply", out="the best of the numbers that were tried")
    expect(2, *least, 26, "--auto", "-o", "least.ply", err="exclude each other")
    for command in (["build", "-o", "all.ply"], ["build", "-o", "all.ply", "--json"], ["replay"]):
        expect(0, *command, "room.mcap", "--working", "32x32", "--gaussians", 100000,
               err="100000 Gaussians are more than the views have: all ")
    for command in (["build", "-o", "few.ply"], ["eval"], ["replay"]):
        line = [*command, "room.mcap", "--working", "32x32", "--keep"]
        expect(0, *line, 0.5, err="warning: --keep 0.5 is 0.5 percent of the points; a share of 0.5 is --keep 50")
        check("warning" not in run(*line, 1)[2], f"{line}: a warning of 1 %")
    expect(0, "build", "room.mcap", "--working", "32x32", "--gaussians", 9, "--head", "none", "--comments",
           "-o", "named.ply")
    named = open("named.ply", "rb").read()
    check(b"comment trim3r bits_epoch" in named, "--comments writes none")
    check(b"comment trim3r head none\n" in named, "--comments does not name the head")
    header = open("exact.ply", "rb").read().split(b"end_header\n")[0].splitlines()
    check([b"comment" in line for line in header] == [False] * (len(header) - 1) + [True], "another comment than the last line is unasked")
    backdrop_without_depth()


def backdrop_without_depth():
    """A file says which of its Gaussians are the backdrop; without this, its depth is that of surfaces far away."""
    expect(0, "build", "room.mcap", "--context", "0,2", "--working", "64x64", "--keep", 50, "--rim", "off", "--backdrop", "on", "-o", "wide.ply")
    marked = open("wide.ply", "rb").read()
    check(b"\ncomment trim3r backdrop 54\n" in marked, "the file does not say what its backdrop is")
    open("plain.ply", "wb").write(marked.replace(b"comment trim3r backdrop 54\n", b""))
    for name, warns in (("wide.ply", False), ("plain.ply", True)):
        said = run("render", name, "room.mcap", "--view", 5, "--depth", "depth.png", "-o", "view.png")[2]
        check(("pixels are farther than" in said) == warns, f"{name}: the depth of the backdrop: {said}")
    for name, warns in (("kept.ply", False), ("lost.splat", True), ("lost.spz", True)):
        said = run("convert", "wide.ply", "-o", name)[2]
        check(("no place for the mark of the 54 Gaussians" in said) == warns, f"{name}: the mark of the backdrop: {said}")
    check(open("kept.ply", "rb").read() == marked, "a conversion to the same format changes bytes")


def lens_recording(name, side=48):
    """Writes two frames through a pinhole, and two through a lens with distortion, whose undistorted corners show nothing."""
    picture = bytes(min(255, 60 + 4 * (x % 16) + 2 * y) for y in range(side) for x in range(side) for _ in range(3))
    matrix, bends = (40, 0, side / 2, 0, 40, side / 2, 0, 0, 1), ((0, 0, 0, 0, 0), (.3, 0, 0, 0, 0))
    made = {"image": lambda stamp: formats.image(stamp, side, side, data=picture),
            "depth": lambda stamp: formats.image(stamp, side, side, "16UC1", struct.pack("<H", 1500) * side**2),
            "camera_info": lambda stamp: formats.camera_info(stamp, side, side, matrix, bend)}
    frames = []
    for i in range(4):
        bend = bends[i // 2]
        frames.append(formats.frame(i, **made))
    with open(name, "wb") as file:
        file.write(formats.mcap(formats.channels(), *frames))


def through_a_lens():
    """--min-psnr measures what eval measures: pixels beyond the lens do not count."""
    lens_recording("lens.mcap")
    line = ["lens.mcap", "--context", "2,3", "--exposure", "off", "--align", "off"]  # eval draws the poses as recorded
    for bound in (24, 30):
        report = expect_json("build", *line, "--min-psnr", bound, "-o", "lens.ply", "--force")
        rows = [expect_json("eval", *line, "--gaussians", report["gaussians"], "--target", frame)["rows"][0] for frame in (2, 3)]
        scored = [row["psnr_all"] for row in rows]
        check(report["context_psnr"] >= bound and abs(min(scored) - report["context_psnr"]) < 0.01,
              f"--min-psnr {bound}: {report['gaussians']} Gaussians, {report['context_psnr']} dB, by eval {scored}")
    # The last scene of --slide is that of its two frames alone; with --warm on its clusters are older, and it needs more.
    # A mask of the first frames, which have no lens, would ask for 896.
    for warm, most in (("off", report["gaussians"]), ("on", 200)):
        slid = expect_json("replay", *line[:1], *line[3:], "--slide", "--warm", warm, "--min-psnr", 30)
        check(report["gaussians"] <= slid["gaussians"] <= most, f"--slide --warm {warm}: {slid['gaussians']} Gaussians")


in_scratch(refused, built, through_a_lens)
