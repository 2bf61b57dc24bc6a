#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""floors.py TRIM3R TRIM3R_FLOAT SHARED_DATA: the shipped heads on real scenes of the test split at 256x256, against
their guarantees and the measured values.

A scene with a few cases for each claim: two minutes instead of the two hours of tools/study/scripts/results."""
import csv
import json
import os
import statistics
import sys
import tempfile

from checks import check, done, run, skip

TRIM3R, TRIM3R_FLOAT = map(os.path.abspath, sys.argv[1:3])
DATA = os.path.abspath(sys.argv[3])
FLOAT_HEAD = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "quant", "heads", "small.safetensors")
SLACK = 0.25  # dB below the measured value: the most that a newly trained head may lose on a few cases

# Novel views of `small`, default passes, 10 % kept: triplets (first context, second, target), the guaranteed PSNR in dB
# of the whole scene, and the measured one over these triplets. Of the rooms' eleven triplets, an easy, a middling and
# the two hardest.
NOVEL = {
    "hololens_b": (((0, 2, 1), (3, 5, 4), (6, 8, 7), (9, 11, 10)), 22.3, 27.38),
    "icl_livingroom_synth": (((0, 3, 1), (8, 11, 9), (13, 16, 14), (14, 19, 17)), 26.6, 27.35),
    "icl_livingroom_noisy_synth": (((0, 4, 2), (0, 3, 1), (1, 4, 3)), 28.8, 39.11),
}
# On the shelf all triplets count, at 40 to 5 % kept, over which the learned head is level with the analytic one: 0.04 dB
# above it. It was 0.15 dB above before holes were bridged, which raised both by 0.4 dB.
LEVEL = 0.05  # dB
# Every seventh of the 80 colour frames of the test scenes; the PSNR guaranteed for all 80 and the one measured on
# these, by percent kept: `small` with 2 passes on a plane. The eleven are within 0.05 dB of all (36.70 and 34.37), so
# the guarantee applies to them without a margin.
PLANAR = (
    ("icl_livingroom_synth", "130.jpg"), ("icl_livingroom_synth", "20.jpg"), ("icl_livingroom_synth", "80.jpg"),
    ("clip_nyu_2", "1.png"), ("clip_kitti_0", "0.png"), ("clip_scannet_0", "2.png"), ("strecha_fountain", "0004.jpg"),
    ("apc_shelf", "1.png"), ("apc_shelf", "3.png"), ("hololens_b", "00099.png"), ("hololens_b", "00167.png"),
)  # fmt: skip
PLANAR_FLOORS = {"10": (35, 36.75), "5": (33, 34.29)}
QUANTIZATION_MOST = 0.1  # dB that int8 may lose against the same head in floats


def evaluated(program, *options):
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "rows.csv")
        run(program, "eval", *options, "--csv", path)
        with open(path, newline="", encoding="utf-8") as file:
            return list(csv.DictReader(file))


def mean(rows, column, **chosen):
    values = [float(r[column]) for r in rows if all(r[k] == v for k, v in chosen.items())]
    check(values, f"rows with {chosen}")
    return statistics.fmean(values)


def recording(folder, scene):
    path = os.path.join(folder, f"{scene}.mcap")
    run(TRIM3R, "import", os.path.join(DATA, scene), "--size", "256x256", "-o", path)
    return path


def triplets(path, cases, *options):
    rows = []
    for a, b, target in cases:
        rows += evaluated(TRIM3R, path, "--context", f"{a},{b}", "--target", target, "--keep", "10", *options)
    return rows


def novel_views(folder):
    for scene, (cases, promised, measured) in NOVEL.items():
        reached = mean(triplets(recording(folder, scene), cases, "--heads", "small"), "psnr")
        print(f"{scene}, 10 %: {reached:.2f} dB, promised {promised}, measured {measured}")
        check(reached >= promised and reached >= measured - SLACK, f"{scene}: {reached:.2f} dB")


def shelf(folder):
    rows = evaluated(TRIM3R, recording(folder, "apc_shelf"), "--keep", "40,20,10,5", "--heads", "small,analytic")
    learned, analytic = mean(rows, "psnr", head="small"), mean(rows, "psnr", head="analytic")
    print(f"apc_shelf, 40 to 5 %: small {learned:.2f} dB, analytic {analytic:.2f}")
    check(learned >= analytic - LEVEL, f"apc_shelf: {learned:.2f} dB is below the analytic head's {analytic:.2f}")


def planar():
    frames = [os.path.join(DATA, scene, "images", name) for scene, name in PLANAR]
    for passes in ("2", "0"):
        options = ["--planar", *frames, "--size", "256x256", "--keep", "10,5", "--heads", "small", "--refine", passes]
        integers = evaluated(TRIM3R, *options)
        os.environ["T3R_FLOAT_HEAD"] = FLOAT_HEAD
        floats = evaluated(TRIM3R_FLOAT, *options)
        check([r["planar_psnr"] for r in integers] != [r["planar_psnr"] for r in floats], "floats were not used")
        for keep, (promised, measured) in PLANAR_FLOORS.items():
            reached, exact = (mean(rows, "planar_psnr", keep=keep) for rows in (integers, floats))
            print(f"planar, {keep} %, {passes} passes: int8 {reached:.2f} dB, float {exact:.2f}")
            check(reached >= exact - QUANTIZATION_MOST, f"int8 loses {exact - reached:.2f} dB")
            if passes == "2":
                check(reached >= promised and reached >= measured - SLACK, f"planar, {keep} %: {reached:.2f} dB")


splits = os.path.join(DATA, "splits.json")
if not os.path.exists(splits):
    skip(f"no scenes at {DATA}")
with open(splits, encoding="utf-8") as file:
    tested = set(json.load(file)["test"])
check({*NOVEL, "apc_shelf", *(scene for scene, _ in PLANAR)} <= tested, "scenes of the test split alone")
with tempfile.TemporaryDirectory() as folder:
    novel_views(folder)
    shelf(folder)
planar()
done()
