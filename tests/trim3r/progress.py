#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""progress.py TRIM3R: the progress of long commands on a terminal: the part done, and for an evaluation the rows and
the remaining time, estimated from this run; nothing if stderr is no terminal."""
import os
import re
import subprocess
import tempfile

from checks import check, done
from program import TRIM3R, expect
from terminal import on_terminal

CLEARED = "\r\x1b[K"
ROWS = re.compile(r"\r(\d+) of (\d+) rows(?:, (\d+) (s|min) left)?")


def shown(*command, expect=0):
    """Returns what the program writes to stderr on a terminal."""
    status, text = on_terminal([TRIM3R, *map(str, command)], both=False, env=os.environ | {"NO_COLOR": "1"})
    check(status == expect, f"{command}: {status} {text}")
    return text


def told(text):
    """Returns [(rows done, rows in all, whether the time left is printed)]."""
    return [(int(count), int(total), left != "") for count, total, left, _ in ROWS.findall(text)]


with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    expect(0, "room", "--size", "64x64", "-o", "room.mcap")

    text = shown("room", "--size", "320x240", "--frames", 24, "-o", "long.mcap")
    percents = [int(p) for p in re.findall(r"\rdrawing the room +(\d+) %", text)]
    check(len(percents) > 1 and percents == sorted(percents) and percents[-1] < 100, f"the part that is done: {percents}")
    check(text.endswith(CLEARED), f"the line is gone at the end: {text[-50:]!r}")

    call = ("eval", "room.mcap", "--keep", "60,40,20,10", "--csv", "rows.csv")
    lines = told(shown(*call))
    with open("rows.csv") as file:
        table = file.read().splitlines(keepends=True)
    total = len(table) - 1
    check(total > 4 and {line[1] for line in lines} == {total}, f"{total} rows in all: {lines}")
    counts = [line[0] for line in lines]
    check(sorted(set(counts)) == list(range(total)) and counts == sorted(counts), f"each row is told, in order: {counts}")
    check(all(timed == (count > 0) for count, _, timed in lines), f"a time is left from the first row on: {lines}")

    there = total // 2
    with open("rows.csv", "w") as file:
        file.writelines(table[: 1 + there])
    lines = told(shown(*call, "--resume"))
    check({line[0] for line in lines} == set(range(total)), f"rows that were there are counted: {lines}")
    check(all(timed == (count > there) for count, _, timed in lines), f"the time is that of the rows made now: {lines}")

    text = shown("eval", "room.mcap", "--keep", 10, "--images", "rows.csv/none", "--csv", "one.csv", expect=1)
    check(re.search(r"(^|\x1b\[K)trim3r eval: [^\r]*\r\n", text), f"a message has its line to itself: {text!r}")

    ended = subprocess.run([TRIM3R, *call], capture_output=True, text=True, timeout=300)
    check(ended.returncode == 0 and ended.stderr == "", f"no progress where there is no terminal: {ended.stderr!r}")
done()
