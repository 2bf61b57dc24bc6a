#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""budgets.py TRIM3R BUDGETS: the example writes a file for each budget, with exactly so many Gaussians, and one for the
decibels. A missing recording is named."""
import pathlib
import re
import subprocess
import tempfile

from checks import check, done, run
from common import EXAMPLE, room

with tempfile.TemporaryDirectory() as folder:
    room(f"{folder}/room.mcap", 128, 2)
    said = run(EXAMPLE, f"{folder}/room.mcap", f"{folder}/scene").stdout
    files = [pathlib.Path(name) for name in re.findall(r"\S+\.ply", said)]
    counts = [int(re.search(rb"element vertex (\d+)", path.read_bytes())[1]) for path in files]
    check(counts[:3] == [2000, 1000, 500] and len(counts) == 4, f"a file for each budget: {said}")
    check([path.name for path in files] == [f"scene-{count}.ply" for count in counts], f"by their names: {said}")
    check(float(re.search(r"([\d.]+) dB", said)[1]) >= 26, f"the last one has the decibels: {said}")
    ended = subprocess.run([EXAMPLE, f"{folder}/absent.mcap", "x"], capture_output=True, text=True, check=False)
    check(ended.returncode == 1 and "absent.mcap" in ended.stderr, f"a missing recording: {ended.stderr}")
done()
