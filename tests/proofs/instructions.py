#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""instructions.py [--update]: no stage takes more instructions than instructions.txt allows. callgrind counts those of
two small builds in plain C at -O2; other programs on the machine do not disturb the counts. The runtime predicts the
operations of other builds (work.py). --update rewrites the table.

The compiler's version is part of the table: another one makes other instructions, and skips the proof.
"""
import sys

import proof
import work
from instruction_counts import build, compiler_name, count, need_valgrind, skip

TABLE = proof.HERE / "instructions.txt"
BUILDS = ("small,96,96,2,1843,small,sensor,64,24,4", "stereo,96,96,2,1843,analytic,stereo,64,24,4")
MOST_ABOVE = 0.03  # relative to the table
MUCH_BELOW = 0.03
HEADING = """# Instructions of each stage of two small builds, in plain C at -O2 (instructions_driver.c), counted by callgrind.
# tests/proofs/instructions.py --update writes them. The compiler's version is part of the table.
compiler {}
"""


def table_of(text):
    """Returns (the compiler, {"build stage": instructions})."""
    compiler, rows = "", {}
    for line in text.splitlines():
        words = line.split()
        if line.startswith("compiler "):
            compiler = " ".join(words[1:])
        elif words and not line.startswith("#"):
            rows[" ".join(words[:-1])] = int(words[-1])
    return compiler, rows


def check(allowed, found):
    findings = [f"{stage}: not in the table; instructions.py --update" for stage in found.keys() - allowed.keys()]
    findings += [f"{stage}: in the table alone; instructions.py --update" for stage in allowed.keys() - found.keys()]
    for stage in found.keys() & allowed.keys():
        share = found[stage] / allowed[stage] - 1
        if share > MOST_ABOVE:
            findings.append(f"{stage}: {found[stage]} instructions, {100 * share:.1f} % more than {allowed[stage]}")
    return sorted(findings)


def write(compiler, found):
    width = max(map(len, found))
    rows = "".join(f"{stage:<{width}} {number:>12}\n" for stage, number in found.items())
    TABLE.write_text(HEADING.format(compiler) + rows)


def main():
    compiler, update = compiler_name(), sys.argv[1:] == ["--update"]
    known, allowed = table_of(TABLE.read_text()) if TABLE.exists() else ("", {})
    need_valgrind()
    if compiler != known and not update:
        skip(f"the table is of {known}, this is {compiler}")
    with proof.scratch() as folder:
        counted, printed = count(build(folder), folder, BUILDS + (() if update else work.CHECKED))
    found = {stage: number for stage, number in counted.items() if not stage.startswith(work.CHECKED_NAME)}
    if update:
        write(compiler, found)
        return
    most = max(allowed, key=allowed.get)
    proof.must_find(check({**allowed, most: int(found[most] / 1.04)}, found), f"{most}: ", "the table of instructions")
    for stage in sorted(found.keys() & allowed.keys()):
        if found[stage] < allowed[stage] * (1 - MUCH_BELOW):
            print(f"{stage}: {found[stage]} instructions, {100 - 100 * found[stage] / allowed[stage]:.0f} % fewer than the "
                  "table's: instructions.py --update")
    off = work.findings(counted, printed)
    proof.verdict("no stage takes 3 % more instructions than the table has; operations are predicted within 25 %",
                  check(allowed, found) + off)


if __name__ == "__main__":
    sys.exit(main())
