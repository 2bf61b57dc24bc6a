#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""stereo_scenes.py TRIM3R SHARED_DATA: what colours alone reach on real scenes at 256x256, held to what was measured:
rooms, a fountain, a drive forward. tools/study/scripts/colours compares with other methods."""
import csv
import json
import os
import sys
import tempfile

from checks import check, done, run, skip

TRIM3R, DATA = os.path.abspath(sys.argv[1]), os.path.abspath(sys.argv[2])
SLACK = 0.5  # dB below what was measured
# Of the test split: context views, target, PSNR in dB of `small` at 10 % kept on the pixels that a context view saw by the
# sensor's depth, or of the whole picture where there is no sensor.
CASES = {
    "clip_nyu_2": ((2, 3), 5, 24.40),
    "clip_scannet_0": ((0, 2), 3, 32.42),
    "clip_kitti_0": ((1, 3), 2, 22.31),
    "strecha_fountain": ((0, 2), 1, 30.05),
    "hololens_b": ((3, 5), 4, 30.76),
}

if not os.path.exists(os.path.join(DATA, "splits.json")):
    skip(f"no scenes at {DATA}")
with open(os.path.join(DATA, "splits.json"), encoding="utf-8") as file:
    check(set(CASES) <= set(json.load(file)["test"]), "scenes of the test split alone")
with tempfile.TemporaryDirectory() as folder:
    table = os.path.join(folder, "rows.csv")
    for scene, (context, target, measured) in CASES.items():
        recording = os.path.join(folder, f"{scene}.mcap")
        run(TRIM3R, "import", os.path.join(DATA, scene), "--size", "256x256", "-o", recording)
        run(TRIM3R, "eval", recording, "--context", ",".join(map(str, context)), "--target", target, "--keep", "10",
            "--depth", "stereo", "--csv", table)
        with open(table, newline="", encoding="utf-8") as file:
            row = next(csv.DictReader(file))
        print(f"{scene} {row['context']}, 10 %: {row['psnr']} dB, measured {measured}, holes {row['holes']}")
        check(float(row["psnr"]) >= measured - SLACK, f"{scene}: {row['psnr']} dB")
        check(float(row["holes"]) < 0.05, f"{scene}: {row['holes']} of the mask are holes")
        check(int(row["arena_bytes"]) <= 5 << 20, f"{scene}: {row['arena_bytes']} bytes of arena")
done()
