#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Counts which branches of the runtime the tests take, and holds the others against uncovered.txt.

    coverage.py FOLDER             builds in the folder, runs, counts
    coverage.py FOLDER --write     and writes docs/study/coverage.md
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

LEAST_PERCENT = 95
PAGE = branches.ROOT / "docs" / "study" / "coverage.md"
TEXT = """# Branches that the tests take

Made by `tests/coverage/coverage.py --write` with gcov {version}. A branch is one way out of a condition, as gcc lays it
without optimization: `if (a && b)` has four. At night a test counts anew: at least {least} % must be taken, and
[uncovered.txt](../../tests/coverage/uncovered.txt) must explain each of the others.

What runs are the programs in C of `tests/unit`, `tests/oracle`, `tests/workers`, `tests/kernels` and `tests/formats`, the
driver of the golden hashes, and `trim3r` on the built-in room. Fuzzers and tests on recorded scenes do not count. Kernels for
vector instructions are left out: gcov counts functions that must be inlined once for each caller, and `tests/kernels`
compares each kernel with plain C.

Of {all} branches {taken} are taken, {share:.2f} %.

| file of `runtime/` | branches | taken | % |
|---|---:|---:|---:|
{rows}
"""


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=pathlib.Path, help="folder of the build")
    parser.add_argument("--write", action="store_true", help="write docs/study/coverage.md")
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
    for (file, _, _), ways in counted.items():
        known, taken = files[file]
        # below 0: gcov subtracts counts, and concurrent threads lose some counts
        files[file] = (known + len(ways), taken + sum(count != 0 for count in ways))
    return files


def row(file, known, taken):
    return f"| {file} | {known:,} | {taken:,} | {share(known, taken):.1f} |"


def write(files, known, taken):
    rows = "\n".join(row(f"`{file}`", *files[file]) for file in sorted(files))
    PAGE.write_text(TEXT.format(version=branches.version(), least=LEAST_PERCENT, all=f"{known:,}", taken=f"{taken:,}",
                                share=share(known, taken), rows=rows))


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
        print(row(file, *files[file]))
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
