#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""reproducible.py: two builds of copies of the tree, in folders with paths of different lengths, give the same
bytes, debug information included: the libraries, the heads, the program, its modules for cameras, the Python
package, man pages and bills of materials."""
import os
import pathlib
import shutil
import sys
import tempfile

from library import ROOT, ended, there

from checks import check, done

COPIED = ("CMakeLists.txt", "libraries.cmake", "LICENSE", "runtime", "quant", "platform", "tools", "docs")
MADE = ("libtrim3r*.a", "libtrim3r*.so", "trim3r", "tools/packaging/man1/*", "tools/packaging/*.spdx.json",
        "python/trim3r/*")
LIBRARIES = {"libtrim3r.a", "libtrim3r.so", "libtrim3r_heads.a"}
# The compiler's own name of a file, which must be relative to the tree's top.
WHERE = "\nconst char t3r_where[] = __FILE__;\n"
# Makes a program that looks for libraries where it was built.
RUN_PATH = "\nset_property(TARGET trim3r APPEND PROPERTY INSTALL_RPATH ${CMAKE_BINARY_DIR})\n"


def append(path, text):
    path.write_text(path.read_text() + text)


def copy_of(folder):
    for name in COPIED:
        source = ROOT / name
        (shutil.copytree if source.is_dir() else shutil.copyfile)(source, folder / name)
    append(folder / "runtime" / "core" / "names.c", WHERE)


def command(*words):
    # a compiler cache could return the other folder's objects
    environment = {name: value for name, value in os.environ.items() if not name.endswith("_COMPILER_LAUNCHER")}
    made = ended(*words, env=environment)
    check(made.returncode == 0, f"{' '.join(map(str, words))}: {made.stdout}{made.stderr}")


def built(folder):
    """Returns {name: bytes} of the files that the copy in this folder builds."""
    build = folder / "build"
    command("cmake", "-S", folder, "-B", build, "-DT3R_TESTS=OFF", "-DT3R_SHARED=ON", "-DCMAKE_BUILD_TYPE=Release",
            "-DCMAKE_C_FLAGS=-g", "-DCMAKE_CXX_FLAGS=-g")
    command("cmake", "--build", build, "-j", str(os.cpu_count()))
    paths = [path for pattern in MADE for path in sorted(build.glob(pattern)) if path.is_file()]
    return {path.name: path.read_bytes() for path in paths}


def differing(folders):
    first, second = (built(folder) for folder in folders)
    check(LIBRARIES | {"trim3r", "trim3r.1"} <= set(first) == set(second), f"built {sorted(first)} and {sorted(second)}")
    return {name for name in first if first[name] != second[name]}


def main():
    if not there("cmake", "cc"):
        sys.exit(77)
    with tempfile.TemporaryDirectory(prefix="trim3r-same-") as folder:
        folders = [pathlib.Path(folder) / "a", pathlib.Path(folder) / "another" / "of a longer path"]
        for place in folders:
            place.mkdir(parents=True)
            copy_of(place)
        found = differing(folders)
        check(found == set(), f"{', '.join(sorted(found))}: other bytes in another folder")
        for place in folders:
            append(place / "CMakeLists.txt", RUN_PATH)
        check(differing(folders) == {"trim3r"}, "blind: a run path into the build folder is not noticed")
        for place in folders:
            append(place / "runtime" / "core" / "names.c", f'\nconst char t3r_planted[] = "{place}";\n')
        check({"libtrim3r.a", "libtrim3r.so"} <= differing(folders), "blind: a path in the library is not noticed")
    done()


if __name__ == "__main__":
    main()
