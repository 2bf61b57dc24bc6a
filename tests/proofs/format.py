#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""format.py: each C and C++ file is formatted by clang-format, except generated and planted files."""
import concurrent.futures
import os
import shutil
import sys

import proof

ENDINGS = (".c", ".h", ".cpp", ".hpp")
WRITTEN = ("runtime/budget/blue_noise.c", "quant/heads/tiny.c", "quant/heads/small.c")
AREAS = ("runtime", "quant", "platform", "tools", "tests")
VERSION = "14." # other versions format differently
BATCH = 100


def sources():
    for area in AREAS:
        for path in sorted((proof.ROOT / area).rglob("*")):
            if path.suffix in ENDINGS and path.parent != proof.PLANTED and path.relative_to(proof.ROOT).as_posix() not in WRITTEN:
                yield path


def check(paths):
    """Returns the first line of each file that is formatted otherwise."""
    result = proof.run(["clang-format", "--dry-run", "-Werror", *paths])
    first = {}
    for line in result.stderr.splitlines():
        if ": error: " in line:
            first.setdefault(line.split(":")[0], line)
    return list(first.values())


def main():
    if shutil.which("clang-format") is None or f"version {VERSION}" not in proof.run(["clang-format", "--version"]).stdout:
        print(f"SKIPPED: no clang-format {VERSION}x here (tools/setup --tests)")
        sys.exit(77)
    proof.must_find(check([proof.PLANTED / "format.c"]), "clang-format-violations", "format.c")
    paths = list(sources())
    batches = [paths[at:at + BATCH] for at in range(0, len(paths), BATCH)]
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        findings = [finding for found in pool.map(check, batches) for finding in found]
    proof.verdict(f"{len(paths)} files are as clang-format writes them", findings)


if __name__ == "__main__":
    main()
