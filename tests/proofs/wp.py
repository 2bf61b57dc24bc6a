#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""wp.py: WP of Frama-C proves the contracts of functions of fixed.h in tests/proofs/frama/contracts.h.

Goals that WP's own simplifier cannot prove go to Z3 through Why3. Exit 77: a tool is absent (tools/setup --tests).
"""
import os
import pathlib
import re
import shutil
import sys
import tempfile

import proof

DRIVERS = proof.HERE / "frama"
TOOLS = ("frama-c", "why3", "z3")
SECONDS_A_GOAL = 20 # on a busy machine; on an idle one each takes less than one


def functions_of(header):
    return re.findall(r"^static inline \w+ (t3r_\w+)\(", header.read_text(), flags=re.M)


def unproven(driver, functions=()):
    """Returns the unproven goals, and the number of goals."""
    includes = f"-std=c11 -I {proof.RUNTIME / 'include'} -I {proof.RUNTIME} -I {DRIVERS} -include {DRIVERS / 'frama.h'}"
    chosen = ["-wp-fct", ",".join(functions)] if functions else []
    result = proof.run(["frama-c", "-no-unicode", "-machdep", "gcc_x86_64", "-c11", f"-cpp-extra-args={includes}", "-wp",
                        "-wp-prover", "z3", "-wp-par", "2", "-wp-timeout", str(SECONDS_A_GOAL), *chosen, driver])
    said = re.search(r"Proved goals: +(\d+) / (\d+)", result.stdout)
    if result.returncode != 0 or said is None:
        proof.broken(f"Frama-C does not read {driver}", (result.stdout + result.stderr).splitlines())
    missing = re.findall(r"Goal (typed_\w+) : (?!Valid)", result.stdout)
    if len(missing) != int(said[2]) - int(said[1]):
        proof.broken("goals are not told apart", result.stdout.splitlines())
    return missing, int(said[2])


def main():
    for tool in TOOLS:
        if shutil.which(tool) is None:
            print(f"SKIPPED: no {tool} here (tools/setup --tests)")
            sys.exit(77)
    with tempfile.TemporaryDirectory(prefix="trim3r-wp-") as folder:
        os.environ["WHY3CONFIG"] = str(pathlib.Path(folder) / "why3.conf")
        proof.run(["why3", "config", "detect"])
        missing, _ = unproven(proof.PLANTED / "frama" / "contract.c")
        proof.must_find(missing, "down_ensures_rounded", "contract.c")
        functions = functions_of(DRIVERS / "contracts.h")
        missing, goals = unproven(DRIVERS / "contracts.c", functions)
    proof.verdict(f"{goals} goals about results of {', '.join(functions)}", missing)


if __name__ == "__main__":
    main()
