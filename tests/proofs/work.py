#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""work.py --fit: fits the operations of a unit of each kind of work to instructions of builds in plain C at -O2, and writes
tools/planning/operations.c. The proof `instructions` checks them on builds that the fit did not see: those and their large
stages take within 25 % of the operations that work_count() leads to.
"""
import re
import sys

import proof
from instruction_counts import build, compiler_name, count, need_valgrind

PLANNING = proof.ROOT / "tools" / "planning"
TABLE = PLANNING / "operations.c"
MOST_OFF = 0.25
LARGE = 0.1  # of a build: a stage that is to be within MOST_OFF, too
STAGES = ("image", "depth", "pointmap", "wavelet", "superclusters", "budget", "head", "refine", "raster")
CHECKED_NAME = "checked"
CHECKED = ("checked-1,80,64,2,1024,small,sensor,100,24,1", "checked-2,128,96,1,614,analytic,sensor,200,24,2",
           "checked-3,64,64,3,2458,tiny,sensor,64,8,3", "checked-4,96,96,2,369,analytic,sensor,128,24,0",
           "checked-5,80,80,1,192,analytic,sensor,64,8,2")
FITTED = ("f1,96,96,2,1843,small,sensor,64,24,1", "f2,128,128,2,655,analytic,sensor,300,24,2",
          "f3,96,96,2,3686,tiny,sensor,100,24,1", "f4,128,128,2,1638,small,sensor,64,24,0",
          "f5,64,64,4,1638,analytic,sensor,200,24,2", "f6,64,64,2,8192,small,sensor,300,24,1",
          "f7,160,120,1,384,analytic,sensor,400,24,2", "f8,80,80,2,12800,tiny,sensor,50,24,1",
          "f9,64,64,2,819,analytic,stereo,200,24,0", "f10,96,96,2,1843,analytic,stereo,100,24,0",
          "f11,64,64,1,2048,analytic,sensor,200,0,1", "f12,192,144,2,2765,analytic,sensor,200,24,1",
          "f13,64,64,2,8192,small,sensor,100,8,0", "f14,48,48,1,691,small,sensor,64,24,4",
          "f15,96,96,2,922,small,sensor,64,12,1", "f16,64,64,2,164,analytic,sensor,100,24,2",
          "f17,96,96,2,369,analytic,sensor,100,0,1")
HEADING = """/* SPDX-License-Identifier: Apache-2.0 */
/* Instructions of plain C on x86-64 in 1/1000 a unit of each kind of work, as gcc 12 -O2 makes them.
 * tests/proofs/work.py --fit makes this file. */
#include "planning/work.h"

const work_prices work_operations = {{
"""


def kinds_of_stages():
    """{stage: its kinds of work}, as WORK_KINDS has them."""
    rows = re.findall(r'X\(\w+, "(\w+)", (\w+)\)', (PLANNING / "work.h").read_text())
    return {stage: [name for name, its_stage in rows if its_stage.lower() == stage] for stage in STAGES}


def builds_of(counted, printed):
    """Returns {build: ({stage: instructions}, {kind: units})}."""
    builds = {}
    for line in printed.splitlines():
        name, *words = line.split()
        units = {kind: int(number) for kind, number in (word.split("=") for word in words)}
        builds[name] = {stage: counted.get(f"{name} {stage}", 0) for stage in STAGES}, units
    return builds


def prices_of_table():
    """Returns {kind: 1/1000 operations a unit}."""
    return {kind.lower(): int(price)
            for kind, price in re.findall(r"\[WORK_(\w+)\] = (\d+)", TABLE.read_text())}


def operations(units, prices, kinds):
    return sum(units[kind] * prices[kind] for kind in kinds) / 1000


def check(builds, prices):
    """Returns findings that are more than MOST_OFF away."""
    findings, kinds = [], kinds_of_stages()
    for name, (stages, units) in builds.items():
        expected = {stage: operations(units, prices, kinds[stage]) for stage in STAGES}
        total = sum(stages.values()) - stages["raster"]
        sums = {**{stage: (expected[stage], stages[stage]) for stage in STAGES},
                "build": (sum(expected.values()) - expected["raster"], total)}
        for what, (predicted, real) in sums.items():
            off = predicted / real - 1 if real else 0
            if real >= LARGE * total and abs(off) > MOST_OFF:
                findings.append(f"{name}: {what} takes {real / 1e6:.1f} M instructions, predicted {100 * off:+.0f} %")
        if abs(units["operations"] / sums["build"][0] - 1) > 0.001:
            findings.append(f"{name}: work_price_of_build() says {units['operations']}, the prices {sums['build'][0]:.0f}")
    return findings


def findings(counted, printed):
    """Returns the builds CHECKED among the counted ones."""
    builds = {name: both for name, both in builds_of(counted, printed).items() if name.startswith(CHECKED_NAME)}
    prices = prices_of_table()
    proof.must_find(check(builds, {**prices, "batches": 9 * prices["batches"]}), "superclusters", "the prices")
    return check(builds, prices)


def solve(rows):
    """Returns prices of at least 0 that minimise the sum of squared relative errors of [(units, total)]."""
    scaled = [[unit / total for unit in units] for units, total in rows]
    prices, left = [0.0] * len(scaled[0]), [1.0] * len(rows)
    for _ in range(20000):  # coordinate descent
        for k in range(len(prices)):
            norm = sum(row[k] ** 2 for row in scaled)
            if norm > 0:
                to = max(0.0, prices[k] + sum(gap * row[k] for gap, row in zip(left, scaled)) / norm)
                left = [gap - (to - prices[k]) * row[k] for gap, row in zip(left, scaled)]
                prices[k] = to
    return prices


def fit(builds):
    found = {}
    for stage, kinds in kinds_of_stages().items():
        rows = [([units[kind] for kind in kinds], stages[stage]) for stages, units in builds.values()
                if stages[stage] and any(units[kind] for kind in kinds)]
        found.update(zip(kinds, solve(rows)))
    return {kind: round(1000 * price) for kind, price in found.items()}


def main():
    need_valgrind()
    if sys.argv[1:] != ["--fit"] or not compiler_name().startswith("gcc 12."):
        sys.exit("work.py --fit, with gcc 12")
    with proof.scratch() as folder:
        builds = builds_of(*count(build(folder), folder, FITTED))
    prices = fit(builds)
    rows = "".join(f"    [WORK_{kind.upper()}] = {price},\n" for kind, price in prices.items())
    TABLE.write_text(HEADING + rows + "}};\n")


if __name__ == "__main__":
    main()
