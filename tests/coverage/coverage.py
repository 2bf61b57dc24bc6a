#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Counts which branches of the runtime the tests take, and holds the others against uncovered.txt.

    coverage.py FOLDER             builds in the folder, runs, counts
    coverage.py FOLDER --write     and writes docs/study/proofs.md
    coverage.py FOLDER --again     counts what ran there before
    coverage.py FOLDER --list      and prints what no test takes, as uncovered.txt has it

A branch is one way out of a condition, as gcc lays it without optimization: `if (a && b)` has four. gcov says how often
each was taken. Exit 0: 95 % are taken, and uncovered.txt explains the others and nothing else; 1: not so; 77: a tool is
absent (tools/setup --tests).
"""
import argparse
import collections
import pathlib
import shutil
import sys
import tempfile

import branches
import planted
import reasons
import runs

sys.path.append(str(branches.ROOT / "tools" / "study" / "scripts"))
from measured import table, write_block  # noqa: E402

LEAST_PERCENT = 95
PAGE = branches.ROOT / "docs" / "study" / "proofs.md"


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=pathlib.Path, help="folder of the build")
    parser.add_argument("--write", action="store_true", help="put the table into docs/study/proofs.md")
    parser.add_argument("--again", action="store_true", help="count what ran before")
    parser.add_argument("--list", action="store_true", help="print what is not taken, with its lines")
    options = parser.parse_args()
    options.folder = options.folder.resolve()
    return options


def measure(folder):
    folder.mkdir(parents=True, exist_ok=True)
    runs.build(folder)
    runs.forget(folder)
    runs.run_tests(folder)
    with tempfile.TemporaryDirectory(prefix="trim3r-coverage-") as scratch:
        runs.run_program(folder / "trim3r", pathlib.Path(scratch))


def share(all_branches, taken):
    return 100 * taken / all_branches


def files_of(counted):
    """Returns {file: (branches, those taken)}."""
    files = collections.defaultdict(lambda: (0, 0))
    for (file, *_), ways in counted.items():
        known, taken = files[file]
        # below 0: gcov subtracts counts, and concurrent threads lose some counts
        files[file] = (known + len(ways), taken + sum(count != 0 for count in ways))
    return files


def row(file, known, taken):
    return [file, f"{known:,}", f"{taken:,}", f"{share(known, taken):.1f}"]


def write(files, known, taken):
    """Puts all files together, and those of which less is taken than of all must be, into the page."""
    low = sorted((share(*counts), file) for file, counts in files.items() if share(*counts) < LEAST_PERCENT)
    rows = [row("all", known, taken), *(row(f"`{file}`", *files[file]) for _, file in low)]
    write_block(PAGE, "coverage", table(("file of `runtime/`", "branches", "taken", "%"), rows))


def main():
    options = arguments()
    for tool in ("gcov", "cmake", "ctest"):
        if shutil.which(tool) is None:
            print(f"SKIPPED: no {tool} here (tools/setup --tests)")
            sys.exit(77)
    planted.find()
    if not options.again:
        measure(options.folder)
    counted = branches.counted(options.folder)
    if not counted:
        sys.exit(f"{options.folder}: nothing ran here")
    files = files_of(counted)
    known, taken = (sum(numbers) for numbers in zip(*files.values()))
    for file in sorted(files):
        print(" ".join(row(file, *files[file])))
    print(f"{taken} of {known} branches, {share(known, taken):.2f} %")
    uncovered = branches.uncovered(counted)
    if options.list:
        print("\n".join(reasons.line_for(place, count) for place, count in sorted(uncovered.items())))
    if options.write:
        write(files, known, taken)
    broken = reasons.disagreements(uncovered, reasons.read(reasons.FILE.read_text()))
    if share(known, taken) < LEAST_PERCENT:
        broken.insert(0, f"{share(known, taken):.2f} % of the branches are taken, and {LEAST_PERCENT} % must be")
    if broken:
        sys.exit("\n".join(broken))


if __name__ == "__main__":
    main()
