# SPDX-License-Identifier: Apache-2.0
"""Errors that the coverage's test must find: planted branches, a missing reason, an extra reason, a low share."""
import pathlib
import tempfile

import branches
import reasons
import runs

PLANTED = pathlib.Path(__file__).resolve().parent / "planted"
FOUND = {
    branches.Place("half.c", "half", "if (number < 0) {"): 1,
    branches.Place("half.c", "half", "return number < -100 ? -2 : -1;"): 2,
}


def blind(what):
    raise SystemExit(f"blind: {what}")


def find_branches():
    with tempfile.TemporaryDirectory(prefix="trim3r-coverage-") as folder:
        runs.quiet("gcc", "-O0", "--coverage", PLANTED / "half.c", "-o", "half", cwd=folder)
        runs.quiet(pathlib.Path(folder) / "half", cwd=folder)
        counted = branches.counted(pathlib.Path(folder), PLANTED)
    if branches.uncovered(counted, PLANTED) != FOUND:
        blind(f"planted/half.c has {dict(FOUND)}, found were {dict(branches.uncovered(counted, PLANTED))}")


def find_disagreements():
    lines = [reasons.line_for(place, count) for place, count in FOUND.items()]
    for text, wanted in (("", 2), ("Never asked.\n" + "\n".join(lines), 0), ("Never asked.\n" + lines[0], 1),
                         ("Never asked.\n" + "\n".join([*lines, "  half.c half 1: return 1;"]), 1),
                         ("Never asked.\n" + "\n".join(lines).replace(" 2: ", " 1: "), 1),
                         ("Never asked.\n" + "\n".join(lines).replace(" 1: ", " 2: "), 1)):
        found = reasons.disagreements(FOUND, reasons.read(text))
        if len(found) != wanted:
            blind(f"{wanted} disagreements were planted, {len(found)} found: {text}")
    for text in (lines[0], "Never asked.\n  half.c half: no number", "Never asked.\n\n" + lines[0]):
        try:
            reasons.read(text)
        except reasons.Malformed:
            continue
        blind(f"this was read as a list of reasons: {text}")


def find():
    find_branches()
    find_disagreements()
    print("finds planted branches, and reasons that are lacking, outdated or too many")
