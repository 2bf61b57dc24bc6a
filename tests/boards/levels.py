#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""levels.py TRIM3R FOLDER: gcc and clang compile each file of the runtime for the Cortex-M55 at every level. A
firmware whose runtime is from clang, with wider enumerations than gcc's rest, has the bits of this machine."""
import concurrent.futures
import os
import pathlib
import shutil
import subprocess
import sys

from checks import check, done, run, skip
from cortex_m import CLANG, COMPILER
from firmware import BOARDS, RUNTIME

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent

PROGRAM, FOLDER, BOARD = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]), "mps3-an547"
COMPILERS = ((*CLANG, "-ffreestanding", "-std=c11"), (COMPILER, "-ffreestanding", "-std=c11"))
LEVELS = ("-O0", "-O1", "-O2", "-O3", "-Os")


def refused(sources):
    """Returns each file, level and compiler that end in an error."""
    def compiled(job):
        compiler, level, source = job
        ended = subprocess.run([*compiler, level, *BOARDS[BOARD]["flags"], "-w", "-I", RUNTIME / "include", "-I", RUNTIME,
                                "-c", source, "-o", os.devnull], capture_output=True, text=True, check=False)
        return None if ended.returncode == 0 else f"{source.name} by {compiler[0]} {level}: {ended.stderr[:400]}"

    jobs = [(compiler, level, source) for compiler in COMPILERS for level in LEVELS for source in sources]
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        return list(filter(None, pool.map(compiled, jobs)))


def main():
    for tool in (CLANG[0], COMPILER, "qemu-system-arm"):
        if shutil.which(tool) is None:
            skip(f"no {tool} here (tools/setup --tests)")
    FOLDER.mkdir(parents=True, exist_ok=True)
    planted = FOLDER / "planted.c"
    planted.write_text("#ifdef __OPTIMIZE_SIZE__\n#error planted\n#endif\n")
    check(len(refused([planted])) == len(COMPILERS), "a file that does not compile at one level is found")
    sources = sorted(RUNTIME.rglob("*.c"))
    check(len(sources) > 80, f"blind: {len(sources)} files")
    found = refused(sources)
    check(found == [], f"does not compile: {found}")
    run(sys.executable, "-B", ROOT / "tools" / "boards", BOARD, "--clang", "--optimize=-O3", "--program", PROGRAM, "--out",
        FOLDER) # its exit status reports the bits
    done()


if __name__ == "__main__":
    main()
