#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""flash.py TRIM3R FOLDER: the flash of small firmwares stays within its limits and agrees with docs/study/boards.md.
Their hashes equal this machine's."""
import json
import pathlib
import re
import subprocess
import sys

from checks import check, done, near, skip

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent

PROGRAM, FOLDER = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
SECTION = (ROOT / "docs" / "study" / "boards.md").read_text().split("\n## Flash\n")[1]
LIMITS = {"one view, `analytic`": 48 << 10, "one view, `tiny`, refinement": 80 << 10,
          "one view, `small`, refinement": 110 << 10}
TOLERANCE = 0.02 # another version of the compiler


def shown(name):
    row = re.search(rf"^\| {re.escape(name)} \|[^|]*\| ([\d,]+) \|", SECTION, re.M)
    check(row is not None, f"the page has a row {name}")
    return int(row[1].replace(",", ""))


def boards(*words):
    ended = subprocess.run([sys.executable, "-B", ROOT / "tools" / "boards", "--program", PROGRAM, "--out", FOLDER,
                            *words], capture_output=True, text=True, check=False)
    if ended.returncode == 77:
        skip(ended.stderr.strip())
    return ended


said = boards("--flash", "--json")
check(said.returncode == 0, f"tools/boards --flash: {said.returncode}\n{said.stdout}{said.stderr}")
rows = {row["name"]: row for row in json.loads(said.stdout)}
for name, row in rows.items():
    check(row["bits"] == "same", f"{name}: the bits of this machine")
    near(row["flash_bytes"], shown(name), TOLERANCE * row["flash_bytes"], f"{name}: as on the page")
for name, most in LIMITS.items():
    check(rows[name]["flash_bytes"] <= most, f"{name}: {rows[name]['flash_bytes']} bytes, at most {most}")
refused = boards("mps2-an500", "--features", "refinement,warp")
check("there is no feature warp" in refused.stderr, f"a feature that is not there is named: {refused.stderr}")
done()
