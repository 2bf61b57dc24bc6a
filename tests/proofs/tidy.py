#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""tidy.py: clang-tidy finds nothing in the runtime, quant/ and platform/; /.clang-tidy lists its checks."""
import concurrent.futures
import os
import re
import shutil
import sys

import proof

AREAS = ("runtime", "quant", "platform")
# other processors' intrinsics, firmware, and generated tables
APART = ("runtime/kernels/arm/", "runtime/kernels/wasm/", "platform/baremetal/", "quant/heads/", "runtime/budget/blue_noise.c")
VERSION = "14." # other versions have other checks
INCLUDES = ("runtime/include", "runtime", "quant", "platform", ".")
FINDING = re.compile(r"^.*: (?:warning|error): .*$", re.M)


def sources():
    for area in AREAS:
        for path in sorted((proof.ROOT / area).rglob("*.c")):
            if not path.relative_to(proof.ROOT).as_posix().startswith(APART):
                yield path


def findings_of(path):
    result = proof.run(["clang-tidy", "--quiet", "--warnings-as-errors=*", path, "--", "-std=gnu11", *(f"-I{proof.ROOT / folder}" for folder in INCLUDES)])
    found = FINDING.findall(result.stdout)
    if result.returncode and not found:
        proof.broken(f"clang-tidy ends with {result.returncode} at {path}", result.stderr.splitlines())
    return found


def main():
    if shutil.which("clang-tidy") is None or f"version {VERSION}" not in proof.run(["clang-tidy", "--version"]).stdout:
        print(f"SKIPPED: no clang-tidy {VERSION}x here (tools/setup --tests)")
        sys.exit(77)
    proof.must_find(findings_of(proof.PLANTED / "tidy.c"), "clang-analyzer-core.NullDereference", "tidy.c")
    paths = list(sources())
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        findings = [finding for found in pool.map(findings_of, paths) for finding in found]
    proof.verdict(f"clang-tidy finds nothing in {len(paths)} files", findings)


if __name__ == "__main__":
    main()
