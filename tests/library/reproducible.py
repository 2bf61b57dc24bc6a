#!/usr/bin/env python3
"""reproducible.py: two builds of copies of the tree, in folders whose paths differ in length, give the same bytes: the
static library, the shared one and the heads."""
import os
import pathlib
import shutil
import sys
import tempfile

from library import ROOT, ended, there

from checks import check, done

COPIED = ("CMakeLists.txt", "libraries.cmake", "LICENSE", "runtime", "quant", "platform", "tools", "docs")
LIBRARIES = ("libtrim3r.a", "libtrim3r.so", "libtrim3r_heads.a")
# A file that knows where it lies.
PLANTED = "\nconst char t3r_planted[] = __FILE__;\n"


def copy_of(folder):
    for name in COPIED:
        source = ROOT / name
        (shutil.copytree if source.is_dir() else shutil.copyfile)(source, folder / name)


def command(*words):
    # a cache of compilers would be asked for what another folder gave
    environment = {name: value for name, value in os.environ.items() if not name.endswith("_COMPILER_LAUNCHER")}
    made = ended(*words, env=environment)
    check(made.returncode == 0, f"{' '.join(map(str, words))}: {made.stdout}{made.stderr}")


def built(folder):
    """{name: bytes} of what the copy in this folder makes."""
    command("cmake", "-S", folder, "-B", folder / "build", "-DT3R_TOOLS=OFF", "-DT3R_TESTS=OFF", "-DT3R_SHARED=ON",
            "-DCMAKE_BUILD_TYPE=Release")
    command("cmake", "--build", folder / "build", "-j", str(os.cpu_count()), "--target", "trim3r_runtime",
            "trim3r_shared", "trim3r_heads")
    return {name: (folder / "build" / name).resolve().read_bytes() for name in LIBRARIES}


def differing(folders):
    first, second = (built(folder) for folder in folders)
    return [name for name in first if first[name] != second[name]]


def main():
    if not there("cmake", "cc"):
        sys.exit(77)
    with tempfile.TemporaryDirectory(prefix="trim3r-same-") as folder:
        folders = [pathlib.Path(folder) / "a", pathlib.Path(folder) / "another" / "of a longer path"]
        for place in folders:
            place.mkdir(parents=True)
            copy_of(place)
        found = differing(folders)
        check(found == [], f"{', '.join(found)}: other bytes in another folder")
        for place in folders:
            source = place / "runtime" / "core" / "names.c"
            source.write_text(source.read_text() + PLANTED)
        check(differing(folders)[:1] == ["libtrim3r.a"], "blind: a path in the library is not noticed")
    done()


if __name__ == "__main__":
    main()
