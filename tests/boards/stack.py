#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""stack.py: the stack in docs/study/boards.md, measured in an emulator, against the bound from the call graph. The
measured stack is within the bound plus the firmware's own functions, and the bound is not far above it."""
import pathlib
import re
import subprocess
import sys

from checks import check, done, skip

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent

PAGE = (ROOT / "docs" / "study" / "boards.md").read_text()
TARGETS = {"Cortex-M3": "cortex-m3", "Cortex-M7": "cortex-m7", "Cortex-M55": "cortex-m55"}
OF_FIRMWARE = 1024 # main(), the reader of the recording and the compiler's library
LEAST = 0.7        # relative to the bound: stereo, which the firmware doesn't run, determines it


def bound(target):
    """Returns the bytes of t3r_reconstruct() and everything that it calls."""
    ended = subprocess.run([sys.executable, "-B", "stack_depth.py", target, "--markdown"], cwd=ROOT / "tests" / "proofs",
                           capture_output=True, text=True)
    if ended.returncode == 77:
        skip(ended.stderr.strip() or ended.stdout.strip())
    check(ended.returncode == 0, f"stack_depth.py {target}: {ended.stdout[-500:]}{ended.stderr[-500:]}")
    return int(re.search(r"^\| `t3r_reconstruct` \| (\d+) \|$", ended.stdout, re.M)[1])


painted = {core: [] for core in TARGETS}
for heads, figures in re.findall(r"^\|  \| (Cortex.*) \|$(?s:.*?)^\| stack, bytes \|(.*)\|$", PAGE, re.M):
    for head, figure in zip(heads.split(" | "), figures.split("|")):
        painted[head.split(" ")[0]].append(int(figure.strip().replace(",", "")))
for core, target in TARGETS.items():
    most, paintings = bound(target), painted[core]
    print(f"{core}: a bound of {most} bytes, painted {paintings}")
    check(len(paintings) >= 2, f"{core}: the page has its stack")
    check(max(paintings) <= most + OF_FIRMWARE, f"{core}: {max(paintings)} bytes painted, a bound of {most}")
    check(max(paintings) >= LEAST * most, f"{core}: the bound of {most} bytes is far above {max(paintings)}")
done()
