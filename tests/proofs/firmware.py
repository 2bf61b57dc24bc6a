#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""firmware.py TARGET: a firmware that names one head builds without a C library and contains that head only.

Compiles freestanding/firmware.c, the runtime and the shipped heads (a library with one object per head) with no headers
but the compiler's own (-nostdinc), links with -nostdlib, reads the symbols of the result and prints its size.
"""
import re
import sys

import proof

HEADS = proof.ROOT / "quant" / "heads"
NAMES = sorted(path.stem for path in HEADS.glob("*.c"))
# a section per constant, as in trim3r_heads and in a firmware's own build
EXTRA = ["-I", HEADS, "-ffunction-sections", "-fdata-sections"]


def link(target, objects, library, folder, defines=()):
    """Links the firmware; returns the file and the linker's errors."""
    compiler, made = proof.compiler_of(target), folder / "firmware.o"
    firmware = folder / "firmware"
    result = proof.compile_one(compiler, target, proof.HERE / "freestanding" / "firmware.c", made, [*EXTRA, *defines])
    if result.returncode == 0:
        result = proof.run([compiler, *target.flags, "-nostdlib", "-static", "-Wl,--gc-sections", "-Wl,-e,firmware",
                            "-Wl,-u,firmware", made, *objects, library, "-lgcc", "-o", firmware])
    return firmware, result.stderr.strip().splitlines() if result.returncode != 0 else []


def heads_in(target, firmware):
    symbols = proof.run([target.prefix + "nm", "--format=posix", firmware], check=True).stdout
    return sorted({name for name in NAMES if re.search(rf"^t3r_head_{name} ", symbols, flags=re.M)})


def check(target, objects, library, folder, wanted, defines=()):
    firmware, errors = link(target, objects, library, folder, defines)
    if errors:
        return [f"does not link: {line}" for line in errors]
    found = heads_in(target, firmware)
    return [] if found == [wanted] else [f"holds {', '.join(found)} where {wanted} alone is named"]


def main():
    target = proof.TARGETS[sys.argv[1]]
    with proof.scratch() as folder:
        (folder / "heads").mkdir()
        hosted = proof.compile_one(proof.compiler_of(target), target, proof.PLANTED / "hosted.c", folder / "hosted.o")
        proof.must_find(hosted.stderr.splitlines(), "string.h", "hosted.c")
        objects = proof.runtime_objects(target)
        heads = proof.compile_each(target, sorted(HEADS.glob("*.c")), folder / "heads", EXTRA)
        library = folder / "libheads.a"
        proof.run([target.prefix + "ar", "rcs", library, *heads], check=True)
        proof.must_find(check(target, objects, library, folder, "small", ["-DSECOND_HEAD=t3r_head_tiny"]),
                        "holds small, tiny", "a firmware that names two")
        proof.must_find(check(target, objects, library, folder, "large",
                              ["-DHEAD=t3r_head_large", "-DHEAD_BYTES=1"]), "does not link", "one that is not shipped")
        findings = []
        for name in NAMES:
            defines = [f"-DHEAD=t3r_head_{name}", f"-DHEAD_BYTES=t3r_head_{name}_bytes"]
            findings += check(target, objects, library, folder, name, defines)
            if not findings:
                size = proof.run([target.prefix + "size", folder / "firmware"], check=True).stdout.splitlines()[1].split()
                print(f"{target.name}, {name}: {size[0]} bytes of code and constants, {size[1]} of data, {size[2]} of bss")
        proof.verdict(f"{target.name}: compiles and links without a C library, and a firmware holds just the head that it names",
                      findings)


if __name__ == "__main__":
    sys.exit(main())
