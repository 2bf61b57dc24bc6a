#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""consumers.py BUILD: the build folder is installed, and programs elsewhere use the installed files: by find_package
with the static and the shared library, and by pkg-config. Each prints the same hash. The shared library exports
exactly the declarations of trim3r.h."""
import os
import pathlib
import re
import shutil
import sys
import tempfile

from library import CONSUMERS, HASH, SERIES, VERSION, ended, there

import proof
from checks import check, done, run


def prints_hash(said, hash_wanted=HASH):
    return said.split() == [hash_wanted, hash_wanted, VERSION]


def by_cmake(installed, folder):
    configure = ["cmake", "-S", CONSUMERS, f"-DCMAKE_PREFIX_PATH={installed}", "-B"]
    other = ended(*configure, folder / "other", "-DWANTED_VERSION=9.0")
    check(other.returncode != 0 and "trim3r" in other.stderr, "find_package accepts a version that is not there")
    run(*configure, folder / "found", f"-DWANTED_VERSION={VERSION}")
    run("cmake", "--build", folder / "found")
    for kind in ("trim3r", "shared"):
        program = folder / "found" / f"consumer_{kind}"
        said = run(program).stdout
        check(prints_hash(said), f"by find_package, {kind}: '{said.strip()}', not {HASH}")
        check(loads(program, installed) == (kind == "shared"), f"{kind}: loads the shared library, or does not")


def loads(program, installed):
    """Whether the program loads the installed shared library by its versioned name."""
    return f"libtrim3r.so.{SERIES} => {installed}" in run("ldd", program).stdout


def by_pkg_config(installed, folder):
    os.environ["PKG_CONFIG_PATH"] = str(installed / "lib" / "pkgconfig")
    flags = run("pkg-config", "--cflags", "--libs", f"trim3r-heads = {VERSION}").stdout.split()
    program = folder / "by_pkg_config"
    sources = [CONSUMERS / "main.c", CONSUMERS / "scene.c"]
    run("cc", *sources, *flags, f"-Wl,-rpath,{installed}/lib", "-o", program)
    said = run(program).stdout
    check(prints_hash(said), f"by pkg-config: '{said.strip()}', not {HASH}")
    check(loads(program, installed), "by pkg-config: does not load the shared library")


def exports(library):
    lines = run("nm", "--dynamic", "--defined-only", "--format=posix", library).stdout.splitlines()
    return {line.split()[0] for line in lines}


def main():
    if not there("cmake", "pkg-config", "cc"):
        sys.exit(77)
    check(not prints_hash(f"{HASH} {HASH[::-1]} {VERSION}"), "blind: another hash is not noticed")
    build = pathlib.Path(sys.argv[1])
    with tempfile.TemporaryDirectory(prefix="trim3r-consumers-") as folder:
        folder = pathlib.Path(folder).resolve()
        installed, moved = folder / "first", folder / "moved"
        for component in ("dev", "shared"):
            run("cmake", "--install", build, "--prefix", installed, "--component", component)
        shutil.move(installed, moved)  # the installation can be moved
        by_cmake(moved, folder)
        by_pkg_config(moved, folder)
        header = (proof.RUNTIME / "include" / "trim3r.h").read_text()
        wanted = {*proof.public_functions(), *re.findall(r"^extern const \w+ (t3r_\w+);", header, flags=re.M)}
        found = exports(moved / "lib" / "libtrim3r.so")
        check(wanted and found == wanted, f"exports and trim3r.h differ: {sorted(found ^ wanted)}")
    done()


if __name__ == "__main__":
    main()
