#!/usr/bin/env python3
"""misra.py: no rule of MISRA C:2012 has more departures in the runtime than docs/study/misra.md lists, and each that has
some has a reason there."""
import importlib.machinery
import importlib.util
import sys

import proof

SCRIPT = proof.ROOT / "tools" / "misra"


def script():
    """tools/misra as a module."""
    loader = importlib.machinery.SourceFileLoader("misra_script", str(SCRIPT))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader("misra_script", loader))
    loader.exec_module(module)
    return module


def main():
    misra = script()
    found = misra.findings_of(proof.PLANTED / "returns.c")
    proof.must_find([rule for _, rule in found], "15.5", "returns.c")
    if misra.risen({"15.5": 2, "11.5": 1}, {"15.5": 1, "11.5": 1}) != ["15.5"]:
        proof.broken("blind: a count that rises is not noticed")
    found = {"15.5": 2, "11.5": 1}
    page = misra.page_of(found, "a version")
    if misra.unexplained(found, page):
        proof.broken("sees a rule without a reason where each has one")
    for planted in page.replace("- **11.5**", "- **11.6**"), page.replace("*Instead:*", ""), page.replace(", advisory:", ":"):
        if "11.5" not in misra.unexplained(found, planted):
            proof.broken("blind: a rule without a reason is not noticed")
    result = proof.run([sys.executable, "-B", SCRIPT])
    if result.returncode == 77:
        print(f"SKIPPED: {result.stderr.strip()}")
        sys.exit(77)
    proof.verdict("no rule has more departures than docs/study/misra.md lists, and each has a reason there",
                  result.stderr.splitlines() if result.returncode else [])


if __name__ == "__main__":
    main()
