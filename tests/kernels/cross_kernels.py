#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""cross_kernels.py ROUNDS EMULATOR COMPILER FLAG...: compares the kernels' variants for another processor or by another
compiler with plain C, ROUNDS seeds of each; EMULATOR is `none` for this processor. Exit 0: the same bits; 77: skipped,
a tool is absent.
"""
import pathlib
import subprocess
import sys
import tempfile

import objects

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
RUNTIME = ROOT / "runtime"

SOURCES = [*sorted(HERE.glob("check*.c")), *(HERE / f"{name}.c" for name in ("cross_kernels", "guarded", "judge",
                                                                          "wrong_variants")),
           ROOT / "platform" / "host" / "cpu.c"]
INCLUDES = [RUNTIME / "include", RUNTIME, ROOT / "platform", ROOT / "tests"]


def main():
    if len(sys.argv) < 4:
        sys.exit(__doc__)
    rounds, *words = sys.argv[1:]
    emulator, compiler = ([], words[1:]) if words[0] == "none" else (words[:1], words[1:])
    lacking = objects.absent(*emulator, compiler[0])
    if lacking is not None:
        print(f"SKIPPED: no {lacking} here (tools/setup --tests)")
        sys.exit(77)
    with tempfile.TemporaryDirectory(prefix="trim3r-kernels-") as folder:
        program = pathlib.Path(folder) / "cross_kernels"
        includes = [word for path in INCLUDES for word in ("-I", path)]
        objects.output_of(*compiler, "-std=gnu11", "-static", *includes, *SOURCES, *objects.compiled(compiler), "-lm", "-o",
                          program)
        sys.exit(subprocess.run([*emulator, program, rounds]).returncode)


if __name__ == "__main__":
    main()
