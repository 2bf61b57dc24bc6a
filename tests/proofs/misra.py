#!/usr/bin/env python3
"""misra.py: no rule of MISRA C:2012 has more departures in the runtime than docs/study/misra.md lists."""
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
    result = proof.run([sys.executable, "-B", SCRIPT])
    if result.returncode == 77:
        print(f"SKIPPED: {result.stderr.strip()}")
        sys.exit(77)
    proof.verdict("no rule has more departures than docs/study/misra.md lists",
                  result.stderr.splitlines() if result.returncode else [])


if __name__ == "__main__":
    main()
