#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""features.py [--each]: a library without a feature reports it for every call that needs it, and otherwise has the bits
of the complete library.

The two files of tools/amalgamate are compiled complete and without any feature; with --each also without each, and
CMake builds and installs a library without any. features_driver.c uses every feature.
"""
import os
import pathlib
import re
import sys
import tempfile

from library import CONSUMERS, FEATURES, HEADS, HERE, ROOT, WARNINGS, amalgamate, at_once, there, without

from checks import check, done, run

BITS = {name: 1 << at for at, name in enumerate(FEATURES)}


def lines_of(driver, *words):
    """Returns the driver's output with a library compiled with these arguments."""
    run("cc", "-std=c11", "-O0", *WARNINGS, HERE / "features_driver.c", CONSUMERS / "scene.c", *words, "-o", driver)
    return run(driver).stdout.splitlines()


def of_two_files(folder, left_out):
    return lines_of(folder / ("driver_" + "_".join(left_out or ["whole"])), *map(without, left_out), "-I", folder, "-I",
                    HEADS, HEADS / "small.c", folder / "trim3r.c")


def of_cmake(folder):
    """Checks an installed library without any feature; pkg-config lists the missing ones."""
    build, installed = folder / "build", folder / "installed"
    run("cmake", "-S", ROOT, "-B", build, "-DCMAKE_BUILD_TYPE=Debug", "-DT3R_TOOLS=OFF",
        "-DT3R_SHARED=OFF", *(f"-DT3R_WITH_{name.upper()}=OFF" for name in FEATURES))
    run("cmake", "--build", build)
    run("cmake", "--install", build, "--prefix", installed)
    os.environ["PKG_CONFIG_PATH"] = str(installed / "lib" / "pkgconfig")
    return lines_of(folder / "driver_cmake", *run("pkg-config", "--cflags", "--libs", "trim3r-heads").stdout.split())


# The features that a line of the driver needs, unless it has its feature's name.
NEEDS = {"align": {"comparison"}, "warm": {"streams"}, "loss": {"refinement", "extras"},
         **dict.fromkeys(("allocations", "wavelets", "workers", "lenses"), {"extras"})}
# Features that depend on comparison.
OF_VIEWS = {"stereo", "streams"}


def expected(whole, left_out):
    """Returns the complete library's lines, changed only where a feature is left out."""
    left_out = {*left_out, *(OF_VIEWS if "comparison" in left_out else ())}
    features = sum(bit for name, bit in BITS.items() if name not in left_out)
    passes = 0 if "refinement" in left_out else 4 if "extras" in left_out else 8 # only fitted passes are 8
    lines = [f"features {features:02x}, {passes} passes of refinement"]
    for line in whole[1:]:
        name, call = re.match(r"(\w+)(, a call)?", line).groups()
        lacking = NEEDS.get(name, {name}) & left_out
        if not lacking:
            lines.append(line)
        elif call:
            lines.append(f"{name}, a call: unsupported")
        else:
            first = "comparison" if "comparison" in left_out and name in OF_VIEWS else min(lacking)
            lines.append(f"{name}: unsupported: this library was built without {first}")
    return lines


def main():
    if not there("cc"):
        sys.exit(77)
    with tempfile.TemporaryDirectory(prefix="trim3r-features-") as folder:
        folder = pathlib.Path(folder)
        amalgamate(folder)
        choices = [[], list(FEATURES), *([name] for name in FEATURES if "--each" in sys.argv)]
        whole, *reduced = at_once(lambda left_out: of_two_files(folder, left_out), choices)
        if "--each" in sys.argv:
            check(of_cmake(folder) == reduced[0], "CMake's library without any feature is another")
    hashes = {line.split()[-1] for line in whole if re.fullmatch(r"\w+: [0-9a-f]{16}", line)}
    same_bits = {"workers", "warm", "align"}  # poses that agree are unchanged
    scenes = [line for line in whole[1:] if ", a call:" not in line]
    check(len(hashes) == len(scenes) - len(same_bits),
          f"the whole library builds not all scenes, or two alike: {whole}")
    check(expected(whole, ["stereo"]) != expected(whole, ["learned"]) != whole, "blind: all libraries seem alike")
    for left_out, lines in zip(choices[1:], reduced):
        check(lines == expected(whole, left_out), f"without {', '.join(left_out)}: {lines}")
    done()


if __name__ == "__main__":
    main()
