#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""symbols.py TARGET [LIBRARY]: the runtime calls nothing but memcpy, memmove, memset and memcmp, and keeps no state.

The only other calls are the integer helpers that docs/firmware.md names for the core. On a core without an FPU every
use of a real number would call a helper that is not listed. A given LIBRARY is checked instead of a build made here.
"""
import pathlib
import re
import sys

import proof

PERMITTED = {"memcpy", "memmove", "memset", "memcmp",
             "_GLOBAL_OFFSET_TABLE_"} # the linker's, for code at any address
# .data.rel.ro is constant once loaded (tables of pointers in position-independent code)
WRITABLE = re.compile(r"^\.(data|bss|tdata|tbss|sdata|sbss)(?!\.rel\.ro)(\.|$)")


def check(target, files):
    findings, undefined, defined = [], {}, set()
    symbols = proof.run([target.prefix + "nm", "--print-file-name", "--format=posix", *files], check=True).stdout
    for line in symbols.splitlines():
        where, name, kind, *_ = line.split()
        if kind in "Uvw":
            undefined.setdefault(name, where.rstrip(":"))
        else:
            defined.add(name)
        if kind == "C":
            findings.append(f"writable global: {name} in {where.rstrip(':')}")
    for name in sorted(set(undefined) - defined - PERMITTED - target.helpers):
        findings.append(f"calls {name} in {undefined[name]}")

    member = ""
    for line in proof.run([target.prefix + "objdump", "--section-headers", *files], check=True).stdout.splitlines():
        words = line.split()
        if "file format" in line:
            member = words[0].rstrip(":")
        elif len(words) >= 7 and words[0].isdigit() and WRITABLE.match(words[1]) and int(words[2], 16) > 0:
            findings.append(f"writable global: {int(words[2], 16)} bytes of {words[1]} in {member}")
    return findings


def main():
    target = proof.TARGETS[sys.argv[1]]
    with proof.scratch() as folder:
        def planted(name):
            return check(target, proof.compile_each(target, [proof.PLANTED / name], folder))

        proof.must_find(planted("heap.c"), "calls malloc", "heap.c")
        proof.must_find(planted("global.c"), "writable global", "global.c")
        if target.name.startswith("cortex"):
            proof.must_find(planted("real.c"), "calls __aeabi_f", "real.c")
        if "-mgeneral-regs-only" in target.flags:
            source, made = proof.PLANTED / "real.c", folder / "real.o"
            result = proof.compile_one(proof.compiler_of(target), target, source, made)
            proof.must_find(result.stderr.splitlines(), "floating-point types" if target.prefix else "SSE", "real.c")
        if len(sys.argv) > 2:
            files = [pathlib.Path(sys.argv[2])]
        else:
            files = proof.runtime_objects(target)
        proof.verdict(f"{target.name}: four functions of the C library at most, no writable globals",
                      check(target, files))


if __name__ == "__main__":
    main()
