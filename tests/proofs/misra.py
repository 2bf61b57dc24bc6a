#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""misra.py: no rule of MISRA C:2012 has more departures in the runtime than docs/study/proofs.md lists, and each that has
some has a reason there."""
import importlib.machinery
import importlib.util
import os
import pathlib
import sys
import tempfile

import proof

SCRIPT = proof.ROOT / "tools" / "misra"


def script():
    """Loads tools/misra as a module."""
    loader = importlib.machinery.SourceFileLoader("misra_script", str(SCRIPT))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader("misra_script", loader))
    loader.exec_module(module)
    return module


def dies_unheard(misra, ending):
    """Whether a failure of the addon's Python with this ending goes unreported."""
    path = os.environ["PATH"]
    with tempfile.TemporaryDirectory() as folder:
        python = pathlib.Path(folder, "python3")
        python.write_text(f"#!/bin/sh\n[ \"$1\" = --version ] && exec {sys.executable} --version\n{ending}\n")
        python.chmod(0o755)
        os.environ["PATH"] = f"{folder}:{path}"
        try:
            misra.findings_of(proof.PLANTED / "returns.c")
        except SystemExit:
            return False
        finally:
            os.environ["PATH"] = path
    return True


def main():
    misra = script()
    for ending in "exit 1", "kill -9 $$", "echo out of memory; exit 1":
        if misra.shutil.which("cppcheck") and dies_unheard(misra, ending):
            proof.broken(f"blind: an addon that ends by '{ending}' is not noticed")
    found = misra.findings_of(proof.PLANTED / "returns.c")
    proof.must_find([rule for _, rule in found], "15.5", "returns.c")
    if misra.risen({"15.5": 2, "11.5": 1}, {"15.5": 1, "11.5": 1}) != ["15.5"]:
        proof.broken("blind: a count that rises is not noticed")
    found = {"15.5": 2, "11.5": 1}
    page = "| 11.5 | 3 | advisory | pointers | It must. | A test. |\n| 15.5 | 2 | advisory | returns | They do. | Another. |\n"
    if misra.unexplained(found, page):
        proof.broken("sees a rule without a reason where each has one")
    if misra.with_counts(page, found) != page.replace("| 3 |", "| 1 |"):
        proof.broken("does not write the counts of today")
    for planted in page.replace("| 11.5", "| 11.6"), page.replace(" A test. |", ""), page.replace(" advisory |", ""):
        if "11.5" not in misra.unexplained(found, planted):
            proof.broken("blind: a rule without a reason is not noticed")
    result = proof.run([sys.executable, "-B", SCRIPT])
    if result.returncode == 77:
        print(f"SKIPPED: {result.stderr.strip()}")
        sys.exit(77)
    proof.verdict("no rule has more departures than docs/study/proofs.md lists, and each has a reason there",
                  result.stderr.splitlines() if result.returncode else [])


if __name__ == "__main__":
    main()
