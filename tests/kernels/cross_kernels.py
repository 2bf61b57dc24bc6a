#!/usr/bin/env python3
"""cross_kernels.py ROUNDS EMULATOR COMPILER FLAG...: the kernels' variants for another processor, built by its compiler and
compared with plain C under an emulator, so many seeds of each. Exit 0: the same bits; 77: skipped, a tool is absent.
"""
import pathlib
import shutil
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
RUNTIME = ROOT / "runtime"
SOURCES = [*sorted(HERE.glob("check*.c")), *(HERE / f"{name}.c" for name in ("cross_kernels", "guarded", "judge",
                                                                          "wrong_variants")),
           ROOT / "platform" / "host" / "cpu.c", *sorted((RUNTIME / "kernels").rglob("*.c")),
           *sorted((RUNTIME / "core").glob("*.c"))]
INCLUDES = [RUNTIME / "include", RUNTIME, ROOT / "platform", ROOT / "tests"]


def main():
    if len(sys.argv) < 4:
        sys.exit(__doc__)
    rounds, emulator, *compiler = sys.argv[1:]
    for tool in (emulator, compiler[0]):
        if shutil.which(tool) is None:
            print(f"SKIPPED: no {tool} here (tools/setup --tests)")
            sys.exit(77)
    with tempfile.TemporaryDirectory(prefix="trim3r-kernels-") as folder:
        program = pathlib.Path(folder) / "cross_kernels"
        includes = [word for path in INCLUDES for word in ("-I", path)]
        subprocess.run([*compiler, "-std=gnu11", "-static", *includes, *SOURCES, "-lm", "-o", program], check=True)
        sys.exit(subprocess.run([emulator, program, rounds]).returncode)


if __name__ == "__main__":
    main()
