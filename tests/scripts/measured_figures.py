#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""measured_figures.py SCRIPTS: functions shared by the scripts that measure: tables, means, blocks of a file,
triplets, and files that are made once for each program and command."""
import contextlib
import io
import json
import os
import stat
import subprocess
import sys
import tempfile
import time
import xml.dom.minidom

from checks import check, done

sys.path.insert(0, sys.argv[1])
sys.dont_write_bytecode = True
import measured  # noqa: E402

# writes its arguments to the last of them, records the call, and fails once on request
PROGRAM = """#!/bin/sh
if [ "$1" = --version ]; then
    echo "trim3r 1.0, bits epoch 7"
    exit
fi
echo "$*" >>"{folder}/calls"
for last; do :; done
echo "part of $*" >"$last"
echo "told $1"
if [ "$1" = fails ] && [ ! -e "{folder}/failed" ]; then
    touch "{folder}/failed"
    exit 1
fi
# {version}
"""


def raises(kind, function, *arguments):
    with contextlib.redirect_stderr(io.StringIO()):
        try:
            function(*arguments)
        except kind as error:
            return str(error) or repr(error)
    check(False, f"{function.__name__}{arguments} raises no {kind.__name__}")


def read(path):
    with open(path, encoding="utf-8") as file:
        return file.read()


def write(path, text):
    with open(path, "w", encoding="utf-8") as file:
        file.write(text)
    return path


def tables_and_means(folder):
    lines = list(measured.table(("a", "b"), [["1", "2"], ["3", "4"]]))
    check(lines == ["| a | b |", "|---|---|", "| 1 | 2 |", "| 3 | 4 |"], f"a table: {lines}")
    rows = [{"keep": "10", "psnr": "20"}, {"keep": "5", "psnr": "7"}, {"keep": "10", "psnr": "23"}]
    check(measured.means(rows, "psnr", "keep") == {"10": 21.5, "5": 7}, "means by a column")
    check(measured.listed((3, "a", 5)) == "3,a,5", "a list")

    page = write(f"{folder}/page.md", "before\n<!-- x:begin -->\nold\nlines\n<!-- x:end -->\nafter\n<!-- y:begin -->\n"
                 "kept\n<!-- y:end -->\n")
    new = "before\n<!-- x:begin -->\nnew\n<!-- x:end -->\nafter\n<!-- y:begin -->\nkept\n<!-- y:end -->\n"
    for _ in range(2):
        measured.write_block(page, "x", ["new"])
        check(read(page) == new, f"a block is replaced, nothing else: {read(page)}")
    raises(ValueError, measured.write_block, page, "z", ["lost"])
    check(read(page) == new, "a file without the mark is left as it is")


    check(list(measured.titled("aab", [["1"], ["2"], ["3"]])) == [["a", "1"], ["", "2"], ["b", "3"]], "a name once")


def triplets():
    still = {"context": [3, 3], "target": 3}
    told = {"triplets": [{"context": [0, 2], "target": 1}, still, {"context": [4, 9], "target": 6}]}
    check(measured.triplets(told) == [("0,2", "1"), ("4,9", "6")], "as eval's options want them, none of one frame")
    check(measured.evenly(list(range(10)), 4) == [0, 2, 5, 7], "four of ten, evenly")
    check(measured.evenly([1, 2], 4) == [1, 2], "fewer where there are fewer")


def pictures(folder):
    pyplot = measured.pyplot()
    for name in ("a", "b"):
        figure, axes = pyplot.subplots()
        axes.plot([1, 2], [3, 4], "o-")
        measured.save(figure, f"{folder}/{name}.svg")
        xml.dom.minidom.parse(f"{folder}/{name}.svg")
    check(read(f"{folder}/a.svg") == read(f"{folder}/b.svg"), "the same bytes again")
    check(all(len(line) > 1 for line in read(f"{folder}/a.svg").splitlines()), "an element a line")


def program(folder, version):
    path = write(f"{folder}/program", PROGRAM.format(folder=folder, version=version))
    os.chmod(path, stat.S_IRWXU)
    return path


def kept_files(folder):
    def calls():
        return read(f"{folder}/calls").splitlines() if os.path.exists(f"{folder}/calls") else []

    def measurements(version):
        return measured.Measurements("test", program(folder, version), f"{folder}/cache")

    said = raises(SystemExit, measured.Measurements, "test", f"{folder}/none", f"{folder}/cache")
    check("none is not there" in said, said)
    measured.DATA = f"{folder}/data"
    m = measurements(1)
    check("data/one is not there" in raises(SystemExit, m.scene, "one"), "a scene that is not there is named")
    check(measured.bits_epoch(m.program) == "7", "the epoch of its figures")

    with contextlib.redirect_stderr(io.StringIO()):
        path, log = m.made("a.txt", [m.program, "make", "OUT"])
        check(os.path.dirname(path) == m.folder and path.endswith(".txt"), f"kept by its name: {path}")
        check(read(log) == "told make\n" and read(path).startswith("part of make "), "the file and what was told")
        check(m.made("a.txt", [m.program, "make", "OUT"]) == (path, log) and len(calls()) == 1, "made once")
        other, _ = m.made("a.txt", [m.program, "else", "OUT"])
        check(other != path and len(calls()) == 2, "another command is another file")
        check(measurements(1).made("a.txt", [m.program, "make", "OUT"])[0] == path and len(calls()) == 2, "found again")
        newer = measurements(2)
        check(newer.folder != m.folder, "another program has files of its own")
        again, _ = newer.made("a.txt", [newer.program, "make", "OUT"])
        check(again != path and os.path.exists(path) and len(calls()) == 3, "made again when the program changed")

        command = [newer.program, "fails", "OUT"]
        raises(subprocess.CalledProcessError, newer.made, "b.txt", command)
        check(not os.path.exists(newer.path("b.txt", command)), "what failed is not kept as made")
        path, _ = newer.made("b.txt", command)
        check(read(path).startswith("part of fails") and len(calls()) == 5, f"and is made anew: {calls()}")

        seen = []
        check(m.kept("c", 1, lambda: seen.append(1) or {"a": 1}) == m.kept("c", 1, list) == {"a": 1}, "a value is kept")
        check(m.kept("c", 2, lambda: [2]) == [2] and seen == [1], "for its settings")


def side_by_side(folder):
    """As many measurements at a time as there are cores, one that is timed alone, and each once."""
    m = measured.Measurements("test", program(folder, 3), f"{folder}/cache")
    now, most, alone = [], [], []

    def measure(i):
        def make():
            now.append(i)
            most.append(len(now))
            time.sleep(0.02)
            if i == 5:
                alone.extend(now)
            now.remove(i)
            return i

        return m.kept("d", i % 8, make, alone=i == 5)

    with contextlib.redirect_stderr(io.StringIO()) as said:
        found = m.each(measure, range(16))
    check(found == [*range(8), *range(8)], f"in order: {found}")
    check(len(most) == 8 and max(most) <= measured.CORES, f"each once, no more than there are cores: {most}")
    check(alone == [5], f"timed alone: {alone}")
    check("test: 8 measured" in said.getvalue(), f"what is going on: {said.getvalue()}")


with tempfile.TemporaryDirectory() as scratch:
    tables_and_means(scratch)
    triplets()
    pictures(scratch)
    kept_files(scratch)
    side_by_side(scratch)
done()
