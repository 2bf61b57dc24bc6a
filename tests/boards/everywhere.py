#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""everywhere.py TRIM3R FOLDER [PROCESSOR...]: tools/everywhere finds the bits of this machine in each row of these
processors (all), notices one hash that differs, and docs/study/boards.md has the hashes of today."""
import copy
import importlib.machinery
import importlib.util
import json
import pathlib
import subprocess
import sys

from checks import check, done, skip

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
TOOL = ROOT / "tools" / "everywhere"

PROGRAM, FOLDER, PROCESSORS = sys.argv[1], sys.argv[2], sys.argv[3:]
PAGE = (ROOT / "docs" / "study" / "boards.md").read_text()
ROWS_LEAST = 18

loader = importlib.machinery.SourceFileLoader("everywhere", str(TOOL))
everywhere = importlib.util.module_from_spec(importlib.util.spec_from_loader("everywhere", loader))
loader.exec_module(everywhere)

ended = subprocess.run([sys.executable, "-B", TOOL, "--program", PROGRAM, "--out", FOLDER, "--json", *PROCESSORS],
                       capture_output=True, text=True)
if ended.returncode == 77:
    skip(ended.stderr.strip())
check(ended.returncode == 0, f"tools/everywhere: {ended.returncode}\n{ended.stderr}")
said = json.loads(ended.stdout)
compared = [row for row in said["rows"] if row["hashes"] is not None]
for row in said["rows"]:
    print(row["processor"], row["compiler"], row["variant"], row["skipped"] or "same")
check(len(compared) >= (len(PROCESSORS) or ROWS_LEAST), f"{len(compared)} rows were compared")
for row in compared:
    check(everywhere.first_difference(row, said["expected"]) is None, f"{row['processor']}, {row['variant']}")
for case, stages in said["expected"].items():
    for stage in stages:
        other = copy.deepcopy(compared[0])
        other["hashes"][case][stage] = "0" * 16
        check(everywhere.first_difference(other, said["expected"]) == f"{case}, {stage}", f"blind to {case}, {stage}")
whole = [stages["final"] for stages in said["expected"].values()]
same = [variant for line in PAGE.splitlines() if all(f"`{final}`" in line for final in whole)
        for variant in line.split(" | ")[2].split("; ")]
check(len(same) >= ROWS_LEAST, f"docs/study/boards.md has {len(same)} rows with {whole}: tools/everywhere --write")
done()
