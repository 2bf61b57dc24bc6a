#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""packed.py: trim3r.h does not compile where structs are packed, in C and in C++, on machines of 32 and 64 bits."""
import pathlib
import sys
import tempfile

from library import ROOT, WARNINGS, amalgamate, ended, there

from checks import check, done

WORDS = "trim3r.h is included where structs are packed"
C, CPP = ["-x", "c", "-std=c11"], ["-x", "c++", "-std=c++11"]
# Each compiler with the packings that change a struct there: i686 aligns 64 bits to 4 bytes.
COMPILERS = ((["gcc", *C], (1, 2, 4)), (["g++", *CPP], (1, 2, 4)),
             (["clang", *C], (1, 2, 4)), (["clang++", *CPP], (1, 2, 4)),
             (["i686-linux-gnu-gcc", *C], (1, 2)), (["clang", "--target=wasm32", "-ffreestanding", *C], (1, 2, 4)),
             (["arm-none-eabi-gcc", *C], (1, 2, 4)), (["aarch64-linux-gnu-gcc", *C], (1, 2, 4)))


def compiled(compiler, folder, include, before, *flags):
    """Compiles a file that includes trim3r.h after these lines."""
    source = folder / "user.c"
    source.write_text(f'{before}\n#include "trim3r.h"\ntypedef int user;\n')
    return ended(*compiler, *WARNINGS, "-Wpedantic", *flags, "-fsyntax-only", "-I", include, source)


def check_compiler(compiler, packings, folder, include):
    for before in ("", "#pragma pack(push, 1)\n#pragma pack(pop)", "#pragma pack(8)"):
        good = compiled(compiler, folder, include, before)
        check(good.returncode == 0, f"{compiler}, {before}: {good.stderr}")
    for before, *flags in (*((f"#pragma pack({bytes_})",) for bytes_ in packings), ("", "-fpack-struct")):
        bad = compiled(compiler, folder, include, before, *flags)
        check(bad.returncode != 0 and WORDS in bad.stderr, f"{compiler}, {before} {flags}: {bad.stderr}")


def main():
    compilers = [row for row in COMPILERS if there(row[0][0])]
    if not compilers:
        sys.exit(77)
    with tempfile.TemporaryDirectory(prefix="trim3r-packed-") as folder:
        folder = pathlib.Path(folder)
        amalgamate(folder)
        for include in (ROOT / "runtime" / "include", folder):
            for compiler, packings in compilers:
                check_compiler(compiler, packings, folder, include)
    done()


if __name__ == "__main__":
    main()
