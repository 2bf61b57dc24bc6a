#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""boards.py TRIM3R FOLDER BOARD...: the firmware of each board makes the bits of this machine, has the sizes in
docs/study/boards.md, and says what it lacks. The boards share a port."""
import json
import pathlib
import re
import subprocess
import sys

from checks import check, done, near, skip
from firmware import BOARDS, STAGES

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent

PROGRAM, FOLDER, OWN = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]), sorted(sys.argv[3:])
PAGE = (ROOT / "docs" / "study" / "boards.md").read_text()
SECTION = re.search(r"## The head `small`\n(.*?)\n## ", PAGE, re.S)[1]
TABLE = next(part for part in SECTION.split("\n\n") if BOARDS[OWN[0]]["name"] in part)
NAMES = next(line for line in TABLE.splitlines() if line.startswith("|")).strip("| ").split(" | ")
TOLERANCE = 0.02 # another version of the compiler


def boards(*words, expect=0):
    command = [sys.executable, "-B", ROOT / "tools" / "boards", "--program", PROGRAM, "--out", FOLDER, *words]
    ended = subprocess.run([str(word) for word in command], capture_output=True, text=True)
    if ended.returncode == 77:
        skip(ended.stderr.strip())
    check(ended.returncode == expect, f"tools/boards {' '.join(words)}: {ended.returncode}\n{ended.stdout}{ended.stderr}")
    return ended


def shown(label, name):
    """Returns a figure from the page, for the firmware with this name."""
    row = re.search(rf"^\| {re.escape(label)} \|(.*)\|$", TABLE, re.M)
    check(row is not None, f"the page has no row {label}")
    check(name in NAMES, f"the page has no column {name}")
    return float(row[1].split("|")[NAMES.index(name)].strip().replace(",", ""))


said = json.loads(boards("--json", *OWN).stdout)
check(said["bits"] == "same", "every board has the bits of this machine")
check(set(said["host"]) == set(STAGES), f"every stage has a hash: {said['host']}")
check(len({(row["hash"], *row["hashes"].items()) for row in said["boards"]}) == 1, "the boards agree")
check(sorted({row["board"] for row in said["boards"]}) == OWN, "each board has its rows")
for row in said["boards"]:
    check(row["gaussians"] == 819, f"{row['name']}: the budget is exact")
    for key in ("flash", "RAM", "arena", "stack"):
        figure = shown(f"{key}, bytes", row["name"])
        near(row[f"{key.lower()}_bytes"], figure, TOLERANCE * figure, f"{row['name']}: {key} as on the page")
    check(row["stack_bytes"] <= 12288, f"{row['name']}: the stack is bounded")
    picture = pathlib.Path(row["view"]).read_bytes()
    check(picture.startswith(b"P6 64 64 255\n") and len(picture) == 13 + 64 * 64 * 3, "the view is a picture")
    if "instructions_of" in row:
        for stage in STAGES:
            figure = shown(f"{stage}, M", row["name"])
            near(row["instructions_of"][stage] / 1e6, figure, TOLERANCE * figure + 0.06, f"{row['name']}: {stage}")
        check(row["longest_stretch"] <= 20_000_000, f"{row['name']}: a watchdog is fed every 20 million instructions")

lacking = boards(OWN[0], "--ram", "128K", expect=1).stderr
check("lacks this many bytes" in lacking, f"a small board says what it lacks: {lacking}")
check("there is no board" in boards("teapot", expect=2).stderr, "a board that is not there is named")
broken = FOLDER / "broken.mcap"
broken.write_bytes(b"no recording")
check("this is no MCAP file" in boards(OWN[0], "--recording", str(broken), expect=1).stderr, "and a bad recording")
done()
