#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""stress_recorded.py TRIM3R SHARED_DATA: the guarantees for a still scene, on the recorded test scenes with sensor
depth at 256x256, from few Gaussians to half of the points, with the shipped head and refinement."""
import json
import os
import sys
import tempfile

from checks import check, done, run, skip

TRIM3R, DATA = os.path.abspath(sys.argv[1]), os.path.abspath(sys.argv[2])
SCENES = ("hololens_b", "icl_livingroom_synth", "icl_livingroom_noisy_synth", "apc_shelf")
CLUSTERS = 300

if not os.path.exists(os.path.join(DATA, "splits.json")):
    skip(f"no scenes at {DATA}")
with tempfile.TemporaryDirectory() as folder:
    recordings = [os.path.join(folder, f"{scene}.mcap") for scene in SCENES]
    for scene, recording in zip(SCENES, recordings):
        run(TRIM3R, "import", os.path.join(DATA, scene), "--size", "256x256", "-o", recording)
    answer = json.loads(run(TRIM3R, "stress", *recordings, "--rows", "exposure", "--strengths", "1", "--keep", "2,10,50",
                            "--json").stdout)
check(answer["broken"] == 0, "no invariant breaks")
still = [row for row in answer["rows"] if row["perturbation"] == "unperturbed"]
check(len(still) == 3 * len(SCENES), f"{len(still)} still scenes")
for row in still:
    print(f"{row['scene']} {row['keep']:g} %: {row['mask_changed'] * 100:.1f} % of the mask changes, motion {row['motion']:.2f}")
    check(row["gaussians"] >= CLUSTERS and row["mask_changed"] > 0, "the invariant covers these rows")
done()
